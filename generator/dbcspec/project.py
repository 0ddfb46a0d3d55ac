"""A project's spec from its folder to the model, with what the linter says of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from dbcspec.config import Config
from dbcspec.errors import Fault
from dbcspec.lint.options import Options
from dbcspec.lint.rule import Finding, Subject
from dbcspec.lint.run import lint_with
from dbcspec.spec.compiled import Compiled, compile_rows, compile_spec
from dbcspec.spec.readings import Choice
from dbcspec.spec.rows import Spec
from typedcan.model.checksums.registry import Given
from typedcan.model.protocol import Protocol


@dataclass(frozen=True, slots=True)
class Project:
    """A spec that could be read: its configuration, corrected rows and model."""

    config: Config
    spec: Spec
    protocol: Protocol
    errata_faults: tuple[Fault, ...]
    printed: Spec

    def findings(self, algorithms: Given | None = None) -> list[Finding]:
        """What the linter finds and no waiver accepts."""
        return lint_with(self.subject(algorithms), self.lint)

    @property
    def lint(self) -> Options:
        """What is asked of the linter: by the project, else by the spec."""
        return self.config.lint.of_spec(self.spec.standard.profile)

    def subject(self, algorithms: Given | None = None) -> Subject:
        """What the linter looks at; ``algorithms`` are what users give to compute checksums."""
        return Subject(
            protocol=self.protocol,
            spec=self.spec,
            errata_faults=self.errata_faults,
            source=self.config.spec,
            algorithms=algorithms or {},
        )


def load(config: Config, choice: str = "") -> Project:
    """Read, correct and resolve; raises `SpecError` with every fault that prevents it.

    ``choice`` is an edition and readings, as ``v4.6+E50b``; raises `ReadError` where there is none
    such.
    """
    compiled = compile_spec(config.root / config.spec, config.spec, config.name, choice)
    return _of(config, compiled)


def editions_of(project: Project) -> Iterator[tuple[str, Project]]:
    """Each edition of a project's spec by its name, from the rows that were read already.

    Raises `SpecError` with every fault that prevents one.
    """
    for edition in project.printed.editions:
        choice = Choice(edition=edition.name)
        compiled = compile_rows(project.printed, project.config.name, choice)
        yield edition.name, _of(project.config, compiled)


def _of(config: Config, compiled: Compiled) -> Project:
    return Project(
        config, compiled.spec, compiled.protocol, compiled.errata_faults, compiled.printed
    )
