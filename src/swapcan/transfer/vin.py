"""What makes 17 characters a VIN: ISO 3779 and the check digit of GB 16735 and 49 CFR 565."""

from __future__ import annotations

VIN_LENGTH = 17
"""Characters of every VIN."""

_CHECK_POSITION = 8
_EXCLUDED = "IOQ"
_VALUES = {
    **{str(digit): digit for digit in range(10)},
    **dict(zip("ABCDEFGH", range(1, 9), strict=True)),
    **dict(zip("JKLMN", range(1, 6), strict=True)),
    "P": 7,
    "R": 9,
    **dict(zip("STUVWXYZ", range(2, 10), strict=True)),
}
_WEIGHTS = (8, 7, 6, 5, 4, 3, 2, 10, 0, 9, 8, 7, 6, 5, 4, 3, 2)


def check_digit(text: str) -> str:
    """What position 9 of a VIN must hold, 0 to 9 or X; whatever stands there now is not looked at.

    Raises `ValueError` for a text that is not 17 of the characters that a VIN can have.
    """
    problem = _form_problem(text[:_CHECK_POSITION] + "0" + text[_CHECK_POSITION + 1 :])
    if problem:
        raise ValueError(problem)
    letters = text[:_CHECK_POSITION] + "0" + text[_CHECK_POSITION + 1 :]
    total = sum(_VALUES[letter] * weight for letter, weight in zip(letters, _WEIGHTS, strict=True))
    return "0123456789X"[total % 11]


def vin_problem(text: str) -> str | None:
    """Why a text is no VIN, in a few words; None where it is one.

    ISO 3779: 17 of the digits and capital letters, without I, O and Q. The check digit in
    position 9 is mandatory in China and North America; elsewhere a VIN may lack it.
    """
    if problem := _form_problem(text):
        return problem
    expected = check_digit(text)
    found = text[_CHECK_POSITION]
    if found != expected:
        return f"check digit (position 9) is {found!r}, the other characters make {expected!r}"
    return None


def is_valid_vin(text: str) -> bool:
    """Whether a text is a VIN, as `vin_problem` says."""
    return vin_problem(text) is None


def _form_problem(text: str) -> str | None:
    if len(text) != VIN_LENGTH:
        return f"a VIN has {VIN_LENGTH} characters, not {len(text)}"
    for position, letter in enumerate(text, 1):
        if letter in _EXCLUDED:
            return f"character {position} is {letter!r}; a VIN has no I, O and Q"
        if letter not in _VALUES:
            return f"character {position}, {letter!r}, is no digit or capital letter"
    return None
