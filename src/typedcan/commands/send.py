"""`send`: one message onto a bus."""

from __future__ import annotations

import argparse
from functools import partial

from typedcan.commands.bus_options import add_bus_options, add_consent, is_virtual, open_bus
from typedcan.commands.tool import Tool, add_protocol_options
from typedcan.commands.transcript import values_text
from typedcan.commands.values import message_named, message_of
from typedcan.drive.driving import Driving, look_out_time
from typedcan.drive.noting_bus import NotingBus
from typedcan.model.editions import acting_in_editions, edition_of
from typedcan.node.clock import SystemClock
from typedcan.shell.command_line import Command
from typedcan.shell.console import CommandError, note, say
from typedcan.wire.acting import what_acts
from typedcan.wire.link import Link
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_TIMEOUT = 1.0
"""Seconds for the bus to accept the frame."""


def command(tool: Tool) -> Command:
    """The command of a command line."""
    return tool.command("send", _add_arguments, partial(_run, tool))


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("message", metavar="MESSAGE", help="the name of a message")
    parser.add_argument(
        "fields",
        nargs="*",
        metavar="FIELD=VALUE",
        help="field or DBC signal; a number, label, character, 'invalid' or 'abnormal'",
    )
    add_consent(
        parser,
        "send it also where it makes its receiver act: contactors close, chargers start; not needed"
        " on the virtual interface",
    )
    add_protocol_options(parser)
    add_bus_options(parser)


def _run(tool: Tool, options: argparse.Namespace) -> int:
    codec = tool.codec(options)
    protocol = codec.protocol
    message = message_of(message_named(protocol.messages, options.message), options.fields)
    codec.encode(message)  # refuses a wrong value before a bus is opened
    acting = _what_may_act(protocol, message)
    virtual = bool(acting) and is_virtual(options)
    looks_out = bool(acting) and not virtual
    if looks_out and not options.yes_drive_the_bus:
        raise CommandError(f"{message.NAME} {acting}: not sent without --yes-drive-the-bus")
    with open_bus(options, virtual=virtual) as bus:
        if looks_out:
            seconds = look_out_time([type(message)])
            note(f"looking for another {message.SENDER} for {seconds:g} s")
            with NotingBus(bus, codec, lambda _: None, played=[type(message)]) as noting:
                Driving([noting], clock=SystemClock()).look_out()
        frame = Link(bus, codec).send(message, timeout=_TIMEOUT)
    sent = codec.decode_frame(frame)
    data = frame.data.hex(" ").upper()
    number = f"0x{frame.arbitration_id:0{8 if frame.is_extended_id else 3}X}"
    say("  ".join((number, f"[{data}]", sent.NAME, *values_text(sent))))
    return 0


def _acts_in_an_edition(protocol: Protocol, message: Message) -> str:
    """Which code acts in an edition, where none was chosen, in words."""
    if edition_of(protocol.model):
        return ""
    codes = acting_in_editions(protocol.model)
    for field in message.FIELDS.values():
        value, known = getattr(message, field.name), codes.get((message.NAME, field.dbc_name))
        if not known or value is None:
            continue
        if edition := known.get(field.to_raw(message.NAME, value)):
            text = f"{field.name} = {field.text(value)}"
            return f"{text} makes its receiver act where edition {edition} is spoken"
    return ""


def _what_may_act(protocol: Protocol, message: Message) -> str:
    """Why the message may move something, in words; empty where it is known that it does not."""
    if acting := what_acts(message):
        return f"{', '.join(acting)} makes its receiver act"
    if edition := _acts_in_an_edition(protocol, message):
        return edition
    if any(signal.acting for _, signal in protocol.model.signals()):
        return ""
    return "may make its receiver act: nothing is known of codes that do"
