"""`dbcspec generate` and `check`: write the generated files, or say which are not current."""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path

from dbcspec.artifacts import (
    Stale,
    artifacts,
    chosen_artifacts,
    foreign_artifacts,
    made_safe_how,
    verify,
    write,
)
from dbcspec.commands import HELP
from dbcspec.commands.common import (
    Commands,
    choice_options,
    choice_text,
    given_algorithms,
    load_sound_project,
    project_option,
    sound,
)
from dbcspec.emit.stub_names import package_name
from dbcspec.errors import StaleArtifactError
from dbcspec.matrix.write import not_in_matrix
from dbcspec.project import Project, editions_of
from dbcspec.read.doors import open_side
from dbcspec.spec.variants import with_variants
from dbcspec.trial import try_package
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Protocol
from typedcan.model.soundness import hidden_how
from typedcan.shell.algorithms import add_algorithm_option
from typedcan.shell.console import note, say
from typedcan.shell.printing import printable_json


def add(commands: Commands) -> None:
    """Declare both commands."""
    text = HELP["generate"]
    generate = commands.add_parser("generate", help=text, description=f"{text.capitalize()}.")
    generate.set_defaults(run=_generate)
    project_option(generate)
    generate.add_argument("--json", action="store_true", help="print JSON")
    generate.add_argument(
        "--from", dest="source", metavar="FILE", help="read this DBC or matrix, not the project"
    )
    generate.add_argument(
        "--out", type=Path, help="with --from, --edition or --reading: the folder to write into"
    )
    choice_options(generate)
    generate.add_argument("--encoding", help="of FILE, where it is not to be found out")
    add_algorithm_option(generate)

    text = HELP["check"]
    check = commands.add_parser("check", help=text, description=f"{text.capitalize()}.")
    check.set_defaults(run=_check)
    project_option(check)
    check.add_argument("--json", action="store_true", help="print JSON")
    add_algorithm_option(check)


def _generate(options: argparse.Namespace) -> int:
    choice = choice_text(options)
    if options.source and choice:
        raise ReadError("--edition and --reading are of the project's spec: not with --from")
    if bool(options.source or choice) != bool(options.out):
        raise ReadError("--out goes together with --from, --edition or --reading")
    if options.source:
        protocol = open_side(options.source, encoding=options.encoding).protocol
        given_algorithms(options, protocol)
        name = package_name(Path(options.source.rsplit(":", 1)[-1]).stem)
        root, files = options.out, foreign_artifacts(protocol, name)
        try_package(files, name, f"{name}.dbc")
        said = [*made_safe_how(protocol), *hidden_how(protocol), *not_in_matrix(protocol)]
        for text in said:
            note(text)
    elif choice:
        project = load_sound_project(options, choice)
        protocol, root = project.protocol, options.out
        files = chosen_artifacts(protocol, project.config)
        if project.config.stubs:
            name = project.config.name
            try_package(files, package_name(name), f"{name}.dbc")
    else:
        project = load_sound_project(options)
        root, config = project.config.root, project.config
        protocol = with_variants(project.protocol, project.printed)
        files = artifacts(protocol, config, _editions(options, project))
        if config.stubs:
            try_package(files, config.stubs, f"{config.dbc}/{config.name}.dbc")
    changed = write(root, files)
    if options.json:
        say(printable_json({**_counts(protocol), "digest": protocol.digest, "changed": changed}))
        return 0
    counts = _counts(protocol)
    say(
        f"{protocol.name}: {counts['messages']} messages, {counts['signals']} signals,"
        f" {counts['value_tables']} value tables, {counts['errata']} errata applied,"
        f" digest {protocol.digest}"
    )
    for name in changed:
        say(f"wrote {name}")
    say(f"{len(files) - len(changed)} of {len(files)} files were current")
    return 0


def _editions(options: argparse.Namespace, project: Project) -> dict[str, Protocol]:
    """Each edition of the project's spec; raises `FindingsError` for what is wrong in one."""
    return {name: sound(options, each).protocol for name, each in editions_of(project)}


def _stale_lines(stale: Stale) -> Iterator[str]:
    yield f"{stale.path}: {stale.why}"
    yield from (f"    {line}" for line in stale.diff)


def _mending(stale: Sequence[Stale], count: int, folder: Path) -> str:
    """How many files are not current, and the command that mends them."""
    where = "" if folder == Path() else f" -C {shlex.quote(str(folder))}"
    surplus = sum(each.is_surplus for each in stale)
    delete = f"; delete the {surplus} no longer generated" if surplus else ""
    return (
        f"{len(stale) - surplus} of {count} files are not current: dbcspec generate{where}"
        f" writes them{delete}"
    )


def _counts(protocol: Protocol) -> dict[str, int]:
    return {
        "messages": len(protocol.messages),
        "signals": sum(1 for _ in protocol.signals()),
        "value_tables": len(protocol.value_tables),
        "errata": len(protocol.errata),
    }


def _check(options: argparse.Namespace) -> int:
    project = load_sound_project(options)
    protocol = with_variants(project.protocol, project.printed)
    files = artifacts(protocol, project.config, _editions(options, project))
    stale = verify(project.config.root, files, project.protocol, project.config)
    if options.json:
        found = [{"path": each.path, "why": each.why, "diff": list(each.diff)} for each in stale]
        say(printable_json(found))
        return 1 if stale else 0
    if stale:
        lines = [line for each in stale for line in _stale_lines(each)]
        raise StaleArtifactError(*lines, _mending(stale, len(files), options.project))
    say(f"{len(files)} files are current, digest {project.protocol.digest}")
    return 0
