"""All lint rules, in the order in which they are listed to people."""

from __future__ import annotations

from dbcspec.lint import (
    code_in_raw_range,
    code_labelled,
    erratum_target,
    identifier_unique,
    name_is_identifier,
    name_unique,
    node_declared,
    range_fits_bits,
    signal_in_message,
    signal_in_table,
    signal_inside_message,
    signals_overlap,
    table_annex_agree,
    tables_agree,
    text_fits_dbc,
    value_table_named,
    waiver_used,
)
from dbcspec.lint.rule import Rule

RULES: tuple[Rule, ...] = (
    signals_overlap.RULE,
    signal_inside_message.RULE,
    identifier_unique.RULE,
    name_unique.RULE,
    range_fits_bits.RULE,
    code_in_raw_range.RULE,
    code_labelled.RULE,
    signal_in_message.RULE,
    signal_in_table.RULE,
    tables_agree.RULE,
    table_annex_agree.RULE,
    name_is_identifier.RULE,
    node_declared.RULE,
    value_table_named.RULE,
    erratum_target.RULE,
    text_fits_dbc.RULE,
)
"""Rules over a subject."""

ALL_RULES: tuple[Rule, ...] = (*RULES, waiver_used.RULE)
"""With the rule over the waivers of the others, which `dbcspec.lint.run` runs last."""
