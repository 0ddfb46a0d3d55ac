"""VIN and pack code: what they are when complete, and how they are split into frames."""

from __future__ import annotations

from dataclasses import dataclass

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    V2B_VIN,
    B2V_SysCode1,
    B2V_SysCode2,
    B2V_SysCode3,
    B2V_SysCode4,
    Manufacturer,
)
from swapcan.transfer.vin import vin_problem
from typedcan.transfer.layout import create
from typedcan.transfer.text import text_frames
from typedcan.wire.errors import TransferError

VIN = PROTOCOL.transfer("vin")
PACK_CODE = PROTOCOL.transfer("pack_code")

MANUFACTURER = "manufacturer"
"""The field beside the pack code that says who made the battery."""


@dataclass(frozen=True, slots=True)
class Vin:
    """A vehicle identification number that arrived complete."""

    text: str

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True, slots=True)
class PackCode:
    """A pack code after GB/T 34014 that arrived complete, and who made the battery."""

    text: str
    manufacturer: Manufacturer | int

    def __str__(self) -> str:
        return self.text


def split_vin(vin: str, *, check: bool = False) -> tuple[V2B_VIN, ...]:
    """The frames that carry a VIN, in order.

    With ``check`` it must be one after ISO 3779, check digit included. Raises `TransferError`.
    """
    if len(vin) != VIN.count:
        raise TransferError(VIN.name, f"a VIN has {VIN.count} characters, not {len(vin)}")
    if check and (problem := vin_problem(vin)):
        raise TransferError(VIN.name, problem)
    return tuple(create(V2B_VIN, values) for values in text_frames(VIN, vin))


def split_pack_code(
    code: str, manufacturer: Manufacturer | int = 0
) -> tuple[B2V_SysCode1, B2V_SysCode2, B2V_SysCode3, B2V_SysCode4]:
    """The four messages that carry a pack code of 1 to 27 characters; raises `TransferError`.

    GB/T 34014 codes have 24. ``manufacturer`` is 0 where it is none of those with a code.
    """
    if not 1 <= len(code) <= len(PACK_CODE.items):
        problem = f"a pack code has 1 to {len(PACK_CODE.items)} characters, not {len(code)}"
        raise TransferError(PACK_CODE.name, problem)
    codes = B2V_SysCode1.FIELDS[MANUFACTURER]
    if not codes.minimum <= manufacturer <= codes.maximum:
        raise TransferError(PACK_CODE.name, f"there is no manufacturer code {manufacturer}")
    first, second, third, fourth = text_frames(PACK_CODE, code)
    return (
        create(B2V_SysCode1, {**first, MANUFACTURER: manufacturer, "sys_code_length": len(code)}),
        create(B2V_SysCode2, second),
        create(B2V_SysCode3, third),
        create(B2V_SysCode4, fourth),
    )
