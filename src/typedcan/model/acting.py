"""Codes at which something moves, and what a signal holds so that nothing moves by omission."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class ActingCodes:
    """Codes of a signal at which its receiver acts, and ``safe``, the code that ends that.

    To act is to close a contactor, to charge, heat, cool or pump. Codes with ``reports`` command
    nothing, but say that something is on. ``reference`` is the clause.
    """

    codes: tuple[int, ...]
    safe: int
    reports: bool = False
    reference: str = ""

    @property
    def kind(self) -> str:
        """``report`` or ``command``, as specs and matrices write it."""
        return "report" if self.reports else "command"


def no_value(invalid_code: int | None) -> int:
    """The raw value that stands for no value: the invalid code, else 0."""
    return 0 if invalid_code is None else invalid_code


def usual_start(invalid_code: int | None, acting: ActingCodes | None) -> int:
    """What a signal holds at first where nobody says more: no value, or the safe code for it.

    The safe code stands where the raw value of no value acts.
    """
    nothing = no_value(invalid_code)
    return acting.safe if acting and nothing in acting.codes else nothing
