"""Logs for plots, the command that draws them, and what stands in the pages."""

from __future__ import annotations

import argparse
import base64
import json
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import can
import numpy as np
from numpy.typing import NDArray

import swapcan
from swapcan.commands.tool import TOOL
from typedcan.commands.plot import command
from typedcan.wire.message import Message

START = 1_700_000_000.0


def write(path: Path, sent: Iterable[tuple[float, Message]]) -> Path:
    """A log of messages and their times in seconds from `START`, in that order."""
    with can.Logger(path) as logger:
        for time, message in sent:
            logger.on_message_received(
                can.Message(
                    timestamp=START + time,
                    arbitration_id=message.FRAME_ID,
                    data=swapcan.encode(message),
                    channel=0,
                )
            )
    return path


def plot(*arguments: object) -> int:
    """Run the command; gives the exit status, raises what the command line would print."""
    parser = argparse.ArgumentParser()
    plotting = command(TOOL)
    plotting.add_arguments(parser)
    return plotting.run(parser.parse_args([str(each) for each in arguments]))


def data_of(page: Path) -> dict[str, Any]:
    """The data in a page, as its script would parse them."""
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page.read_text())
    assert found is not None
    data = json.loads(found[1])
    assert isinstance(data, dict)
    return data


def array(text: str, kind: str) -> NDArray[Any]:
    return np.frombuffer(base64.b64decode(text), kind)


def times(data: dict[str, Any], text: str) -> list[float]:
    """Times as the page shows them, to the millisecond."""
    share = array(text, "<u4") / (2**32 - 1)
    return [round(data["start"] + one * (data["end"] - data["start"]), 3) for one in share.tolist()]


def curve(data: dict[str, Any], name: str) -> tuple[list[float], list[float], list[int]]:
    """Times, values and whether a line begins, of one curve; values to 4 digits."""
    for strip in data["strips"]:
        for each in strip.get("curves", []):
            if each["name"] == name:
                values = array(each["value"], "<f8" if each["wide"] else "<f4")
                return (
                    times(data, each["time"]),
                    [round(value, 4) for value in values.tolist()],
                    array(each["begins"], "u1").tolist(),
                )
    raise LookupError(name)


def spans(data: dict[str, Any], text: str) -> list[tuple[float, float]]:
    flat = times(data, text)
    return list(zip(flat[::2], flat[1::2], strict=True))


def marks(data: dict[str, Any], name: str) -> dict[str, list[tuple[float, float]]]:
    """Where a curve or a band has no value, by reason."""
    for strip in data["strips"]:
        for each in [*strip.get("curves", []), *strip.get("bands", [])]:
            if each["name"] == name:
                return {mark: spans(data, text) for mark, text in each["marks"].items()}
    raise LookupError(name)
