"""What the codes of a signal's value table mean: values, numbers, or states of the signal."""

from __future__ import annotations

from typedcan.model.protocol import Code, Signal


def value_codes(signal: Signal) -> tuple[Code, ...]:
    """The codes that are values, without those for invalid and abnormal."""
    codes = signal.value_table.codes if signal.value_table else ()
    return tuple(code for code in codes if code.value not in signal.states)


def is_numbering(codes: tuple[Code, ...]) -> bool:
    """Whether labels only repeat the code behind one word, as CSC1, CSC2 and so on do."""
    words = {code.english.removesuffix(str(code.value)) for code in codes}
    return len(words) == 1 and all(code.english.endswith(str(code.value)) for code in codes)
