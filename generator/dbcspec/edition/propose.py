"""An edition proposed from a supplier's file, tried before anything is written."""

from __future__ import annotations

import re
import shutil
import tempfile
from pathlib import Path

from dbcspec.config import Config
from dbcspec.edition.files import FirstPatch, first_patch
from dbcspec.emit.long_names import with_dbc_names
from dbcspec.errors import SpecError
from dbcspec.spec.compiled import compile_spec
from dbcspec.spec.rows import EDITION_NAME
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Protocol


def propose_edition(
    config: Config, name: str, found: Protocol, title: str, over: str
) -> FirstPatch:
    """The files of an edition ``name`` of a project's spec; nothing is written to disk.

    Raises `ReadError` for a name that is none or is taken, and `SpecError` where the spec does not
    compile, by itself or with the edition.
    """
    folder = config.root / config.spec
    if not re.fullmatch(EDITION_NAME, name):
        raise ReadError(f"{name!r} is no name of an edition: letters, digits, dots, dashes")
    if (folder / "editions" / name).exists():
        raise ReadError(f"{config.spec}/editions/{name}: is there already; choose another name")
    base = compile_spec(folder, config.spec, config.name, over)
    patch = first_patch(base, with_dbc_names(found), title, over)
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch) / folder.name
        shutil.copytree(folder, copy)
        for path, data in patch.files.items():
            target = copy / "editions" / name / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(data)
        made = compile_spec(copy, config.spec, config.name, name)
    if made.errata_faults:
        raise SpecError(made.errata_faults)
    return patch
