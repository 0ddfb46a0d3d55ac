"""A changed model back into the spec: the YAML edited in place, for a person to review."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from dbcspec.errors import SpecError
from dbcspec.spec.differences import differences
from dbcspec.spec.errata import apply_errata
from dbcspec.spec.folder import read_spec
from dbcspec.spec.resolve import resolve
from dbcspec.spec.writer import SpecWriter
from typedcan.model.protocol import Protocol


@dataclass(frozen=True, slots=True)
class Proposal:
    """What would change in a spec folder.

    ``files`` has the new bytes of each changed file by its path below the folder, with forward
    slashes; ``not_written`` one line for each difference that a person has to settle.
    """

    files: Mapping[str, bytes]
    not_written: tuple[str, ...]


def propose_spec(spec_folder: Path, old: Protocol, new: Protocol) -> Proposal:
    """Edit the spec's YAML so that it makes ``new``; nothing is written to disk.

    ``old`` is the model that the spec makes now, ``new`` mostly that of a matrix. Values are
    replaced where they stand and new rows are appended; all else keeps its bytes. What an
    erratum sets or keeps is left alone, nothing is deleted, and nothing is renamed: such
    differences are listed. Raises `SpecError` where the spec cannot be read.
    """
    if not any(differences(old, new)):
        return Proposal({}, ())
    printed = read_spec(spec_folder, spec_folder.name)
    corrected, _ = apply_errata(printed)
    writer = SpecWriter(spec_folder, printed, corrected, old, new)
    files = writer.write()
    try:
        made = _resolved(spec_folder, files, old.name)
    except SpecError as error:
        faults = (f"the change makes no sound spec: {fault}" for fault in error.faults)
        return Proposal({}, tuple(faults))
    left = (writer.explained(each) for each in differences(made, new))
    return Proposal(files, tuple(left))


def _resolved(folder: Path, files: Mapping[str, bytes], name: str) -> Protocol:
    """The model that the spec folder would make with these files."""
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch) / folder.name
        shutil.copytree(folder, copy)
        for path, data in files.items():
            (copy / path).write_bytes(data)
        spec, _ = apply_errata(read_spec(copy, folder.name))
        return resolve(spec, name)
