"""What is raised where a value has no place in its transfer."""

from __future__ import annotations

from typedcan.model.errors import TypedcanError


class TransferError(TypedcanError, ValueError):
    """A value cannot be split into frames: ``transfer`` names it, ``problem`` says why."""

    def __init__(self, transfer: str, problem: str) -> None:
        self.transfer = transfer
        self.problem = problem
        super().__init__(f"{transfer}: {problem}")
