"""Bits that become free, and signals that behaviour names and that cannot go."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import fields

from dbcspec.spec.rows import Spec
from typedcan.model.protocol import ByteOrder


def free_pieces(free: Collection[int], order: ByteOrder) -> Iterator[tuple[int, int]]:
    """Start bit and length of the runs of free bits, none longer than its byte.

    In Motorola order a run starts at its most significant bit.
    """
    run: list[int] = []
    for bit in [*sorted(free), None]:
        if run and (bit is None or bit != run[-1] + 1 or bit % 8 == 0):
            yield (run[0] if order is ByteOrder.INTEL else run[-1]), len(run)
            run = []
        if bit is not None:
            run.append(bit)


def named_in_behaviour(spec: Spec) -> set[str]:
    """The signals that checksums, counters, transfers, requests and acts speak of."""
    found: set[str] = set()
    behaviour = spec.behaviour
    for rows in (
        behaviour.checksums,
        behaviour.counters,
        behaviour.transfers,
        behaviour.requests,
        behaviour.acts,
    ):
        for row in rows:
            for part in fields(row):
                value = getattr(row, part.name)
                if isinstance(value, str):
                    found.add(value)
                elif isinstance(value, tuple):
                    found.update(each for each in value if isinstance(each, str))
    return found
