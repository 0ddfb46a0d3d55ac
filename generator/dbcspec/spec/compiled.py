"""A spec folder to the model, in one go: read, choose readings, correct, resolve."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from dbcspec.errors import Fault, SpecError
from dbcspec.spec.errata import apply_errata
from dbcspec.spec.folder import read_spec
from dbcspec.spec.readings import USUAL, Choice, choice_of, errata_in_force, with_editions
from dbcspec.spec.resolve import resolve
from dbcspec.spec.rows import Spec
from typedcan.model.protocol import Protocol


@dataclass(frozen=True, slots=True)
class Compiled:
    """The corrected rows, the model, and the changes of errata that could not be made."""

    spec: Spec
    protocol: Protocol
    errata_faults: tuple[Fault, ...]
    printed: Spec


def compile_spec(folder: Path, shown_as: str, name: str, choice: str = "") -> Compiled:
    """Make the model called ``name``; raises `SpecError` with every fault that prevents it.

    ``shown_as`` is the folder's path as locations shall name it, ``choice`` the edition and the
    readings, as ``v4.6+E50b``. Raises `ReadError` for a choice that the spec does not have.
    """
    printed = read_spec(folder, shown_as)
    return compile_rows(printed, name, choice_of(printed, choice))


def compile_rows(printed: Spec, name: str, choice: Choice = USUAL) -> Compiled:
    """The same for rows as printed."""
    errata = errata_in_force(printed, choice)
    spec, errata_faults = apply_errata(with_editions(printed, choice), errata)
    try:
        protocol = resolve(spec, name, errata, str(choice))
    except SpecError as error:
        # An erratum that failed is often why something is missing: show both.
        raise SpecError([*error.faults, *errata_faults]) from None
    return Compiled(spec, protocol, errata_faults, printed)
