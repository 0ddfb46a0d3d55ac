"""Generated from the spec by `dbcspec generate`. Do not edit: change the spec."""

NAME = "caamtb-swap"
"""Of the protocol and its DBC."""

DIGEST = "04252948edf0c4df"
"""Of the resolved model; the DBC beside this file carries the same."""
