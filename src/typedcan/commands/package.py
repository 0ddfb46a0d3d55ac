"""A generated package that the command line names."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pathlib import Path

from typedcan.dynamic import typed_protocol
from typedcan.model import protocol as model
from typedcan.model.errors import ReadError, one_line
from typedcan.model.package import MODEL_FILE
from typedcan.model.plain import shown
from typedcan.model.serial import from_json
from typedcan.shell.console import CommandError
from typedcan.wire.protocol import Protocol


@cache
def named_package(name: str) -> Protocol:
    """The protocol of a package, by its dotted name or its folder.

    Of a folder no code is run: what it says of the protocol is enough. Raises `CommandError` and
    `ReadError`.
    """
    folder = Path(name)
    if (folder / MODEL_FILE).is_file():
        return typed_protocol(_model(folder / MODEL_FILE))
    if folder.exists() or not all(part.isidentifier() for part in name.split(".")):
        raise CommandError(
            f"--protocol {shown(name)}: no package that `dbcspec generate` wrote: it has no"
            f" {MODEL_FILE}"
        )
    return _imported(name)


def _model(file: Path) -> model.Protocol:
    try:
        return from_json(file.read_text("utf-8"), str(file))
    except (OSError, UnicodeDecodeError) as error:
        raise ReadError(f"{file}: {one_line(error)}") from None


def _imported(name: str) -> Protocol:
    try:
        found: object = import_module(f"{name}.protocol").PROTOCOL
    except Exception as error:  # noqa: BLE001 - code of others raises what it likes
        problem = f"--protocol {name}: cannot be imported: {one_line(error)}"
        raise CommandError(f"{problem}; is its folder in PYTHONPATH?") from None
    if not isinstance(found, Protocol):
        raise CommandError(f"--protocol {name}: {name}.protocol has no protocol of this runtime")
    return found
