"""All rules, in the order in which reports list them."""

from __future__ import annotations

from swapcan.conform.rule import Rule
from swapcan.conform.rules import (
    charging,
    content,
    cooling,
    frames,
    pack,
    protection,
    requests,
    timing,
    told,
    transfers,
    voltage,
)

RULES: tuple[Rule, ...] = (
    *frames.RULES,
    *protection.RULES,
    *timing.RULES,
    *content.RULES,
    *requests.RULES,
    *transfers.RULES,
    *pack.RULES,
    *voltage.RULES,
    *charging.RULES,
    *cooling.RULES,
    *told.RULES,
)
"""Every rule once."""
