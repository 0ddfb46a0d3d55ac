"""The [tool.dbcspec] table of pyproject.toml: where the spec is and what is made of it.

What the linter is asked can also stand in a TOML file of its own, for files without a project.
"""

from __future__ import annotations

import dataclasses
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from dbcspec.lint.options import Options, is_rule, is_rule_or_group
from dbcspec.lint.registry import ALL_RULES
from dbcspec.lint.rule import Settings, Waiver
from typedcan.model.errors import Location, ReadError

_TEXT_KEYS = {"name", "spec", "dbc", "stubs", "runtime"}
_LINT_TABLES = {"lint", "waivers"}
_LINT_KEYS = {"select", "ignore", "bus_load", "units"}
_WAIVER_KEYS = {"rule", "subject", "reason"}
_OPTIONAL_WAIVER_KEYS = {"message"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Config:
    """Paths are relative to ``root``, the folder of pyproject.toml.

    ``stubs`` is empty where a project wants no Python. ``runtime`` says nothing any more: stubs
    stand on `typedcan`.
    """

    root: Path
    name: str
    spec: str = "spec"
    dbc: str = "dbc"
    stubs: str = ""
    runtime: str = ""
    lint: Options = field(default_factory=Options)

    @property
    def waivers(self) -> tuple[Waiver, ...]:
        """The findings that are accepted."""
        return self.lint.waivers


def find_config(start: Path) -> Config:
    """The configuration of the project that ``start`` lies in; raises `ReadError`."""
    for folder in (start, *start.parents):
        path = folder / "pyproject.toml"
        if path.is_file():
            text = _text(path)
            tool = _document(path, text).get("tool")
            table = tool.get("dbcspec") if isinstance(tool, dict) else None
            if isinstance(table, dict):
                return _config(path, text, table)
    raise ReadError(f"no pyproject.toml with a [tool.dbcspec] table in {start} or above it")


def read_lint_config(path: Path) -> Options:
    """What the linter is asked in a TOML file of its own; raises `ReadError`.

    The file has the tables ``[lint]`` and ``[[waivers]]``, or is a pyproject.toml that has them
    under ``tool.dbcspec``.
    """
    text = _text(path)
    document = _document(path, text)
    tool = document.get("tool")
    table = tool.get("dbcspec") if isinstance(tool, dict) else None
    if isinstance(table, dict):
        return _options(path, text, {key: table[key] for key in _LINT_TABLES & set(table)})
    if unknown := sorted(set(document) - _LINT_TABLES):
        raise ReadError(f"{path}: unknown key {unknown[0]!r}; there are [lint] and [[waivers]]")
    return _options(path, text, document)


def _text(path: Path) -> str:
    try:
        return path.read_text("utf-8")
    except OSError as error:
        raise ReadError(f"{path}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise ReadError(f"{path}: is not UTF-8") from None


def _document(path: Path, text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ReadError(f"{path}: is not TOML: {error}") from None


def _config(path: Path, text: str, table: Mapping[str, Any]) -> Config:
    if unknown := sorted(set(table) - _TEXT_KEYS - _LINT_TABLES):
        raise ReadError(f"{path}: [tool.dbcspec] has an unknown key {unknown[0]!r}")
    texts = {key: value for key, value in table.items() if key in _TEXT_KEYS}
    for key, value in texts.items():
        if not isinstance(value, str):
            raise ReadError(f"{path}: [tool.dbcspec] {key} must be text")
        if key in ("spec", "dbc") and not value:
            raise ReadError(f"{path}: [tool.dbcspec] {key} is empty; a dot is the folder itself")
    if not texts.get("name"):
        raise ReadError(f"{path}: [tool.dbcspec] needs a name for the database")
    return Config(root=path.parent, lint=_options(path, text, table), **texts)


def _options(path: Path, text: str, tables: Mapping[str, Any]) -> Options:
    table = tables.get("lint", {})
    if not isinstance(table, dict):
        raise ReadError(f"{path}: lint must be a table, [lint]")
    if unknown := sorted(set(table) - _LINT_KEYS):
        raise ReadError(f"{path}: [lint] has an unknown key {unknown[0]!r}")
    defaults = Settings()
    load = table.get("bus_load", defaults.bus_load)
    if isinstance(load, bool) or not isinstance(load, (int, float)) or not 0 < load <= 100:
        raise ReadError(f"{path}: [lint] bus_load must be a percentage, above 0 and at most 100")
    return Options(
        select=_rules(path, table, "select", Options().select),
        ignore=_rules(path, table, "ignore", ()),
        waivers=tuple(_waivers(path, text, tables.get("waivers", []))),
        settings=Settings(bus_load=load, units=frozenset(_texts(path, table, "units", ()))),
    )


def selected(options: Options, names: Sequence[str]) -> Options:
    """The options with other rules selected; raises `ReadError` for a name that is none."""
    for name in names:
        if not is_rule_or_group(name):
            raise ReadError(_no_rule(name))
    return dataclasses.replace(options, select=tuple(names))


def _texts(
    path: Path, table: Mapping[str, Any], key: str, default: tuple[str, ...]
) -> tuple[str, ...]:
    value = table.get(key, default)
    if not isinstance(value, (list, tuple)) or not all(isinstance(each, str) for each in value):
        raise ReadError(f"{path}: [lint] {key} must be a list of texts")
    return tuple(value)


def _rules(
    path: Path, table: Mapping[str, Any], key: str, default: tuple[str, ...]
) -> tuple[str, ...]:
    names = _texts(path, table, key, default)
    for name in names:
        if not is_rule_or_group(name):
            raise ReadError(f"{path}: [lint] {key}: {_no_rule(name)}")
    return names


def _no_rule(name: str) -> str:
    close = get_close_matches(name, [rule.id for rule in ALL_RULES], n=1)
    hint = f"; did you mean {close[0]!r}?" if close else ""
    return f"there is no rule {name!r}{hint}"


def _waivers(path: Path, text: str, entries: Any) -> list[Waiver]:
    if not isinstance(entries, list):
        raise ReadError(f"{path}: waivers must be tables, [[waivers]]")
    headers = [
        number
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() in ("[[tool.dbcspec.waivers]]", "[[waivers]]")
    ]
    waivers: list[Waiver] = []
    for index, entry in enumerate(entries):
        line = headers[index] if index < len(headers) else 1
        try:
            waivers.append(_waiver(entry, Location(path.name, line)))
        except ReadError as error:
            raise ReadError(f"{path}:{line}: waiver {index + 1} {error}") from None
    return waivers


def _waiver(entry: Any, where: Location) -> Waiver:
    keys = set(entry) if isinstance(entry, dict) else set[str]()
    if not _WAIVER_KEYS <= keys <= _WAIVER_KEYS | _OPTIONAL_WAIVER_KEYS or not all(
        isinstance(value, str) and value for value in entry.values()
    ):
        raise ReadError("needs rule, subject and reason, and may have message, each text")
    if not is_rule(entry["rule"]):
        raise ReadError(f"is of no use: {_no_rule(entry['rule'])}")
    return Waiver(**entry, where=where)
