"""What a protocol says of checksums and alive counters."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True, slots=True, kw_only=True)
class Checksum:
    """A checksum, wherever its signal stands.

    Parameters
    ----------
    signal
        Which carries it.
    algorithm
        As `typedcan.model.checksums.registry.canonical_name` has it, or a name that only the spec
        knows.
    covered
        The numbers of the bytes that are covered, in their order. Bits of the checksum itself among
        them count as 0.
    before, after
        Bytes that are covered too, though no frame carries them: a salt, the identifier, a data id.
    data_ids
        One byte of each; the one that the alive counter chooses comes behind all else.
    is_open
        Whether the standard names no algorithm, so that users have to give one.
    """

    signal: str
    algorithm: str
    covered: tuple[int, ...]
    before: tuple[int, ...] = ()
    after: tuple[int, ...] = ()
    data_ids: tuple[int, ...] = ()
    is_open: bool = False

    def covers(self, to: str = "~", between: str = " ") -> str:
        """The covered bytes as specs write them: "1~7", or "0 3~7"."""
        runs = _runs(self.covered)
        return between.join(f"{a}{to}{b}" if a != b else f"{a}" for a, b in runs)

    @property
    def extras(self) -> tuple[tuple[str, str], ...]:
        """What is covered besides, by the keys that specs have for it."""
        facts = {"before": self.before, "after": self.after, "data_ids": self.data_ids}
        return tuple(
            (key, " ".join(f"0x{b:02X}" for b in each)) for key, each in facts.items() if each
        )

    def __str__(self) -> str:
        more = "".join(f", {key.replace('_', ' ')} {text}" for key, text in self.extras)
        bytes_ = "bytes" if len(self.covered) > 1 else "byte"
        open_ = ", left open" if self.is_open else ""
        return f"{self.algorithm} of {bytes_} {self.covers(' to ', ', ')}{more}{open_}"


@dataclass(frozen=True, kw_only=True)
class Counter:
    """An alive counter: it runs through ``modulus`` values, from ``first`` on by ``step``."""

    signal: str
    modulus: int
    first: int = 0
    step: int = 1

    @cached_property
    def last(self) -> int:
        """The last value."""
        return self.first + (self.modulus - 1) * self.step

    def holds(self, value: int) -> bool:
        """Whether it runs through a value."""
        index, rest = divmod(value - self.first, self.step)
        return not rest and 0 <= index < self.modulus

    def after(self, value: int) -> int:
        """What comes after a value of its own: after the last one the first."""
        return self.first if value == self.last else value + self.step

    def before(self, value: int) -> int:
        """What comes before a value of its own."""
        return self.last if value == self.first else value - self.step

    def __str__(self) -> str:
        by = f" by {self.step}" if abs(self.step) != 1 else ""
        return f"{self.first} to {self.last}{by}"


def covered_bytes(text: str) -> tuple[int, ...]:
    """The numbers of bytes in a text such as "1~7" or "0 3~7"; none where a range falls."""
    covered: list[int] = []
    for part in text.split():
        first, _, last = part.partition("~")
        if last and int(last) < int(first):
            return ()
        covered += range(int(first), int(last or first) + 1)
    return tuple(covered)


def _runs(numbers: Iterable[int]) -> Iterator[tuple[int, int]]:
    """Numbers as first and last of what rises by one."""
    runs: list[tuple[int, int]] = []
    for number in numbers:
        if runs and runs[-1][1] == number - 1:
            runs[-1] = runs[-1][0], number
        else:
            runs.append((number, number))
    return iter(runs)
