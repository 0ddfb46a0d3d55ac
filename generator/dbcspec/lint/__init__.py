"""Faults that a rule can find in a protocol: one rule, one file, one case folder."""
