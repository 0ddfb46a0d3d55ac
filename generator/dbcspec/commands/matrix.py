"""`dbcspec matrix export`, `dbcspec matrix import`, `dbcspec import`: in and out of other files."""

from __future__ import annotations

import argparse
from pathlib import Path

from dbcspec.artifacts import made_safe, made_safe_how, write
from dbcspec.commands import HELP
from dbcspec.commands.common import (
    Commands,
    load_project,
    print_report,
    project_option,
    report_options,
    source_protocol,
)
from dbcspec.compare.run import RULES, compare
from dbcspec.config import find_config
from dbcspec.edition.propose import propose_edition
from dbcspec.emit.spec import emit_spec
from dbcspec.emit.spec_database import not_in_spec
from dbcspec.emit.stub_names import package_name
from dbcspec.matrix.read import read_matrix
from dbcspec.matrix.write import emit_matrix, not_in_matrix
from dbcspec.read.doors import open_side
from dbcspec.spec.write import propose_spec
from typedcan.model.errors import ReadError
from typedcan.model.soundness import renames, with_unique_names
from typedcan.report.item import Report
from typedcan.shell.console import note, say
from typedcan.shell.files import put_in_place


def add(commands: Commands) -> None:
    """Declare the commands."""
    text = HELP["matrix"]
    matrix = commands.add_parser("matrix", help=text, description=f"{text.capitalize()}.")
    ways = matrix.add_subparsers(title="commands", metavar="COMMAND", required=True)

    text = "write the matrix of the project, or of a DBC"
    export = ways.add_parser("export", help=text, description=f"{text.capitalize()}.")
    export.set_defaults(run=_export)
    project_option(export)
    export.add_argument("source", nargs="?", help="a DBC or spec (default: the project)")
    export.add_argument("-o", "--output", type=Path, help="(default: NAME.xlsx)")
    export.add_argument("--encoding", help="of a DBC, where it is not to be found out")

    text = "compare a matrix with the project's spec, or write its changes into the spec"
    import_ = ways.add_parser("import", help=text, description=f"{text.capitalize()}.")
    import_.set_defaults(run=_import_matrix)
    project_option(import_)
    import_.add_argument("file", type=Path, help="the .xlsx file")
    import_.add_argument("--write-spec", action="store_true", help="change the YAML accordingly")
    report_options(import_)

    text = HELP["import"]
    foreign = commands.add_parser("import", help=text, description=f"{text.capitalize()}.")
    foreign.set_defaults(run=_import)
    foreign.add_argument("file", help="a DBC, matrix, KCD, SYM or ARXML")
    project_option(foreign)
    to = foreign.add_mutually_exclusive_group(required=True)
    to.add_argument("--out", type=Path, help="a folder that is new or empty")
    to.add_argument(
        "--as-edition",
        metavar="NAME",
        help="write what FILE says otherwise than the project's spec as an edition of it",
    )
    foreign.add_argument(
        "--over", metavar="EDITION", default="", help="with --as-edition: over that edition"
    )
    foreign.add_argument("--encoding", help="of FILE, where it is not to be found out")


def _export(options: argparse.Namespace) -> int:
    protocol = source_protocol(options)
    path = options.output or Path(f"{protocol.name}.xlsx")
    put_in_place({path: emit_matrix(with_unique_names(protocol))})
    say(f"wrote {path}")
    for text in (*renames(protocol), *not_in_matrix(protocol)):
        note(text)
    return 0


def _import_matrix(options: argparse.Namespace) -> int:
    project = load_project(options)
    matrix = read_matrix(options.file)
    if not options.write_spec:
        items = compare(project.protocol, matrix)
        title = f"{project.config.spec} → {options.file}"
        print_report(options, Report(title=title, items=items, rules=RULES))
        return 1 if items else 0
    folder = project.config.root / project.config.spec
    proposal = propose_spec(folder, project.protocol, matrix)
    for name in write(folder, proposal.files):
        say(f"wrote {project.config.spec}/{name}")
    for text in proposal.not_written:
        note(f"not written: {text}")
    return 1 if proposal.not_written else 0


def _import(options: argparse.Namespace) -> int:
    if options.as_edition is not None:
        return _import_edition(options)
    if options.over:
        raise ReadError("--over goes together with --as-edition")
    if options.out.exists() and any(options.out.iterdir()):
        raise ReadError(f"{options.out}: is not empty; a spec is written into a folder of its own")
    protocol = open_side(options.file, encoding=options.encoding).protocol
    files = emit_spec(made_safe(protocol))
    name = package_name(Path(options.file.rsplit(":", 1)[-1]).stem)
    files["pyproject.toml"] = f'[tool.dbcspec]\nname = "{name}"\nspec = "."\n'.encode()
    for file in write(options.out, files):
        say(f"wrote {options.out / file}")
    for text in (*made_safe_how(protocol), *not_in_spec(protocol)):
        note(text)
    return 0


def _import_edition(options: argparse.Namespace) -> int:
    config = find_config(options.project.resolve())
    found = open_side(options.file, encoding=options.encoding).protocol
    title = Path(options.file.rsplit(":", 1)[-1]).name
    patch = propose_edition(config, options.as_edition, found, title, options.over)
    folder = f"{config.spec}/editions/{options.as_edition}"
    for name in write(config.root / folder, patch.files):
        say(f"wrote {folder}/{name}")
    for text in patch.notes:
        note(f"not written: {text}")
    say(f"{patch.deviations} deviations, {patch.messages} more messages: go over each of them")
    return 0
