"""What every alternative and edition of a spec changes, for packages to choose at run time."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

from dbcspec.spec.compiled import compile_rows
from dbcspec.spec.errata_rows import AlternativeRow
from dbcspec.spec.readings import Choice
from dbcspec.spec.rows import Edition, Spec
from typedcan.model.protocol import Protocol, Variant
from typedcan.model.variants import changes_between


def with_variants(protocol: Protocol, printed: Spec) -> Protocol:
    """The protocol with all that can be chosen; raises `SpecError` where a choice makes none."""
    return dataclasses.replace(protocol, variants=tuple(_variants(protocol, printed)))


def choices(printed: Spec) -> Iterator[Choice]:
    """Each alternative and each edition by itself."""
    for erratum in printed.errata:
        for alternative in erratum.alternatives:
            yield Choice(readings=(alternative.id,))
    for edition in printed.editions:
        yield Choice(edition=edition.name)


def _variants(usual: Protocol, printed: Spec) -> Iterator[Variant]:
    for erratum in printed.errata:
        for alternative in erratum.alternatives:
            yield _reading(usual, printed, alternative)
    for edition in printed.editions:
        yield _edition(usual, printed, edition)


def _reading(usual: Protocol, printed: Spec, row: AlternativeRow) -> Variant:
    other = compile_rows(printed, usual.name, Choice(readings=(row.id,))).protocol
    return Variant(
        name=row.id,
        english=row.reading,
        source=row.source,
        changes=changes_between(usual, other),
    )


def _edition(usual: Protocol, printed: Spec, edition: Edition) -> Variant:
    """The edition with those that it lies over; their readings are named, not among its changes."""
    below = [edition]
    by_name = {each.name: each for each in printed.editions}
    while below[-1].head.over:
        below.append(by_name[below[-1].head.over])
    readings = [name for each in reversed(below) for name in each.head.readings]
    editions = tuple(
        dataclasses.replace(each, head=dataclasses.replace(each.head, readings=()))
        for each in printed.editions
    )
    alone = dataclasses.replace(printed, editions=editions)
    other = compile_rows(alone, usual.name, Choice(edition=edition.name)).protocol
    head = edition.head
    return Variant(
        name=edition.name,
        is_edition=True,
        english=head.english,
        title=head.title,
        source=head.source,
        date=head.date,
        warnings=head.warnings,
        readings=tuple(readings),
        changes=changes_between(usual, other),
    )
