"""What a command line hands to its commands: its name, its protocol, and its own words."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from typedcan.dynamic import typed_protocol
from typedcan.model import protocol as model
from typedcan.model.transfers.readings import ReadingsByGroup
from typedcan.model.variants import choose
from typedcan.monitor.glance import Glance
from typedcan.shell.algorithms import add_algorithm_option, algorithms_of
from typedcan.shell.command_line import Command, completing_files
from typedcan.shell.console import CommandError
from typedcan.wire.codec import Codec
from typedcan.wire.protocol import Protocol


@dataclass(frozen=True, slots=True, kw_only=True)
class Tool:
    """What is particular to a command line.

    Parameters
    ----------
    program
        Its name.
    own
        Gives the protocol that it is for, or the options name; None where they name a database
        alone. Is called once options are there: ``--help`` needs no protocol.
    help, examples
        What each command does, in a line, and examples of it.
    tables
        By name of a transfer, what the table of its readings and one reading are called.
    glance
        Gives what the monitor shows of a protocol beside messages and signals; None for what came
        over several frames.
    """

    program: str
    own: Callable[[argparse.Namespace], Protocol | None]
    help: Mapping[str, str]
    examples: Mapping[str, str]
    tables: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    glance: Callable[[Protocol], Glance | None] = field(default=lambda _: None)

    def command(
        self,
        name: str,
        add_arguments: Callable[[argparse.ArgumentParser], None],
        run: Callable[[argparse.Namespace], int],
    ) -> Command:
        """A command with the words that stand here."""
        return Command(name, self.help[name], self.examples.get(name, ""), add_arguments, run)

    def protocol(self, options: argparse.Namespace) -> Protocol:
        """The protocol that the options choose, with its message classes.

        That of the database where one is given: one made from the own protocol says the same in
        other words, such as Chinese labels, and all else that is known of it counts too.
        """
        own = self.own_protocol(options)
        path = dbc_of(options)
        if path is None:
            if own is None:
                raise CommandError("say which protocol: --protocol PACKAGE or --dbc FILE")
            return own
        from typedcan.databases.dbc import read_database

        found = read_database(path)
        if own and found.made_from == own.digest:
            return typed_protocol(_in_words_of(found, own.model))
        return typed_protocol(found)

    def own_protocol(self, options: argparse.Namespace) -> Protocol | None:
        """The own protocol in the readings and the edition that the options choose.

        Raises `CommandError` where a database is to say all, and `ReadError` as `choose`.
        """
        names, own = chosen(options), self.own(options)
        if not names:
            return own
        if dbc_of(options) or own is None:
            option = "--edition" if options.edition else "--reading"
            raise CommandError(f"{option} chooses in a package: a database is in one reading")
        return typed_protocol(chosen_model(own.model, options))

    def codec(self, options: argparse.Namespace) -> Codec:
        """What encodes and decodes the messages of that protocol."""
        return Codec(self.protocol(options), algorithms_of(options))


def reading_tables(protocol: Protocol) -> dict[str, tuple[str, str]]:
    """By name of a transfer, what the table of its readings and one reading are called."""
    return {
        each.name: (each.parts.table, each.parts.column)
        for each in protocol.transfers
        if each.parts.transfer.kind == ReadingsByGroup.name
    }


def dbc_of(options: argparse.Namespace) -> Path | None:
    """The database that the options name."""
    path: Path | None = getattr(options, "dbc", None)
    return path


def add_choice_options(parser: argparse._ActionsContainer) -> None:
    """Add --reading and --edition."""
    parser.add_argument(
        "--reading",
        action="append",
        default=[],
        metavar="ID",
        help="read a place of the standard in another way that its errata list, as in E50b; may be"
        " given several times",
    )
    parser.add_argument(
        "--edition",
        metavar="NAME",
        help="the protocol as an edition has it that its spec describes, such as a maker's",
    )


def chosen(options: argparse.Namespace) -> tuple[str, ...]:
    """The edition and the readings that the options name, as `choose` takes them."""
    return (*([options.edition] if options.edition else []), *options.reading)


def chosen_model(own: model.Protocol, options: argparse.Namespace) -> model.Protocol:
    """The protocol in what the options choose; raises `CommandError`, and `ReadError`."""
    protocol = choose(own, chosen(options))
    editions = {each.name for each in own.variants if each.is_edition}
    for name in options.reading:
        if name in editions:
            raise CommandError(f"{name} is an edition, not a reading: --edition {name} chooses it")
    if options.edition and options.edition not in editions:
        name = options.edition
        raise CommandError(f"{name} is a reading, not an edition: --reading {name} chooses it")
    return protocol


def add_protocol_options(parser: argparse._ActionsContainer) -> None:
    """Add --dbc, --reading, --edition and --algorithm."""
    completing_files(
        parser.add_argument(
            "--dbc",
            type=Path,
            # One that stands before the command is not to be forgotten.
            default=argparse.SUPPRESS,
            metavar="FILE",
            help="go by this database: .dbc, .kcd, .sym or .arxml",
        )
    )
    add_choice_options(parser)
    add_algorithm_option(parser)


def _in_words_of(found: model.Protocol, own: model.Protocol) -> model.Protocol:
    """The own protocol, with labels and units as a database of it has them."""
    words = {(message.name, signal.name): signal for message, signal in found.signals()}

    def reworded(message: model.Message, signal: model.Signal) -> model.Signal:
        other = words.get((message.name, signal.name))
        if other is None:
            return signal
        return replace(signal, unit=other.unit, value_table=other.value_table)

    messages = tuple(
        replace(message, signals=tuple(reworded(message, each) for each in message.signals))
        for message in own.messages
    )
    return replace(own, messages=messages, value_tables=found.value_tables)
