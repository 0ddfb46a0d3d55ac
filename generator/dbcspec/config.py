"""The [tool.dbcspec] table of pyproject.toml: where the spec is and what is made of it."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dbcspec.errors import Location, ReadError
from dbcspec.lint.rule import Waiver

_KEYS = {"name", "spec", "dbc", "stubs", "runtime", "waivers"}
_WAIVER_KEYS = {"rule", "subject", "reason"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Config:
    """Paths are relative to ``root``, the folder of pyproject.toml.

    ``stubs`` and ``runtime`` are empty where a project wants no Python.
    """

    root: Path
    name: str
    spec: str = "spec"
    dbc: str = "dbc"
    stubs: str = ""
    runtime: str = ""
    waivers: tuple[Waiver, ...] = ()


def find_config(start: Path) -> Config:
    """The configuration of the project that ``start`` lies in; raises `ReadError`."""
    for folder in (start, *start.parents):
        path = folder / "pyproject.toml"
        if path.is_file() and (table := _table(path)) is not None:
            return _config(path, table)
    raise ReadError(f"no pyproject.toml with a [tool.dbcspec] table in {start} or above it")


def _table(path: Path) -> dict[str, Any] | None:
    try:
        document = tomllib.loads(path.read_text("utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ReadError(f"{path}: {error}") from None
    table = document.get("tool", {}).get("dbcspec")
    return table if isinstance(table, dict) else None


def _config(path: Path, table: dict[str, Any]) -> Config:
    if unknown := sorted(set(table) - _KEYS):
        raise ReadError(f"{path}: [tool.dbcspec] has an unknown key {unknown[0]!r}")
    texts = {key: value for key, value in table.items() if key != "waivers"}
    for key, value in texts.items():
        if not isinstance(value, str):
            raise ReadError(f"{path}: [tool.dbcspec] {key} must be text")
    if not texts.get("name"):
        raise ReadError(f"{path}: [tool.dbcspec] needs a name for the database")
    if bool(texts.get("stubs")) != bool(texts.get("runtime")):
        raise ReadError(f"{path}: [tool.dbcspec] stubs and runtime go together")
    return Config(
        root=path.parent, waivers=tuple(_waivers(path, table.get("waivers", []))), **texts
    )


def _waivers(path: Path, entries: Any) -> list[Waiver]:
    headers = [
        number
        for number, line in enumerate(path.read_text("utf-8").splitlines(), start=1)
        if line.strip() == "[[tool.dbcspec.waivers]]"
    ]
    waivers: list[Waiver] = []
    for index, entry in enumerate(entries):
        if not isinstance(entry, dict) or set(entry) != _WAIVER_KEYS or not all(entry.values()):
            raise ReadError(f"{path}: waiver {index + 1} needs rule, subject and reason, each text")
        line = headers[index] if index < len(headers) else 1
        waivers.append(Waiver(**entry, where=Location(path.name, line)))
    return waivers
