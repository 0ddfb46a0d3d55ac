"""The VIN and the code of a pack: texts that take several frames."""

from __future__ import annotations

from swapcan.rules.texts import (
    pack_code_characters,
    pack_code_constant,
    pack_code_length,
    pack_code_transfer,
    vin_characters,
    vin_check_digit,
    vin_letters,
    vin_transfer,
)
from typedcan.judge.rule import Rule

RULES: tuple[Rule, ...] = (
    vin_transfer.RULE,
    vin_characters.RULE,
    vin_letters.RULE,
    vin_check_digit.RULE,
    pack_code_transfer.RULE,
    pack_code_characters.RULE,
    pack_code_length.RULE,
    pack_code_constant.RULE,
)
