"""Codes that act as an argument in generated Python, broken into lines as the formatter does."""

from __future__ import annotations

from typedcan.model.acting import ActingCodes

_LONGEST_LINE = 100
_INDENT = 12


def acting_codes(acting: ActingCodes) -> str:
    """The value of the argument ``acting`` of a field."""
    numbers = [*map(str, acting.codes)]
    codes = f"{{{', '.join(numbers)}}}"
    facts = [f"safe={acting.safe}", *(["reports=True"] if acting.reports else [])]
    line = f"codes=frozenset({codes}), {', '.join(facts)}"
    if _INDENT + len(f"acting=ActingCodes({line}),") <= _LONGEST_LINE:
        return f"ActingCodes({line})"
    if _INDENT + 4 + len(line) > _LONGEST_LINE:
        line = ",\n".join((_set(codes, numbers), *(f"{' ' * 16}{fact}" for fact in facts), ""))
        return f"ActingCodes(\n{' ' * 16}{line}{' ' * _INDENT})"
    return f"ActingCodes(\n{' ' * 16}{line}\n{' ' * _INDENT})"


def _set(codes: str, numbers: list[str]) -> str:
    """The codes as the first of several lines of arguments."""
    if 16 + len(f"codes=frozenset({codes}),") <= _LONGEST_LINE:
        return f"codes=frozenset({codes})"
    if 20 + len(codes) > _LONGEST_LINE:
        rows = "".join(f"{' ' * 24}{number},\n" for number in numbers)
        codes = f"{{\n{rows}{' ' * 20}}}"
    return f"codes=frozenset(\n{' ' * 20}{codes}\n{' ' * 16})"
