"""All lint rules, in the order in which they are listed to people."""

from __future__ import annotations

from dbcspec.lint import signals_overlap
from dbcspec.lint.rule import Rule

RULES: tuple[Rule, ...] = (signals_overlap.RULE,)
