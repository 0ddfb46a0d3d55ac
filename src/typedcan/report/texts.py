"""What the formats share: findings by message, sums in words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from typedcan.report.item import LEVELS, LINT_LEVELS, Item, Report
from typedcan.shell.printing import printable, printable_json

WHOLE = "the protocol as a whole"
"""Heading of the findings that belong to no message."""

MEANINGS = {
    "error": "the specification contradicts itself or cannot be carried by its files",
    "warning": "something contradicts itself, or falls short of what is demanded of such files",
    "note": "nothing is wrong, but good to know",
    "wire": "the bits on the bus change their meaning: devices old and new misread each other",
    "source": "generated code changes its names or types: programs that use it must be adapted",
    "additive": "something new on the bus that devices of the old version do not know",
    "cosmetic": "texts for people only",
}
"""What a finding of each level means for those who use the protocol."""


def shortened(text: str, longest: int) -> str:
    """The text, cut to ``longest`` characters of which the last three are dots."""
    return text if len(text) <= longest else f"{text[: longest - 3]}..."


def dump(value: object) -> str:
    """JSON of a value, readable, with a newline at the end."""
    return printable_json(value, indent=2) + "\n"


def plural(count: int, one: str) -> str:
    """The count with its noun."""
    return f"{count} {one}" if count == 1 else f"{count} {one}s"


def grouped(items: Sequence[Item]) -> dict[str, list[Item]]:
    """The findings by message, messages in order of appearance."""
    groups: dict[str, list[Item]] = {}
    for item in items:
        groups.setdefault(item.group, []).append(item)
    return groups


def gravest(items: Sequence[Item]) -> str:
    """The gravest level among the findings."""
    return min((item.level for item in items), key=LEVELS.index)


def details(item: Item) -> str:
    """What became of what, where the text of the finding does not tell it; else ""."""
    if item.old and item.new:
        return "" if "→" in item.text else f"{item.old} → {item.new}"
    if item.old:
        return "" if item.old in item.text else f"was {item.old}"
    return "" if item.new in item.text else f"now {item.new}"


def sides(item: Item) -> tuple[str, ...]:
    """Who is broken: sender, receiver, both or nobody."""
    if item.breaks == "both":
        return ("sender", "receiver")
    return (item.breaks,) if item.breaks not in ("", "nobody") else ()


def broken(item: Item) -> str:
    """Whom a finding breaks, in words; "" where it breaks nobody."""
    return " and ".join(sides(item))


def counted(report: Report) -> str:
    """How many findings of which levels there are."""
    if not report.items:
        return "no findings"
    levels = ", ".join(f"{count} {level}" for level, count in report.counts().items())
    return f"{plural(len(report.items), 'finding')}: {levels}"


def casualties(report: Report) -> str:
    """Whom the findings break, in words; "" where they break nobody."""
    every = Counter(side for item in report.items for side in sides(item))
    return ", ".join(
        f"{count} {'breaks' if count == 1 else 'break'} the {side}" for side, count in every.items()
    )


def told(item: Item, *, longest: int | None = None) -> str:
    """What happened, on one line; text and details are each cut to ``longest`` characters."""
    parts = [printable(part) for part in (item.text, details(item)) if part] or [""]
    if longest is not None:
        parts = [shortened(part, longest) for part in parts]
    return parts[0] if len(parts) == 1 else "{} ({})".format(*parts)


def sentence(item: Item, *, longest: int | None = None) -> str:
    """What happened to what and whom it breaks, on one line; see `told` for ``longest``.

    A change ends with its fingerprint, from which an approval is written.
    """
    whom = broken(item)
    compared = f" [{item.fingerprint}]" if item.level not in LINT_LEVELS else ""
    breaks = f"; breaks {whom}" if whom else ""
    return f"{named(item)}{told(item, longest=longest)}{breaks}{compared}"


def named(item: Item) -> str:
    """The subject with a colon, "" where the text names it: errors are whole sentences."""
    return f"{printable(item.subject)}: " if item.subject and item.level not in LINT_LEVELS else ""


def purposes(report: Report) -> dict[str, str]:
    """What each rule is for, as a sentence of its own."""
    plain = {rule.id: rule.purpose.removesuffix(".") for rule in report.rules}
    return {name: f"{text[:1].upper()}{text[1:]}." if text else "" for name, text in plain.items()}
