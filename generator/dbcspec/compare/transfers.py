"""Transfers before and after, once for all promises that speak of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from dbcspec.compare.pairing import Pairing
from typedcan.model.protocol import Transfer


def transfer_pairs(pairing: Pairing) -> Iterator[tuple[Transfer | None, Transfer | None]]:
    """Transfers that continue each other by name, else by their messages; then what is left."""
    waiting = {transfer.name: transfer for transfer in pairing.new.transfers}
    rest: list[Transfer] = []
    for old in pairing.old.transfers:
        if old.name in waiting:
            yield old, waiting.pop(old.name)
        else:
            rest.append(old)
    for old in rest:
        messages = tuple(pairing.names.get(name, name) for name in old.messages)
        same = next((new for new in waiting.values() if new.messages == messages), None)
        yield old, waiting.pop(same.name) if same else None
    for new in waiting.values():
        yield None, new


def layout(transfer: Transfer | None, names: Mapping[str, str]) -> dict[str, str]:
    """What lays a transfer out, by the words for it; ``names`` are those of renamed things."""
    if transfer is None:
        return {}

    def called(*old: str) -> str:
        return ", ".join(names.get(name, name) for name in old)

    return {
        "messages": called(*transfer.messages),
        "items": called(*transfer.items),
        "count": "" if transfer.count is None else str(transfer.count),
        "count signal": called(transfer.count_signal),
        "frame number": called(transfer.frame_number),
        "group": called(transfer.group),
        "groups signal": called(transfer.groups_signal),
        "length signal": called(transfer.length_signal),
        "numbering": "within group" if transfer.numbered_within_group else "through",
        "fill": "" if transfer.fill is None else str(transfer.fill),
    }


def follows(pairing: Pairing, old: Transfer | None, new: Transfer | None) -> bool:
    """Whether its messages themselves are all gone or all new, which other promises tell."""
    if old is None:
        return new is not None and pairing.fresh.issuperset(new.messages)
    return new is None and pairing.gone.issuperset(old.messages)
