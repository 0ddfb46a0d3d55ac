"""What editions disagree about, and what tells that another one is spoken."""

from __future__ import annotations

from dataclasses import replace

import pytest
from spoken.editions import MODEL

from typedcan.model.editions import (
    acting_in_editions,
    edition_of,
    signs_of_others,
    unsure_codes,
)
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Protocol, Variant
from typedcan.model.variants import changes_between, choose


def test_the_chosen_edition_is_known_and_a_reading_is_none() -> None:
    assert (edition_of(MODEL), edition_of(choose(MODEL, ["maker"]))) == ("", "maker")
    reading = Variant(name="E01b", english="a reading", changes="[]")
    read = choose(replace(MODEL, variants=(*MODEL.variants, reading)), ["E01b"])
    assert (read.chosen, edition_of(read)) == ("E01b", "")


def test_a_message_that_only_another_edition_has_is_its_sign() -> None:
    cells, lamp = (0x18FF0003, True), (0x18FF0004, True)
    assert signs_of_others(MODEL) == {cells: "maker", lamp: "third"}
    assert signs_of_others(choose(MODEL, ["maker"])) == {lamp: "third"}
    assert signs_of_others(choose(MODEL, ["third"])) == {cells: "maker"}


def test_codes_that_act_otherwise_in_an_edition_are_left_invalid() -> None:
    assert acting_in_editions(MODEL) == {("Command", "Heat"): {2: "maker"}}
    assert unsure_codes(MODEL) == {"Command": {"Heat": 3}}


def with_heat(**facts: object) -> Protocol:
    """The usual protocol, with an edition in which only the heating is another."""
    usual = replace(MODEL, variants=())
    command, *others = usual.messages
    signals = tuple(
        replace(signal, **facts) if signal.name == "Heat" else signal  # type: ignore[arg-type]
        for signal in command.signals
    )
    edition = replace(usual, messages=(replace(command, signals=signals), *others))
    changes = changes_between(usual, edition)
    return replace(
        usual, variants=(Variant(name="x", is_edition=True, english="x", changes=changes),)
    )


def test_a_signal_that_acts_nowhere_in_an_edition_is_left_invalid_too() -> None:
    protocol = with_heat(acting=None)
    assert acting_in_editions(protocol) == {("Command", "Heat"): {}}
    assert unsure_codes(protocol) == {"Command": {"Heat": 3}}


def test_another_safe_code_alone_is_a_disagreement() -> None:
    acting = MODEL.message("Command").signal("Heat").acting
    assert acting is not None
    protocol = with_heat(acting=replace(acting, safe=0))
    assert acting_in_editions(protocol) == {("Command", "Heat"): {}}
    assert unsure_codes(protocol) == {"Command": {"Heat": 3}}


def test_an_invalid_code_that_acts_somewhere_is_not_safe_at_all() -> None:
    acting = MODEL.message("Command").signal("Heat").acting
    assert acting is not None
    assert unsure_codes(with_heat(acting=replace(acting, codes=(2, 3)))) == {}


def test_where_editions_agree_safe_codes_are_what_they_are() -> None:
    assert unsure_codes(with_heat(title="another title")) == {}


def test_a_protocol_is_chosen_once() -> None:
    with pytest.raises(ReadError, match="pump is third already: choose all at once"):
        choose(choose(MODEL, ["third"]), ["maker"])
