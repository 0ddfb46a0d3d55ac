"""The checksum algorithms by name or by parameters, and those that somebody gives."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping
from functools import cache

from typedcan.model.checksums.catalogue import CATALOGUE
from typedcan.model.checksums.methods import Algorithm, Crc, Method, Sum, Xor
from typedcan.model.errors import TypedcanError, one_line

Given = Mapping[str, Algorithm | str]
"""By the name in the spec, what computes an algorithm: a function, or what `method_of` knows."""

WIDEST = 64
"""Bits of the widest checksum."""

_EXAMPLE = "width=8 poly=0x1D init=0xFF refin=false refout=false xorout=0xFF"


class AlgorithmError(TypedcanError, ValueError):
    """An algorithm that there is not, or a function that makes no checksum."""


def names() -> tuple[str, ...]:
    """The names of all that are known: those of CRCs as the public catalogue has them."""
    return ("xor", "sum", *(name for name, _, _ in _entries()))


def method_of(text: str) -> Method:
    """What a spec calls an algorithm.

    Parameters
    ----------
    text
        ``xor``, ``sum`` and their parameters, such as ``sum modulus=255 complement=ones``; the name
        of a CRC, where neither case nor punctuation counts; or its parameters as the public
        catalogue writes them, such as ``width=8 poly=0x1D init=0xFF refin=false refout=false
        xorout=0xFF``, of which width and poly have to be given.

    Raises
    ------
    AlgorithmError
        It is nothing of these.
    """
    kind, *rest = text.split() or [""]
    if "=" in kind:
        return _crc(_Parameters(text, [kind, *rest]))
    if kind.lower() in ("xor", "sum"):
        given = _Parameters(text, rest)
        return _sum(given) if kind.lower() == "sum" else _xor(given)
    found = _by_key().get(_key(text))
    if found is None:
        close = difflib.get_close_matches(_key(text[:100]), _by_key(), n=3, cutoff=0.75)
        likely = dict.fromkeys(canonical_name(each) for each in close)
        hint = f"is it {' or '.join(likely)}?" if likely else "known are xor, sum and CRCs by name"
        raise AlgorithmError(f"nothing here computes {text!r:.100}; {hint}")
    return found


def canonical_name(text: str) -> str:
    """The name that stands for an algorithm in models; one that is not known as it is."""
    try:
        method = method_of(text)
    except AlgorithmError:
        return text
    return next((name for name, crc, _ in _entries() if crc == method), str(method))


def is_known(text: str) -> bool:
    """Whether `method_of` knows an algorithm."""
    return chosen_of(text, {}) is not None


def chosen_of(name: str, given: Given) -> Method | Algorithm | None:
    """What is to compute the algorithm of that name: what is given, else what is known, else None.

    Raises `AlgorithmError` for a text among the given that is no algorithm.
    """
    chosen = given.get(name)
    if chosen is None:
        try:
            return method_of(name)
        except AlgorithmError:
            return None
    return method_of(chosen) if isinstance(chosen, str) else chosen


def function_of(name: str, bits: int, given: Given) -> Algorithm | None:
    """What computes the algorithm of that name for a signal of so many bits; None where nothing.

    Raises `AlgorithmError` as `chosen_of`, and for one that makes more bits than the signal has;
    a function that makes no checksum raises it when it is called.
    """
    chosen = chosen_of(name, given)
    if chosen is None:
        return None
    if not isinstance(chosen, Method):
        return _watched(name, chosen, bits)
    made = chosen.result_bits(bits)
    if made > bits:
        raise AlgorithmError(f"{name} makes {made} bits, its signal has {bits}")
    return chosen.function(bits)


def _watched(name: str, function: Algorithm, bits: int) -> Algorithm:
    """A function of somebody's, whose results are looked at."""

    def compute(data: bytes) -> int:
        try:
            value = function(data)
        except Exception as error:
            raise AlgorithmError(f"the algorithm {name} raised {one_line(error)}") from error
        if not isinstance(value, int) or isinstance(value, bool):
            raise AlgorithmError(f"the algorithm {name} made {value!r:.40}, which is no int")
        if not 0 <= value < 1 << bits:
            raise AlgorithmError(f"the algorithm {name} made {value}, its signal has {bits} bits")
        return value

    return compute


@cache
def _entries() -> tuple[tuple[str, Crc, tuple[str, ...]], ...]:
    """The catalogue: name, parameters, other names."""
    return tuple(map(_entry, CATALOGUE.strip().splitlines()))


def _entry(line: str) -> tuple[str, Crc, tuple[str, ...]]:
    name, width, poly, init, xorout, reflected, *others = line.split()
    crc = Crc(
        width=int(width),
        poly=int(poly, 16),
        init=int(init, 16),
        refin=reflected[0] == "r",
        refout=reflected[1] == "r",
        xorout=int(xorout, 16),
    )
    return name, crc, tuple(others)


@cache
def _by_key() -> dict[str, Crc]:
    """The catalogue under all names, as `_key` has them."""
    return {_key(each): crc for name, crc, others in _entries() for each in (name, *others)}


def _key(name: str) -> str:
    return re.sub(r"[\W_]", "", name.lower())


class _Parameters:
    """The parameters in the text of an algorithm; each is taken once, and none may be left."""

    def __init__(self, text: str, words: Iterable[str]) -> None:
        self._text = f"{text!r:.100}"
        self._facts: dict[str, str] = {}
        for word in words:
            name, equals, value = word.lower().partition("=")
            if not equals or name in self._facts:
                raise self.error(f"expected parameters such as {_EXAMPLE}, each once")
            self._facts[name] = value

    def error(self, problem: str) -> AlgorithmError:
        """That something is wrong with them."""
        return AlgorithmError(f"{self._text}: {problem}")

    def number(self, name: str, most: int, *, least: int = 0, usual: int | None = None) -> int:
        """A whole number; where it is not given the usual one, if there is one."""
        word = self._facts.pop(name, None)
        if word is None and usual is not None:
            return usual
        number = -1
        if re.fullmatch(r"0x[0-9a-f]{1,20}|\d{1,20}", word or ""):
            number = int(word or "", 16 if "x" in (word or "") else 10)
        if not least <= number <= most:
            raise self.error(f"{name} is to be a number from {least} to 0x{most:X}")
        return number

    def word(self, name: str, *words: str) -> str:
        """One of a few words, the first where it is not given."""
        word = self._facts.pop(name, words[0])
        if word not in words:
            raise self.error(f"{name} is to be {' or '.join(filter(None, words))}")
        return word

    def end(self) -> None:
        """Refuse what is left."""
        if self._facts:
            raise self.error(f"there is no parameter {', '.join(self._facts)}")


def _crc(given: _Parameters) -> Crc:
    width = given.number("width", WIDEST, least=1)
    most = (1 << width) - 1
    crc = Crc(
        width=width,
        poly=given.number("poly", most),
        init=given.number("init", most, usual=0),
        refin=given.word("refin", "false", "true") == "true",
        refout=given.word("refout", "false", "true") == "true",
        xorout=given.number("xorout", most, usual=0),
    )
    made = crc.function(width)(b"123456789")
    check = given.number("check", most, usual=made)
    if made != check:
        raise given.error(f"they make 0x{made:X} of '123456789', not the check 0x{check:X}")
    given.end()
    return crc


def _sum(given: _Parameters) -> Sum:
    made = Sum(
        modulus=given.number("modulus", 1 << 32, usual=0),
        complement=given.word("complement", "", "ones", "twos"),
        unit=int(given.word("unit", "8", "4")),
    )
    given.end()
    return made


def _xor(given: _Parameters) -> Xor:
    made = Xor(unit=int(given.word("unit", "8", "4")))
    given.end()
    return made
