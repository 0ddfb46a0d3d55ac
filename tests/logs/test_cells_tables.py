"""Cells and probes as Arrow tables, alone and through a conversion."""

from __future__ import annotations

from pathlib import Path

import can
import pyarrow as pa
from logs.cell_logs import INVALID, Reading, Sent, cycle, decoded, totals

import swapcan
from swapcan.log_protocol import OWN
from typedcan.logs.pipeline import Options
from typedcan.logs.transfers.tables import TransferTables

TOLD = Sent(0.0, totals(2, 4))
WHOLE: dict[int, list[Reading]] = {1: [3.1, 3.2], 2: [3.3, 3.4]}
LACKING: dict[int, list[Reading]] = {1: [3.1, INVALID], 2: [3.3, 3.4]}
LOG = [TOLD, *cycle(0.0, WHOLE), *cycle(0.1, LACKING)]


def test_what_is_invalid_is_null_and_its_state_says_so() -> None:
    shape = TransferTables(OWN)
    batches = [*shape.take(decoded(LOG)), *shape.finish()]
    table = pa.Table.from_batches([batch for name, batch in batches if name == "cells_2x2"])
    columns = table.to_pydict()
    assert columns["timestamp"] == [0.002, 0.102]
    assert columns["channel"] == ["can0", "can0"]
    assert [round(value, 3) for value in columns["cell_1_1"]] == [3.1, 3.1]
    assert columns["cell_1_2"][1] is None
    assert columns["cell_1_2.state"] == ["value", "invalid"]
    assert columns["cell_2_2.state"] == ["value", "value"]


def test_columns_carry_unit_and_place() -> None:
    shape = TransferTables(OWN)
    list(shape.take(decoded(LOG)))
    schema = shape.schemas["cells_2x2"]
    assert schema.field("cell_2_1").metadata == {
        b"unit": b"V",
        b"csc": b"2",
        b"number": b"1",
        b"message": b"B2V_Ucell",
    }
    assert b"spec_digest" in (schema.metadata or {})


def test_a_conversion_has_them_beside_the_messages(tmp_path: Path) -> None:
    from swapcan.logs import tables

    path = tmp_path / "drive.blf"
    with can.Logger(path) as logger:
        for sent in LOG:
            logger.on_message_received(
                can.Message(
                    timestamp=1_700_000_000.0 + sent.time,
                    arbitration_id=sent.message.FRAME_ID,
                    data=swapcan.encode(sent.message),
                )
            )
    found = tables(path, options=Options(derived=(TransferTables,)))
    assert found["B2V_Ucell"].num_rows == 4
    cells = found["cells_2x2"].to_pydict()
    assert [round(value, 3) for value in cells["cell_2_2"]] == [3.4, 3.4]
    assert cells["cell_1_2"][1] is None
