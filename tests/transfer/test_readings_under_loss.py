"""Complete sets of readings under loss, held against a table of what was delivered when."""

from __future__ import annotations

from dataclasses import dataclass, field

from hypothesis import given, settings
from hypothesis import strategies as st
from transfer.wire import delivered, totals

from swapcan import SignalState
from swapcan.messages import B2V_Ucell
from swapcan.transfer import (
    CellAssembler,
    CellVoltages,
    ProbeAssembler,
    ProbeTemperatures,
    Reading,
    split_cell_voltages,
    split_probe_temperatures,
)

INVALID = SignalState.INVALID
WINDOW = 0.15
Pack = dict[int, list[Reading]]
Sizes = list[int]
"""How many cells each CSC has."""


@st.composite
def packs(draw: st.DrawFn, cscs: int = 18, cells: int = 60) -> Sizes:
    """Packs with as many cells in every CSC, and others."""
    if draw(st.booleans()):
        return [draw(st.integers(1, cells))] * draw(st.integers(1, cscs))
    return draw(st.lists(st.integers(1, cells), min_size=1, max_size=cscs))


def measured(sizes: Sizes, cycle: int) -> Pack:
    """Voltages that tell cell and cycle."""
    return {
        csc: [(csc * 2000 + n * 20 + cycle) / 1000 for n in range(1, size + 1)]
        for csc, size in enumerate(sizes, 1)
    }


@dataclass
class Oracle:
    """What was delivered last for each cell and when, and since the last result."""

    sizes: Sizes
    last: dict[tuple[int, int], tuple[Reading, float]] = field(default_factory=dict)
    since: set[tuple[int, int]] = field(default_factory=set)

    def take(self, frame: B2V_Ucell, at: float) -> None:
        assert isinstance(frame.csc_no, int)
        parts = (frame.csc_no_ucell_n, frame.csc_no_ucell_n1, frame.csc_no_ucell_n2)
        for n, part in enumerate(parts, 3 * frame.frame_no - 2):
            if n <= self.sizes[frame.csc_no - 1]:
                self.last[frame.csc_no, n] = (part, at)
                self.since.add((frame.csc_no, n))

    def complete(self, at: float) -> Pack | None:
        """The set that is complete now, if one is."""
        cells = [(csc, n) for csc, size in enumerate(self.sizes, 1) for n in range(1, size + 1)]
        if not self.since.issuperset(cells):
            return None
        if any(at - self.last[cell][1] > WINDOW for cell in cells):
            return None
        self.since.clear()
        return {
            csc: [self.last[csc, n][0] for n in range(1, size + 1)]
            for csc, size in enumerate(self.sizes, 1)
        }


def reported(assembler: CellAssembler, frame: B2V_Ucell, at: float) -> Pack | None:
    """The set that the assembler reports with a frame, if any."""
    outcomes = [each for each in assembler.take(frame, at) if isinstance(each, CellVoltages)]
    assert len(outcomes) <= 1
    for outcome in outcomes:
        assert outcome.at == at
        return {csc: list(cells.values()) for csc, cells in outcome.items()}
    return None


@st.composite
def rough_traffic(draw: st.DrawFn, sizes: Sizes, gaps: float) -> list[B2V_Ucell]:
    """Some cycles of a pack: frames lost, repeated, reordered; some sensors without a value."""
    stream: list[B2V_Ucell] = []
    for cycle in range(1, draw(st.integers(1, 4)) + 1):
        pack = measured(sizes, cycle)
        for csc in draw(st.sets(st.integers(1, len(sizes)), max_size=4)):
            pack[csc][draw(st.integers(0, sizes[csc - 1] - 1))] = INVALID
        stream += split_cell_voltages(pack)
    count = len(stream)
    for index in draw(st.sets(st.integers(0, count - 1), max_size=int(gaps * count))):
        stream[index] = stream[draw(st.integers(0, count - 1))]
    swaps = st.tuples(st.integers(0, count - 1), st.integers(0, count - 1))
    for one, other in draw(st.lists(swaps, max_size=6)):
        stream[one], stream[other] = stream[other], stream[one]
    lost = draw(st.sets(st.integers(0, count - 1), max_size=int(gaps * count)))
    return [frame for index, frame in enumerate(stream) if index not in lost]


@settings(max_examples=60)
@given(packs(), st.data(), st.floats(0.01, 0.3))
def test_exactly_the_complete_sets_are_reported_once_the_pack_is_known(
    sizes: Sizes, data: st.DataObject, cycle: float
) -> None:
    assembler, oracle = CellAssembler(window=WINDOW), Oracle(sizes)
    first = split_cell_voltages(measured(sizes, 0))
    assembler.take(totals(measured(sizes, 0), {}), 0.0)
    step = cycle / len(first)
    for n, frame in enumerate([*first, *data.draw(rough_traffic(sizes, gaps=0.1))]):
        at = 0.0 if n < len(first) else n * step
        oracle.take(frame, at)
        assert reported(assembler, frame, at) == oracle.complete(at)


@settings(max_examples=60)
@given(packs(cscs=5, cells=14), st.data())
def test_before_the_pack_is_known_only_complete_sets_are_reported(
    sizes: Sizes, data: st.DataObject
) -> None:
    assembler, oracle = CellAssembler(window=WINDOW), Oracle(sizes)
    assembler.take(totals(measured(sizes, 0), {}), 0.0)
    stream = data.draw(rough_traffic(sizes, gaps=0.4))
    for n, frame in enumerate(stream):
        at = n * 0.1 / len(stream)
        oracle.take(frame, at)
        result = reported(assembler, frame, at)
        if result is not None:
            assert result == {
                csc: [oracle.last[csc, cell][0] for cell in range(1, size + 1)]
                for csc, size in enumerate(sizes, 1)
            }
            assert len(oracle.since) == sum(sizes)
            oracle.since.clear()


@settings(max_examples=20)
@given(packs())
def test_without_loss_every_cycle_of_cells_is_complete(sizes: Sizes) -> None:
    assembler = CellAssembler()
    assembler.take(totals(measured(sizes, 0), {}), 0.0)
    for cycle in range(2):
        pack = measured(sizes, cycle)
        frames = delivered(split_cell_voltages(pack))
        complete = [
            each
            for n, frame in enumerate(frames)
            for each in assembler.take(frame, 0.1 * (cycle + n / len(frames)))
        ]
        [cells] = complete
        assert isinstance(cells, CellVoltages)
        raw = [round(1000 * v) for v in cells.flat() if not isinstance(v, SignalState)]
        assert raw == [csc * 2000 + n * 20 + cycle for csc in pack for n in cells[csc]]
        assert [len(part) for part in cells.values()] == sizes


@settings(max_examples=20)
@given(packs())
def test_without_loss_every_cycle_of_probes_is_complete(sizes: Sizes) -> None:
    assembler = ProbeAssembler()
    pack: Pack = {
        csc: [(csc * 7 + n * 3) % 255 - 50 for n in range(size)]
        for csc, size in enumerate(sizes, 1)
    }
    assembler.take(totals({csc: [3.0] for csc in pack}, pack), 0.0)
    for cycle in range(2):
        frames = delivered(split_probe_temperatures(pack))
        complete = [
            each
            for n, frame in enumerate(frames)
            for each in assembler.take(frame, 0.2 * (cycle + n / len(frames)))
        ]
        [probes] = complete
        assert isinstance(probes, ProbeTemperatures)
        assert {csc: list(part.values()) for csc, part in probes.items()} == pack
