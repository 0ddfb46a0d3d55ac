"""The checksums of AUTOSAR's end-to-end protection, as far as cantools knows them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from typedcan.model.protection import Checksum

PROFILES: Mapping[str, int] = MappingProxyType({"PROFILE_02": 16, "PROFILE_05": 1})
"""The profiles, and how many data ids each has."""


def e2e_checksum(
    profile: str, signal: str, covered: Sequence[int], data_ids: Sequence[int]
) -> Checksum:
    """The checksum of a message with as many data ids as its profile has.

    Profile 2 covers the data id that the counter chooses last, profile 5 its only one, low byte
    first.
    """
    if profile == "PROFILE_02":
        return Checksum(
            signal=signal,
            algorithm="CRC-8/AUTOSAR",
            covered=tuple(covered),
            data_ids=tuple(data_ids),
        )
    high, low = divmod(data_ids[0], 0x100)
    return Checksum(
        signal=signal,
        algorithm="CRC-16/IBM-3740",
        covered=tuple(covered),
        after=(low, high),
    )
