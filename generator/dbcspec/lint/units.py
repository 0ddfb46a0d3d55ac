"""The units that signals usually have, and how they are put together.

What the table of the field does not know, Pint's does: units written out, and those of others.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache

_PREFIXES = ("", "p", "n", "u", "µ", "μ", "m", "c", "d", "h", "k", "M", "G", "T")
_PREFIXED = """
    m g s A K mol cd rad sr Hz N Pa J W C V F ohm Ohm Ω Ω S Wb T H lm lx Bq Gy Sv eV bar Ah As
    Wh VA VAr var Nm Ns l L bit Bit byte Byte B Bd
"""
_PLAIN = """
    % ‰ %RH ppm ppb deg ° degC °C ℃ degF °F degK °K min Min sec Sec h hr hour hours day days d
    week month year a t rpm RPM U r rev mph kph kmh kmph KPH psi atm mmHg inHg hp PS dB dBm dBA G ft
    in inch mi mile miles gal ha bps kbps Mbps count counts cnt step steps pulse pulses pcs
    cell cells tooth teeth cyl stroke arcmin arcsec
"""
_SEPARATORS = re.compile(r"[/*·⋅. ]")
_SHORTEST_WORD, _LONGEST_WORD = 5, 32
"""Letters of a name that is written out, whose case means nothing."""

_EXPONENT = re.compile(r"(?:\^?-?\d|[²³⁻¹]+)$")


@cache
def known_units() -> frozenset[str]:
    """All single units with all their prefixes."""
    prefixed = (f"{prefix}{unit}" for prefix in _PREFIXES for unit in _PREFIXED.split())
    return frozenset((*_PLAIN.split(), *prefixed))


@cache
def _library() -> Callable[[str], tuple[object, ...]]:
    """What Pint takes a name for; imported for unusual units only: that takes half a second."""
    from pint import UnitRegistry

    registry: UnitRegistry[float] = UnitRegistry()
    return registry.parse_unit_name


def _is_in_library(name: str) -> bool:
    """Whether Pint knows a unit by its symbol, or by its name in any case."""
    names = (name, name.lower()) if len(name) >= _SHORTEST_WORD else (name,)
    return any(map(_library(), names))


def is_known(unit: str, extra: frozenset[str] = frozenset()) -> bool:
    """Whether a unit, or each part of a quotient or product, is known or one of ``extra``."""
    known = known_units() | extra
    parts = [part for part in _SEPARATORS.split(unit) if part]
    return unit.strip() in known or (
        bool(parts) and all(part.isdecimal() or _is_part(part, known) for part in parts)
    )


def _is_part(part: str, known: frozenset[str]) -> bool:
    """Whether it is a unit, perhaps behind a number and before an exponent."""
    unit = part.lstrip("0123456789")
    bare = _EXPONENT.sub("", unit)
    if unit in known or bare in known:
        return True
    return bare.isalpha() and len(bare) <= _LONGEST_WORD and _is_in_library(bare)
