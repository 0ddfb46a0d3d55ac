"""What the simulated nodes send, recorded: the frames of both wires in their order."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from pathlib import Path

import can
import numpy as np

from swapcan._generated.protocol import PROTOCOL
from swapcan.simulate import (
    DEFAULT_PLAN,
    Battery,
    Layout,
    Simulation,
    plan_of,
    planned_fault,
)
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.simulate.simulated_bus import SimulatedBus

DEFAULT = ", ".join(map(str, DEFAULT_PLAN))


@cache
def recorded(
    plan: str = DEFAULT,
    *faults: str,
    seconds: float = 140.0,
    nodes: tuple[str, ...] = PROTOCOL.nodes,
    seed: int = 0,
    cscs: int = 2,
    edition: str = "",
    readings: tuple[str, ...] = (),
) -> tuple[can.Message, ...]:
    """The frames of a run on the simulated clock; channels are ``vehicle`` and ``charger``.

    Parameters
    ----------
    plan, faults
        As `swapcan simulate` takes them, such as ``hv_on@1s, drive@3s`` and ``lost_frame@20s``.
    cscs
        Of the pack, with 12 cells each.
    edition, readings
        In which they speak.
    """
    frames: list[can.Message] = []
    with Simulation.simulated(
        nodes,
        plan=plan_of(plan),
        faults=[planned_fault(fault) for fault in faults],
        seed=seed,
        battery=Battery(Layout(cscs=cscs), seed=seed),
        edition=edition,
        readings=readings,
    ) as simulation:
        buses = [SimulatedBus(wire) for wire in simulation.wires]

        def listen() -> None:
            for bus in buses:
                while frame := bus.recv(0):
                    frames.append(frame)

        simulation.world.after_each_step(listen)
        simulation.world.run(seconds)
        listen()
        for bus in buses:
            bus.shutdown()
    return tuple(sorted(frames, key=lambda frame: frame.timestamp))


def written(frames: Iterable[can.Message], path: Path) -> Path:
    """Write frames as a candump log, each channel by its name."""
    lines = [
        f"({frame.timestamp:.6f}) {frame.channel} "
        f"{frame.arbitration_id:0{8 if frame.is_extended_id else 3}X}#{frame.data.hex().upper()}\n"
        for frame in frames
    ]
    path.write_text("".join(lines), "ascii", newline="\n")
    return path


def block_of(frames: Iterable[can.Message]) -> FrameBlock:
    """Frames as columns."""
    frames = tuple(frames)
    channels = tuple(dict.fromkeys(str(frame.channel) for frame in frames))
    data = np.zeros((len(frames), 8), np.uint8)
    for row, frame in zip(data, frames, strict=True):
        row[: len(frame.data)] = np.frombuffer(frame.data, np.uint8)
    return FrameBlock(
        np.array([frame.timestamp for frame in frames], np.float64),
        np.array([frame.arbitration_id for frame in frames], np.uint32),
        np.array([_flags(frame) for frame in frames], np.uint8),
        np.array([channels.index(str(frame.channel)) for frame in frames], np.int16),
        np.array([len(frame.data) for frame in frames], np.uint8),
        data,
        channels,
    )


def _flags(frame: can.Message) -> FrameFlag:
    flags = FrameFlag(0)
    for flag, is_set in (
        (FrameFlag.EXTENDED, frame.is_extended_id),
        (FrameFlag.REMOTE, frame.is_remote_frame),
        (FrameFlag.ERROR, frame.is_error_frame),
        (FrameFlag.FD, frame.is_fd),
    ):
        if is_set:
            flags |= flag
    return flags
