"""The model that lies in a generated package, beside its code."""

from __future__ import annotations

import pkgutil
import sys
from pathlib import Path

from typedcan.model.errors import DatabaseError, ReadError
from typedcan.model.protocol import Protocol
from typedcan.model.serial import from_json

MODEL_FILE = "protocol.json"
"""The name of the file."""


def read_model(module: str, digest: str) -> Protocol:
    """The model beside a module, whose ``__name__`` is given, also where both lie in a zip file.

    Raises `DatabaseError` where it is not there, cannot be read, or has another digest than the
    code.
    """
    path = Path(sys.modules[module].__file__ or module).with_name(MODEL_FILE)
    try:
        # Whatever has loaded the package has what lies beside its code.
        data = pkgutil.get_data(module.rpartition(".")[0], MODEL_FILE) or b""
        protocol = from_json(data.decode("utf-8"), str(path))
    except (OSError, UnicodeDecodeError, ReadError) as error:
        raise DatabaseError(f"{path}: {error}") from None
    if protocol.digest != digest:
        raise DatabaseError(
            f"{path} has digest {protocol.digest}, the code beside it {digest}:"
            " run `dbcspec generate`, or install the package again"
        )
    return protocol
