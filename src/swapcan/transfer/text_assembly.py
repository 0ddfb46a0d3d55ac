"""VIN and pack code put together from their frames."""

from __future__ import annotations

from collections.abc import Mapping

from swapcan.transfer.text import MANUFACTURER, PACK_CODE, VIN, PackCode, Vin
from swapcan.transfer.vin import vin_problem
from typedcan.transfer.problem import Problem
from typedcan.transfer.text_assembly import Content, TextAssembler
from typedcan.wire.message import Message
from typedcan.wire.protocol import Transfer


class VinAssembler(TextAssembler[Vin]):
    """Puts the VIN together; with ``check`` only one after ISO 3779, check digit included."""

    def __init__(
        self,
        *,
        timeout: float = 1.0,
        rounds: int = 1,
        check: bool = False,
        transfer: Transfer = VIN,
    ) -> None:
        super().__init__(transfer, timeout=timeout, rounds=rounds)
        self._check = check

    def result(self, contents: Mapping[int, Content], at: float) -> Vin | Problem:
        """The VIN in a complete set of frames."""
        parts = tuple(part for number in self.slots for part in contents[number])
        if problem := self.character_problem(parts, at):
            return problem
        text = "".join(parts)
        if self._check and (reason := vin_problem(text)):
            return self.problem("check", f"{text}: {reason}", at)
        return Vin(text)


class PackCodeAssembler(TextAssembler[PackCode]):
    """Puts the pack code together; it is sent again every second while it is requested."""

    def __init__(
        self, *, timeout: float = 2.0, rounds: int = 2, transfer: Transfer = PACK_CODE
    ) -> None:
        super().__init__(transfer, timeout=timeout, rounds=rounds)

    def content(self, message: Message, number: int) -> Content:
        """What a frame says, in the first one who made the battery, and the length."""
        content = super().content(message, number)
        length = self.length(message)
        if length is None:
            return content
        manufacturer: int = getattr(message, MANUFACTURER)
        return (manufacturer, length, *content)

    def result(self, contents: Mapping[int, Content], at: float) -> PackCode | Problem:
        """The pack code in a complete set of frames."""
        manufacturer, length, *parts = (part for number in self.slots for part in contents[number])
        if problem := self.character_problem(tuple(parts[:length]), at):
            return problem
        return PackCode("".join(parts[:length]), manufacturer)
