"""Names for DBC files and for Python."""

from __future__ import annotations

import builtins
import keyword
import re
from collections.abc import Collection, Iterable, Sequence

LONGEST_NAME = 32
"""Characters that DBC tools accept in a name."""

_DBC_WORDS = frozenset({"M", "m", "INT", "HEX", "FLOAT", "ENUM", "STRING"})
_DBC_KEYWORD = re.compile(
    r"VERSION|NS_|BS_|BU_|BO_|SG_|CM_|VAL_|VAL_TABLE_|EV_|FILTER|NS_DESC_|"
    r"SIG_GROUP_|SIG_VALTYPE_|SIG_TYPE_REF_|BA_|BA_REL_|BA_SGTYPE_|BA_DEF_|BA_DEF_REL_|BA_DEF_DEF_|"
    r"BA_DEF_SGTYPE_|BA_DEF_DEF_REL_|CAT_|CAT_DEF_"
)

_DBC_KEYWORDS = frozenset(
    {
        *("VERSION", "NS_", "NS_DESC_", "BS_", "BU_", "BO_", "SG_", "CM_", "VAL_", "VAL_TABLE_"),
        *("EV_", "ENVVAR_DATA_", "EV_DATA_", "FILTER", "CAT_", "CAT_DEF_", "SG_MUL_VAL_"),
        *("BA_", "BA_DEF_", "BA_DEF_DEF_", "BA_DEF_SGTYPE_", "BA_SGTYPE_", "BA_REL_"),
        *("BA_DEF_REL_", "BA_DEF_DEF_REL_", "SIG_GROUP_", "SIG_VALTYPE_", "SIGTYPE_VALTYPE_"),
        *("SIG_TYPE_REF_", "SGTYPE_", "SGTYPE_VAL_", "BO_TX_BU_"),
        *("BU_SG_REL_", "BU_EV_REL_", "BU_BO_REL_"),
    }
)

_NO_FIELDS = frozenset(
    {
        *keyword.kwlist,
        *dir(builtins),
        *("MODEL", "NAME", "FRAME_ID", "EXTENDED", "LENGTH", "SENDER", "RECEIVERS", "PERIOD"),
        *("FIELDS", "CHECKSUM", "COUNTER", "SELECTED", "field_of", "to_raw", "_is_there"),
    }
)
"""Names that Python, the annotations of fields, or all typed messages need."""


def name_fault(name: str) -> str | None:
    """What keeps a name from being a DBC name, or None."""
    if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name):
        return "is not an identifier (letters, digits and underscores)"
    if not 2 <= len(name) <= LONGEST_NAME:
        return f"has {len(name)} characters; 2 to {LONGEST_NAME} are allowed"
    if is_dbc_word(name):
        return "is a word of the DBC language"
    return None


def is_dbc_keyword(name: str) -> bool:
    """Whether no reader of DBC files would take it for a name."""
    return name in _DBC_KEYWORDS


def is_dbc_word(name: str) -> bool:
    """Whether a name means something else in DBC files."""
    return name in _DBC_WORDS or bool(_DBC_KEYWORD.fullmatch(name))


def snake_case(name: str) -> str:
    """``MaxLmt_DisChgCurr`` to ``max_lmt_dis_chg_curr``; never a Python keyword."""
    parted = re.sub(r"([A-Z]+)([A-Z][a-z])", r"\1_\2", name)
    parted = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", parted)
    snake = re.sub(r"_+", "_", parted).strip("_").lower()
    if not snake or snake[0].isdigit():
        snake = f"_{snake}"
    return f"{snake}_" if keyword.iskeyword(snake) else snake


def shared_prefix(names: Sequence[str]) -> str:
    """The longest beginning, up to an underscore, that all names have and none consists of."""
    if len(names) < 2:
        return ""
    shortest, longest = min(names), max(names)
    length = next(
        (i for i, (a, b) in enumerate(zip(shortest, longest, strict=False)) if a != b),
        min(len(shortest), len(longest)),
    )
    return shortest[: shortest.rfind("_", 0, length) + 1]


def field_name(signal: str, prefixes: Iterable[str]) -> str:
    """The Python field of a signal: without the first prefix it has, in snake case."""
    for prefix in sorted(prefixes, key=len, reverse=True):
        if prefix and signal.startswith(prefix) and signal != prefix:
            return snake_case(signal[len(prefix) :])
    return snake_case(signal)


def field_names(wanted: Iterable[str], also: Collection[str] = ()) -> list[str]:
    """Names that fields can have beside each other: the wanted ones, as far as that goes.

    What Python, typed messages or ``also`` need gets an underscore, a repeated name a number.
    """
    words = {*_NO_FIELDS, *also}
    taken = set(words)
    names: list[str] = []
    for name in wanted:
        plain = re.sub(r"\W", "_", name, flags=re.ASCII)
        # Two underscores in front are spelt otherwise within a class.
        plain = f"_{plain.lstrip('_')}" if plain.startswith("__") or plain[:1].isdigit() else plain
        plain = f"{plain}_" if plain in words else plain
        names.append(unused(plain if plain.strip("_") else "field", taken))
        taken.add(names[-1])
    return names


def unused(name: str, taken: Collection[str]) -> str:
    """The name, or what of ``name_2``, ``name_3`` and so on is not taken first."""
    free, count = name, 1
    while free in taken:
        count += 1
        free = f"{name}_{count}"
    return free


def member_names(labels: Sequence[tuple[int, str]]) -> dict[int, str]:
    """Enum member names for codes with ASCII labels; repeated ones get their code appended."""
    plain: dict[int, str] = {}
    for value, label in labels:
        name = re.sub(r"[^A-Za-z0-9]+", "_", label).strip("_").upper() or "CODE"
        plain[value] = f"_{name}" if name[0].isdigit() else name
    names = list(plain.values())
    taken = {name for name in names if names.count(name) == 1}
    members: dict[int, str] = {}
    for value, name in plain.items():
        if names.count(name) > 1:
            numbered = f"{name}_{value}".replace("-", "MINUS_")
            # No label makes a name that ends in an underscore; enums keep those that also begin so.
            while numbered in taken:
                numbered = f"N{numbered}" if numbered[0] == "_" else f"{numbered}_"
            taken.add(numbered)
            name = numbered  # noqa: PLW2901 - the one that is free
        members[value] = name
    return members
