"""The options that name a bus, with python-can's own names, and opening it."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

import can
from can.interfaces.virtual import VirtualBus

from typedcan.model.errors import one_line
from typedcan.shell.console import CommandError, note


def add_bus_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that python-can's own programs have.

    Not by `can.cli.add_bus_arguments`: its ``--timing`` prints a line among the results. What is
    not here, such as fd and timings, goes through ``--bus-kwargs``.
    """
    group = parser.add_argument_group(
        "bus", "What is left out comes from python-can's configuration files and variables."
    )
    group.add_argument(
        "-i",
        "--interface",
        choices=sorted(can.VALID_INTERFACES),
        metavar="INTERFACE",
        help="one of python-can's, such as socketcan, pcan, vector, udp_multicast",
    )
    group.add_argument("-c", "--channel", help="such as can0, PCAN_USBBUS1, 0")
    group.add_argument("-b", "--bitrate", type=int, help="in bit/s, such as 250000")
    group.add_argument(
        "--bus-kwargs",
        nargs="+",
        action="extend",
        type=assignment,
        default=[],
        metavar="NAME=VALUE",
        help="further arguments of the interface, such as app_name=MyApp",
    )


def add_consent(group: argparse._ActionsContainer, text: str) -> None:
    """Add the option without which nothing that acts is sent on a real interface."""
    group.add_argument("--yes-drive-the-bus", action="store_true", help=text)


def open_bus(options: argparse.Namespace, *, virtual: bool = False) -> can.BusABC:
    """The bus that the options name; raises `CommandError` where it cannot be opened.

    Parameters
    ----------
    virtual
        `is_virtual` has said that it is: where it is not, nothing is opened after all.
    """
    try:
        bus = can.Bus(**_given(options))
    except Exception as error:  # noqa: BLE001 - interfaces raise what they like
        hint = "" if options.interface else "; --interface names one"
        raise CommandError(f"cannot open the bus: {one_line(error)}{hint}") from None
    if virtual and not isinstance(bus, VirtualBus):
        bus.shutdown()
        raise CommandError("the bus is not virtual: name it with --interface")
    return bus


def is_virtual(options: argparse.Namespace) -> bool:
    """Whether the options name python-can's virtual interface, by which nothing can be moved.

    Others may be behind every other interface: udp_multicast crosses machines, and vcan can be
    forwarded to a real bus.
    """
    given = _given(options)
    context = given.pop("config_context", None)
    try:
        config = can.util.load_config(config=given, context=context)
    except Exception:  # noqa: BLE001 - opening the bus says what is wrong
        return False
    return config.get("interface") == "virtual"


def told_once() -> Callable[[Exception], None]:
    """What prints the trouble that a bus has had, each but once."""
    told: set[str] = set()

    def tell(error: Exception) -> None:
        text = one_line(error)
        if text not in told:
            told.add(text)
            note(f"the bus failed for a moment: {text}")

    return tell


def bus_name(bus: can.BusABC, options: argparse.Namespace) -> str:
    """What the bus is called, to people."""
    if bus.channel_info != "unknown":  # python-can's word for what an interface does not tell
        return bus.channel_info
    return " ".join(filter(None, (options.interface, options.channel))) or "the configured bus"


def _given(options: argparse.Namespace) -> dict[str, Any]:
    """The arguments of the bus that the options have."""
    named = {name: getattr(options, name) for name in ("interface", "channel", "bitrate")}
    given = {name: value for name, value in named.items() if value is not None}
    return {**dict(options.bus_kwargs), **given}


def assignment(text: str) -> tuple[str, str]:
    """A name and a value, as the type of an argument."""
    name, equals, value = text.partition("=")
    if not (equals and name.isidentifier()):
        raise argparse.ArgumentTypeError(f"expected NAME=VALUE, not {text!r}")
    return name, value
