"""The commands of `dbcspec`, in files that declare and do them: imported when they are chosen."""

from __future__ import annotations

from collections.abc import Mapping

HELP: Mapping[str, str] = {
    "generate": "write all generated files",
    "check": "exit 1 and name each generated file that is not current",
    "lint": "find faults in the spec, or in a DBC, a matrix or another spec",
    "explain": "what a rule looks for, with an example of what it finds",
    "rules": "list the lint rules and the promises of compare",
    "show": "show one message in the terminal",
    "textconv": "print a protocol line by line, for git's textconv",
    "compare": "say what changed between two protocols, and whom it breaks",
    "matrix": "write or read the Excel CAN matrix",
    "import": "write a first spec folder, or a first edition, from a DBC or another file",
    "load": "bus load, worst-case response times, and what still fits",
}
"""What each command does, in a line, in the order of the help."""

MODULES: Mapping[str, str] = {
    "generate": "generate",
    "check": "generate",
    "lint": "lint",
    "explain": "explain",
    "rules": "lint",
    "show": "show",
    "textconv": "show",
    "compare": "compare",
    "matrix": "matrix",
    "import": "matrix",
    "load": "load",
}
"""The module here that declares each command."""
