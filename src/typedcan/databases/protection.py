"""AUTOSAR's end-to-end protection, where a database has it, as checksum and counter."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Sequence

from cantools.database.can import Message as CantoolsMessage

from typedcan.model.e2e import PROFILES, e2e_checksum
from typedcan.model.layout import bits
from typedcan.model.protection import Counter
from typedcan.model.protocol import Message
from typedcan.model.seal import protection_faults

_CRC_BITS = {"PROFILE_02": range(8), "PROFILE_05": range(16)}
_COUNTER_BITS = {"PROFILE_02": range(8, 12), "PROFILE_05": range(16, 24)}


def protected(message: Message, source: CantoolsMessage) -> Message:
    """The message with the checksum and counter of its profile.

    They are found by where the profile has them. A message of another profile, and one without a
    signal there, is as it was: what it is protected by cannot be said.
    """
    e2e = source.autosar.e2e if source.autosar else None
    # What files call the profile is up to them: PROFILE_02, Profile2, p2.
    number = re.fullmatch(r"\D*0?(\d)", (e2e.category if e2e else None) or "")
    profile = f"PROFILE_0{number[1]}" if number else ""
    ids = tuple((e2e.data_ids if e2e else None) or ())
    if e2e is None or len(ids) != PROFILES.get(profile):
        return message
    crc = _signal_at(message, _CRC_BITS[profile])
    counting = _signal_at(message, _COUNTER_BITS[profile])
    if crc is None:
        return message
    covered = range(len(_CRC_BITS[profile]) // 8, min(e2e.payload_length, message.length))
    modulus = 1 << len(_COUNTER_BITS[profile])
    found = dataclasses.replace(
        message,
        checksum=e2e_checksum(profile, crc, covered, ids),
        counter=Counter(signal=counting, modulus=modulus) if counting else None,
    )
    return message if any(protection_faults(found)) else found


def _signal_at(message: Message, wanted: Sequence[int]) -> str | None:
    """The signal whose bits, from the least significant one on, are these."""
    return next((each.name for each in message.signals if bits(each) == tuple(wanted)), None)
