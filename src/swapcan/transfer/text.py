"""VIN and pack code: what they are when complete, how they are split and put together."""

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
from typedcan.transfer import Assembler, Problem, Text, TransferError, split
from typedcan.wire.protocol import Transfer

VIN = PROTOCOL.transfer("vin")
PACK_CODE = PROTOCOL.transfer("pack_code")

_MANUFACTURER = "manufacturer"
"""The detail of the pack code that says who made the battery."""


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
    return tuple(each for each in split(VIN, vin) if isinstance(each, V2B_VIN))


def split_pack_code(
    code: str, manufacturer: Manufacturer | int = 0
) -> tuple[B2V_SysCode1, B2V_SysCode2, B2V_SysCode3, B2V_SysCode4]:
    """The four messages that carry a pack code of 1 to 27 characters; raises `TransferError`.

    GB/T 34014 codes have 24. ``manufacturer`` is 0 where it is none of those with a code.
    """
    if not 1 <= len(code) <= len(PACK_CODE.items):
        problem = f"a pack code has 1 to {len(PACK_CODE.items)} characters, not {len(code)}"
        raise TransferError(PACK_CODE.name, problem)
    codes = B2V_SysCode1.FIELDS[_MANUFACTURER]
    if not codes.minimum <= manufacturer <= codes.maximum:
        raise TransferError(PACK_CODE.name, f"there is no manufacturer code {manufacturer}")
    messages = split(PACK_CODE, Text(PACK_CODE.name, code, {_MANUFACTURER: manufacturer}))
    match messages:
        case (
            B2V_SysCode1() as first,
            B2V_SysCode2() as second,
            B2V_SysCode3() as third,
            B2V_SysCode4() as fourth,
        ):
            return first, second, third, fourth
    raise TransferError(PACK_CODE.name, "takes other messages than those of table 8")


class VinAssembler(Assembler[Vin]):
    """Puts the VIN together; with ``check`` only one after ISO 3779, check digit included."""

    def __init__(
        self,
        *,
        timeout: float | None = None,
        rounds: int | None = None,
        check: bool = False,
        transfer: Transfer = VIN,
    ) -> None:
        make = checked_vin if check else any_vin
        super().__init__(transfer, make, timeout=timeout, rounds=rounds)


class PackCodeAssembler(Assembler[PackCode]):
    """Puts the pack code together; it is sent again every second while it is requested."""

    def __init__(
        self,
        *,
        timeout: float | None = None,
        rounds: int | None = None,
        transfer: Transfer = PACK_CODE,
    ) -> None:
        super().__init__(transfer, pack_code, timeout=timeout, rounds=rounds)


def any_vin(text: Text) -> Vin:
    """The text as what it is here."""
    return Vin(text.text)


def checked_vin(text: Text) -> Vin | Problem:
    """The text as what it is here, if it is a VIN after ISO 3779."""
    if reason := vin_problem(text.text):
        return Problem(VIN.name, "check", f"{text}: {reason}", text.at)
    return Vin(text.text)


def pack_code(text: Text) -> PackCode:
    """The text as what it is here."""
    return PackCode(text.text, text.details[_MANUFACTURER])
