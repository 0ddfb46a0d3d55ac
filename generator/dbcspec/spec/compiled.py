"""A spec folder to the model, in one go: read, correct, resolve."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from dbcspec.errors import Fault, SpecError
from dbcspec.spec.errata import apply_errata
from dbcspec.spec.folder import read_spec
from dbcspec.spec.resolve import resolve
from dbcspec.spec.rows import Spec
from typedcan.model.protocol import Protocol


@dataclass(frozen=True, slots=True)
class Compiled:
    """The corrected rows, the model, and the changes of errata that could not be made."""

    spec: Spec
    protocol: Protocol
    errata_faults: tuple[Fault, ...]


def compile_spec(folder: Path, shown_as: str, name: str) -> Compiled:
    """Make the model called ``name``; raises `SpecError` with every fault that prevents it.

    ``shown_as`` is the folder's path as locations shall name it.
    """
    spec, errata_faults = apply_errata(read_spec(folder, shown_as))
    try:
        protocol = resolve(spec, name)
    except SpecError as error:
        # An erratum that failed is often why something is missing: show both.
        raise SpecError([*error.faults, *errata_faults]) from None
    return Compiled(spec, protocol, errata_faults)
