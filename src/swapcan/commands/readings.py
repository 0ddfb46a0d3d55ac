"""`swapcan readings`: how the standard is read where its text needs a reading, and its editions."""

from __future__ import annotations

import argparse
import textwrap
from collections.abc import Iterable, Iterator, Mapping

from swapcan._generated.protocol import PROTOCOL
from swapcan.commands import HELP
from typedcan.commands.log_options import need
from typedcan.judge.rule import Rule
from typedcan.model.protocol import Erratum, Protocol, Variant
from typedcan.report.as_markdown import escaped
from typedcan.shell.command_line import Command
from typedcan.shell.console import say_text
from typedcan.shell.printing import printable

_WIDE = 100

_ABOUT = """\
# Readings and editions

Made by `swapcan readings --markdown`: do not edit.

Where the text of the standard is damaged, contradicts itself or leaves something open, an erratum
says how it is read here. Some have other readings with ids of their own: `--reading E50b` chooses
one, `--edition NAME` an edition with the readings that belong to it. Rules of `swapcan conform`
that rest on an erratum stand beside it, in brackets the part of a rule that alone does. Where the
erratum fills a gap, makes a choice or has another reading, they are no demands of the standard."""


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--markdown", action="store_true", help="print every erratum, as docs/readings.md has them"
    )


def _run(options: argparse.Namespace) -> int:
    need("numpy")
    from swapcan.rules import RULES

    lines = markdown if options.markdown else text
    say_text("\n".join(lines(PROTOCOL.model, rules_by_erratum(RULES))))
    return 0


COMMAND = Command(
    name="readings",
    help=HELP["readings"],
    examples="""  swapcan readings
  swapcan readings --markdown > docs/readings.md
  swapcan decode drive.blf --reading E50b
  swapcan decode drive.blf --edition v4.6""",
    add_arguments=_add_arguments,
    run=_run,
)


def rules_by_erratum(rules: Iterable[Rule]) -> dict[str, list[str]]:
    """By the number of each erratum the rules that rest on it, in brackets the part that does."""
    found: dict[str, list[str]] = {}
    for rule in rules:
        parts: dict[str, list[str]] = {}
        for part in rule.left_open:
            for number in part.errata:
                parts.setdefault(number, []).append(part.name)
        for number in rule.errata:
            found.setdefault(number, []).append(rule.id)
            parts.pop(number, None)
        for number, names in parts.items():
            found.setdefault(number, []).append(f"{rule.id} ({', '.join(names)})")
    return found


def text(protocol: Protocol, rules: Mapping[str, list[str]]) -> Iterator[str]:
    """What can be chosen, for a terminal."""
    yield "readings (--reading ID); the first of each is the usual one"
    for erratum in protocol.errata:
        if erratum.alternatives:
            yield from _choices(erratum, rules.get(erratum.id, []))
    yield ""
    yield "editions (--edition NAME)"
    for edition in _editions(protocol):
        yield ""
        yield printable(f"  {edition.name}  {edition.english} ({edition.title})")
        yield from _wrapped(f"source: {edition.source}, {edition.date}", 4)
        if edition.readings:
            yield from _wrapped(f"readings: {', '.join(edition.readings)}", 4)
        for warning in edition.warnings:
            yield from _wrapped(f"warning: {warning}", 4)


def _choices(erratum: Erratum, rules: list[str]) -> Iterator[str]:
    yield ""
    yield from _wrapped(f"{erratum.place}: {erratum.printed}", 2)
    yield from _wrapped(f"{erratum.id}   {_with_source(erratum.reading, erratum.source)}", 4)
    for other in erratum.alternatives:
        yield from _wrapped(f"{other.id}  {_with_source(other.reading, other.source)}", 4)
    if rules:
        yield from _wrapped(f"rules: {', '.join(rules)}", 4)


def _with_source(reading: str, source: str) -> str:
    return f"{reading} ({source})" if source else reading


def _wrapped(line: str, indent: int) -> list[str]:
    """A text over as many lines as it takes, the further ones set in."""
    return textwrap.wrap(
        printable(line),
        _WIDE,
        initial_indent=" " * indent,
        subsequent_indent=" " * (indent + 6),
        break_long_words=False,
        break_on_hyphens=False,
    )


def markdown(protocol: Protocol, rules: Mapping[str, list[str]]) -> Iterator[str]:
    """Every erratum and edition, as docs/readings.md has them."""
    yield _ABOUT
    yield ""
    yield "## Readings"
    yield ""
    yield from _row("erratum", "print", "usual reading", "other readings", "source", "rules")
    yield "|---|---|---|---|---|---|"
    for erratum in protocol.errata:
        sources = {"": erratum.source, **{each.id: each.source for each in erratum.alternatives}}
        yield from _row(
            f"**{erratum.id}** {erratum.kind}",
            f"{escaped(erratum.place)}: {escaped(erratum.printed)}",
            escaped(erratum.reading),
            "<br>".join(
                f"**{each.id}** {escaped(each.reading)}. {escaped(each.because)}"
                for each in erratum.alternatives
            ),
            "<br>".join(
                f"**{name or erratum.id}** {escaped(source)}"
                for name, source in sources.items()
                if source
            ),
            "<br>".join(map(escaped, rules.get(erratum.id, []))),
        )
    yield ""
    yield "## Editions"
    for edition in _editions(protocol):
        yield ""
        yield f"### {edition.name}"
        yield ""
        yield f"{escaped(edition.title)}: {escaped(edition.english)}."
        yield f"Source: {escaped(edition.source)}; {escaped(edition.date)}."
        if edition.readings:
            yield f"It takes the readings {', '.join(edition.readings)}."
        yield ""
        yield from (f"- {escaped(warning)}" for warning in edition.warnings)


def _row(*cells: str) -> Iterator[str]:
    yield f"| {' | '.join(cells)} |"


def _editions(protocol: Protocol) -> list[Variant]:
    return [each for each in protocol.variants if each.is_edition]
