"""The option that names what computes a checksum algorithm."""

from __future__ import annotations

import argparse
import os
import sys
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from operator import attrgetter
from typing import cast

from typedcan.model.checksums.methods import Algorithm
from typedcan.model.checksums.registry import Given
from typedcan.model.errors import one_line
from typedcan.model.plain import shown
from typedcan.shell.console import CommandError


@dataclass(frozen=True, slots=True)
class NamedFunction:
    """A function by its module and name, which other processes find by them too."""

    reference: str

    def __call__(self, data: bytes) -> int:
        """What the function makes of some bytes."""
        return _function(self.reference)(data)


def add_algorithm_option(parser: argparse._ActionsContainer) -> None:
    """Add --algorithm."""
    parser.add_argument(
        "--algorithm",
        action="append",
        default=[],
        metavar="NAME=MODULE:FUNCTION",
        help="compute the checksums that the protocol calls NAME by a function of yours, from the"
        " covered bytes to an int, or by one that is known, as in Status_CRC=CRC-8/SAE-J1850",
    )


def algorithms_of(options: argparse.Namespace) -> Given:
    """What the option says; raises `CommandError` where that can be no algorithm.

    Modules are looked for in the folder that the command runs in, too.
    """
    given: dict[str, Algorithm | str] = {}
    for text in options.algorithm:
        name, equals, chosen = text.partition("=")
        if not (name and equals and chosen):
            raise CommandError(
                f"--algorithm {shown(text)}: expected NAME=MODULE:FUNCTION or NAME=ALGORITHM"
            )
        if name in given:
            raise CommandError(f"--algorithm {name}: given twice")
        given[name] = _named(name, chosen) if ":" in chosen else chosen
    return given


def _named(name: str, reference: str) -> NamedFunction:
    try:
        _function(reference)
    except CommandError as error:
        raise CommandError(f"--algorithm {name}: {error}") from None
    return NamedFunction(reference)


@cache
def _function(reference: str) -> Algorithm:
    module, _, path = reference.partition(":")
    if not all(part.isidentifier() for part in (*module.split("."), *path.split("."))):
        raise CommandError(f"{shown(reference)} is no MODULE:FUNCTION")
    here = os.getcwd()  # noqa: PTH109 - as it stands in sys.path
    if here not in sys.path:
        sys.path.append(here)
    try:
        imported = import_module(module)
    except Exception as error:  # noqa: BLE001 - code of others raises what it likes
        raise CommandError(f"{module} cannot be imported: {one_line(error)}") from None
    try:
        found: object = attrgetter(path)(imported)
    except Exception:  # noqa: BLE001 - as above
        raise CommandError(f"{module} has no {path}") from None
    if not callable(found):
        raise CommandError(f"{reference} is no function")
    return cast("Algorithm", found)
