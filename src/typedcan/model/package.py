"""The model that lies in a generated package, beside its code."""

from __future__ import annotations

from pathlib import Path

from typedcan.model.errors import DatabaseError, ReadError
from typedcan.model.protocol import Protocol
from typedcan.model.serial import from_json

MODEL_FILE = "protocol.json"
"""The name of the file."""


def read_model(module: str, digest: str) -> Protocol:
    """The model beside a module, whose ``__file__`` is given.

    Raises `DatabaseError` where it is not there, cannot be read, or has another digest than the
    code.
    """
    path = Path(module).with_name(MODEL_FILE)
    try:
        protocol = from_json(path.read_text("utf-8"), str(path))
    except (OSError, UnicodeDecodeError, ReadError) as error:
        raise DatabaseError(f"{path}: {error}") from None
    if protocol.digest != digest:
        raise DatabaseError(
            f"{path} has digest {protocol.digest}, the code beside it {digest}:"
            " run `dbcspec generate`, or install the package again"
        )
    return protocol
