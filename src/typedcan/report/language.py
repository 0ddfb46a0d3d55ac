"""What reports say, in each language that they come in."""

from __future__ import annotations

from typing import Literal, NamedTuple

Language = Literal["en", "zh"]

LANGUAGES: tuple[Language, ...] = ("en", "zh")


class Text(NamedTuple):
    """The same in English and in Chinese; may hold ``{names}`` that `str.format` fills in."""

    en: str
    zh: str

    def within(self, language: Language) -> str:
        """The text of that language."""
        return self.zh if language == "zh" else self.en
