"""Reports to render: a plain comparison, and one with everything that could break a format."""

from __future__ import annotations

from typedcan.model.errors import Location
from typedcan.report.item import Item, Report, RuleInfo

HOSTILE = (
    "plain",
    "\"double\" 'single' `back`",
    "a|b||c\\|d\\",
    "line\nbreak\r\nand\ttab",
    "<script>alert(1)</script> <!-- --> ]]> </style> &amp; &#124;",
    "%0A::error::x %25 50% ::warning file=a,line=1::y",
    "[link](https://x.invalid) ![image](y) *bold* _under_ ~~struck~~ @everyone #1 $x$",
    "电池管理系统 → SOC，范围 0–100 %",
    "\x00\x07\x1b[31mred\x7f\x9b\u202eright to left\u2028\ufffe\ud800",
    "{0} {placeholder} {{ 1 + 1 }} {% raw %}",
    "| --- | --- |",
    "x" * 5000,
    "",
    " ",
)

RULES = (
    RuleInfo("signal-scale-same", "A raw step keeps its physical value.", "wire"),
    RuleInfo("signal-name-same", "a signal keeps its name", "source"),
    RuleInfo("message-kept", "a new message is no surprise", "additive"),
    RuleInfo("title-same", "titles stay", "cosmetic"),
    RuleInfo("node-declared", "nodes are declared", "error"),
)


def item(rule: str = "signal-scale-same", level: str = "wire", **others: object) -> Item:
    """A finding with something in every field, unless told otherwise."""
    fields: dict[str, object] = {
        "group": "Engine",
        "subject": "Speed",
        "text": "factor 0.4 → 0.5",
        "where": Location("spec/tables/01-state.yaml", 17, 9),
        "breaks": "both",
        "old": "0.4",
        "new": "0.5",
        **others,
    }
    return Item(rule=rule, level=level, **fields)  # type: ignore[arg-type]


PLAIN = Report(
    title="old.dbc → spec",
    items=[
        item(),
        item(subject="Torque", text="signal removed", old="8|16@1+", new="", breaks="receiver"),
        item("signal-name-same", "source", group="Brake", text="renamed", breaks="nobody"),
        item(
            "title-same",
            "cosmetic",
            group="",
            subject="BMU",
            text="title added",
            old="",
            new="B",
            breaks="",
        ),
    ],
    rules=RULES,
)

EMPTY = Report(title="old.dbc → spec", items=[], rules=RULES)

LINT = Report(
    title="spec",
    items=[
        item(
            "node-declared",
            "error",
            group="",
            text="the route of Speed names ABC, which is no declared node: correct it",
            old="",
            new="",
            breaks="",
        )
    ],
    rules=RULES,
)


def hostile(texts: tuple[str, ...] = HOSTILE) -> Report:
    """Each text in each field in turn."""
    fields = ("group", "subject", "text", "old", "new", "path")
    items = []
    for number, text in enumerate(texts):
        rule = RULES[number % len(RULES)]
        for field in fields:
            change = {"where": Location(text, 3, 4)} if field == "path" else {field: text}
            items.append(item(rule.id, rule.level, **change))
    items.append(item(rule="not-in-the-list"))
    return Report(title="".join(texts), items=items, rules=RULES)
