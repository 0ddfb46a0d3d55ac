"""Whether two texts say the same, where one side may speak Chinese, English or both.

A spec has every text in two languages, a DBC in one. So a DBC is not held to differ from its spec
where it repeats one of the two texts, nor a Chinese DBC from an English one in texts that are
translations as far as anybody can tell.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Iterator

from dbcspec.compare.senses import contradict
from typedcan.model.protocol import Code, Protocol

Text = tuple[str, str]
"""A text as printed and in English; both the same where a source has one only."""

_SEPARATORS = str.maketrans(dict.fromkeys(" \t_,;()", ""))


class Languages:
    """In which languages two protocols speak, and what that means for single texts."""

    def __init__(self, old: Protocol, new: Protocol) -> None:
        bilingual = _is_bilingual(old), _is_bilingual(new)
        self.both_bilingual = all(bilingual)
        """Whether both sides have every text twice."""
        self.alike = bilingual[0] == bilingual[1]
        """Whether both sides have as many languages."""
        self.translated = not any(bilingual) and _is_ascii(old) != _is_ascii(new)
        """Whether each side has one language, and not the same."""

    def same(
        self, old: Text, new: Text, other_old: Iterable[str] = (), other_new: Iterable[str] = ()
    ) -> bool:
        """Whether two texts are the same, letter by letter, in every language both have.

        ``other_old`` and ``other_new`` are further ways to put them, where one side has one only.
        """
        if old == new:
            return True
        if self.both_bilingual:
            return False
        before, after = {*old, *other_old} - {""}, {*new, *other_new} - {""}
        if not before or not after:
            return before == after
        return not before.isdisjoint(after) or self.is_translation(old, new)

    def same_meaning(self, old: Code, new: Code) -> bool:
        """Whether two labels mean the same: they share a text, but for case and separators."""
        before = {plain(old.label), plain(old.english)} - {""}
        after = {plain(new.label), plain(new.english)} - {""}
        if before == after or not before.isdisjoint(after):
            return True
        if not self.is_translation((old.label, old.english), (new.label, new.english)):
            return False
        return not contradict(old.english or old.label, new.english or new.label)

    def is_translation(self, old: Text, new: Text) -> bool:
        """Whether both sides are in different languages, and these two texts with them."""
        return self.translated and "".join(old).isascii() != "".join(new).isascii()


def plain(label: str) -> str:
    """A label without what may change and leave its meaning: case, spaces, commas, brackets.

    Signs and full stops stay: ``-5`` is not ``5``, and ``1.5`` not ``15``.
    """
    if not label.isascii():
        label = unicodedata.normalize("NFKC", label)
    return label.casefold().translate(_SEPARATORS)


def _texts(protocol: Protocol) -> Iterator[Text]:
    for message in protocol.messages:
        yield message.title, message.english
        for signal in message.signals:
            yield signal.title, signal.english
    for table in {id(sig.value_table): sig.value_table for _, sig in protocol.signals()}.values():
        for code in table.codes if table else ():
            yield code.label, code.english


def _is_bilingual(protocol: Protocol) -> bool:
    return any(title and english and title != english for title, english in _texts(protocol))


def _is_ascii(protocol: Protocol) -> bool:
    """Whether most of its texts are; one foreign label makes no other language."""
    plain_texts = [(title or english).isascii() for title, english in _texts(protocol)]
    return 2 * sum(plain_texts) >= len(plain_texts)
