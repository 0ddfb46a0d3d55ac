"""Which files are generated, with which bytes."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from dbcspec.config import Config
from dbcspec.emit.dbc import emit_dbc
from dbcspec.emit.foreign import foreign_artifacts as emit_foreign
from dbcspec.emit.foreign import without_hidden
from dbcspec.emit.json_schema import emit_json_schemas
from dbcspec.emit.long_names import ORIGINAL_NAMES, dbc_names, with_dbc_names
from dbcspec.emit.stub_names import package_name
from dbcspec.emit.stubs import emit_stubs
from dbcspec.matrix.write import emit_matrix
from dbcspec.spec.rows import DOCUMENTS
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Protocol
from typedcan.model.soundness import renames, with_unique_names
from typedcan.shell.files import put_in_place

_DIFF_LINES = 8
_SURPLUS = "no longer generated: delete it"
_DIGEST = re.compile(rb"\b[0-9a-f]{16}\b")


@dataclass(frozen=True, slots=True)
class Stale:
    """A file on disk that is not what the spec makes: why, and a short diff."""

    path: str
    why: str
    diff: tuple[str, ...] = ()

    @property
    def is_surplus(self) -> bool:
        """Whether the file is to be deleted: nothing writes it."""
        return self.why == _SURPLUS


def artifacts(
    protocol: Protocol, config: Config, editions: Mapping[str, Protocol] = MappingProxyType({})
) -> dict[str, bytes]:
    """Every generated file: path below the project's root, with forward slashes, to bytes.

    Each of the ``editions`` has its DBC files in a folder of its name.
    """
    made = dbc_files(protocol, config.name, f"{config.dbc}/")
    for name, edition in editions.items():
        made |= dbc_files(edition, config.name, f"{config.dbc}/{name}/")
    if config.stubs:
        for name, text in emit_stubs(protocol).items():
            made[f"{config.stubs}/{name}"] = text.encode("utf-8")
        made[f"{config.stubs}/{config.name}.dbc"] = made[f"{config.dbc}/{config.name}.dbc"]
    for name, text in emit_json_schemas(DOCUMENTS).items():
        made[f"{config.spec}/schema/{name}"] = text.encode("utf-8")
    return made


def dbc_files(protocol: Protocol, name: str, folder: str) -> dict[str, bytes]:
    """The DBC files of a spec: one for everything, two with Chinese texts, one for each bus."""
    protocol = without_hidden(protocol)
    chinese = emit_dbc(protocol, english=False)
    buses = {bus.name: emit_dbc(protocol, bus=bus) for bus in protocol.buses}
    return {
        f"{folder}{name}.dbc": _encoded(emit_dbc(protocol), "ascii", "utf-8"),
        f"{folder}{name}.zh.dbc": _encoded(chinese, "gb2312", "gb18030"),
        f"{folder}{name}.zh-utf8.dbc": chinese.encode("utf-8"),
        **{
            f"{folder}{name}-{bus}.dbc": _encoded(text, "ascii", "utf-8")
            for bus, text in buses.items()
        },
    }


def _encoded(text: str, usual: str, instead: str) -> bytes:
    """The text in the usual encoding; in another one where that has not all of its letters."""
    try:
        return text.encode(usual)
    except UnicodeEncodeError:
        return text.encode(instead)


def chosen_artifacts(protocol: Protocol, config: Config) -> dict[str, bytes]:
    """What is generated of another edition or reading: DBC files, and stubs where there are any."""
    made = dbc_files(protocol, config.name, "")
    if config.stubs:
        package = package_name(config.name)
        for name, text in emit_stubs(protocol).items():
            made[f"{package}/{name}"] = text.encode("utf-8")
        made[f"{package}/{config.name}.dbc"] = made[f"{config.name}.dbc"]
    return made


def foreign_artifacts(protocol: Protocol, name: str) -> dict[str, bytes]:
    """What is generated of a protocol that is not the project's: DBC, stubs and matrix."""
    named = made_safe(protocol)
    made = emit_foreign(named, name)
    return {**made, f"{name}.xlsx": emit_matrix(named)}


def made_safe(protocol: Protocol) -> Protocol:
    """The protocol with names that a DBC, Python and a spec take, no two the same."""
    return with_dbc_names(with_unique_names(protocol))


def made_safe_how(protocol: Protocol) -> list[str]:
    """What `made_safe` changes, a line for each kind of change."""
    said = [*renames(protocol)]
    names = dbc_names(protocol)
    if names:
        some = ", ".join(f"{old!r} is {new}" for old, new in [*names.items()][:_DIFF_LINES])
        more = f" and {len(names) - _DIFF_LINES} more" if len(names) > _DIFF_LINES else ""
        kept = f"{', '.join(ORIGINAL_NAMES.values())} keep the old ones"
        said.append(f"names that no DBC can have: {some}{more}; {kept}")
    return said


def write(root: Path, files: Mapping[str, bytes]) -> list[str]:
    """Write what differs and return its paths; raises `ReadError` or `CommandError`.

    A failure leaves the last generation whole.
    """
    changed = [name for name, data in files.items() if _bytes(root / name) != data]
    targets = {root / name: files[name] for name in changed}
    for target in targets:
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ReadError(f"{target.parent}: cannot be written: {error.strerror}") from None
    put_in_place(targets)
    return changed


def verify(
    root: Path, files: Mapping[str, bytes], protocol: Protocol, config: Config
) -> list[Stale]:
    """What on disk is missing, stale, edited by hand, or no longer generated."""
    found: list[Stale] = []
    for name, data in files.items():
        present = _bytes(root / name)
        if present is None:
            found.append(Stale(name, "missing"))
        elif present != data:
            digests = _DIGEST.findall(present)
            same_spec = protocol.digest.encode() in digests
            why = "edited by hand" if same_spec else "stale"
            found.append(Stale(name, why, _short_diff(present, data)))
    folder = root / config.dbc
    present_dbcs = [*folder.glob(f"{config.name}*.dbc"), *folder.glob(f"*/{config.name}*.dbc")]
    surplus = {path.relative_to(root).as_posix() for path in present_dbcs} - set(files)
    return found + [Stale(name, _SURPLUS) for name in sorted(surplus)]


def _bytes(path: Path) -> bytes | None:
    try:
        return path.read_bytes()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise ReadError(f"{path}: cannot be read: {error.strerror}") from None


def _text(data: bytes) -> str:
    """A file of ours as text: UTF-8, or GBK where it is a Chinese DBC for Windows."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("gbk", "backslashreplace")


def _short_diff(present: bytes, wanted: bytes) -> tuple[str, ...]:
    """The first differing lines, on disk first."""
    old, new = (_text(data).splitlines() for data in (present, wanted))
    lines = [
        line
        for line in difflib.unified_diff(old, new, lineterm="", n=0)
        if not line.startswith(("---", "+++", "@@"))
    ]
    if not lines:
        return ("line ends or the end of the file differ",)
    more = len(lines) - _DIFF_LINES
    return (*lines[:_DIFF_LINES], *([f"… {more} more lines"] if more > 0 else []))
