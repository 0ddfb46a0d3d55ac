"""Findings in files of others, to be judged: cd tests; python -m corpora.findings FOLDER.

Every database in a folder, each content once, is linted as `dbcspec lint --profile foreign` does.
Printed are the counts by rule, files that are refused or take long, and findings drawn by a seed,
each with the lines that it is about: whoever reads them says which are real.
"""

from __future__ import annotations

import argparse
import hashlib
import random
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from corpora.packages import databases_in
from dbcspec.errors import DbcspecError
from dbcspec.lint.options import FOREIGN, Options
from dbcspec.lint.rule import Finding, Subject
from dbcspec.lint.run import lint_with
from dbcspec.read.doors import open_side
from typedcan.model.errors import TypedcanError
from typedcan.shell.printing import printable

_ABOUT = 1
"""Lines of a file that are shown before and after the one of a finding."""


@dataclass(slots=True)
class Corpus:
    """What linting a folder gave: findings with their files, refusals, and seconds of each file."""

    findings: list[tuple[Path, Finding]] = field(default_factory=list[tuple[Path, Finding]])
    refused: dict[Path, str] = field(default_factory=dict[Path, str])
    seconds: dict[Path, float] = field(default_factory=dict[Path, float])

    def drawn(self, count: int, seed: int) -> list[tuple[Path, Finding]]:
        """So many of the findings, all if there are fewer; the same for the same seed."""
        order = sorted(self.findings, key=lambda each: (str(each[0]), each[1]))
        return random.Random(seed).sample(order, min(count, len(order)))

    def rules(self) -> Counter[str]:
        """How many findings each rule has."""
        return Counter(finding.rule for _, finding in self.findings)


def linted(folder: Path) -> Corpus:
    """Lint every database in a folder, each content once, in the order of their paths."""
    corpus, seen = Corpus(), set[bytes]()
    for path in sorted(databases_in(folder)):
        digest = hashlib.sha256(path.read_bytes()).digest()
        if digest in seen:
            continue
        seen.add(digest)
        began = time.perf_counter()
        try:
            side = open_side(str(path), wide=True)
            subject = Subject(protocol=side.protocol, dbc_text="", source=str(path))
            findings = lint_with(subject, Options().under(FOREIGN))
            corpus.findings += [(path, each) for each in findings]
        except (TypedcanError, DbcspecError) as error:
            corpus.refused[path] = str(error)
        corpus.seconds[path] = time.perf_counter() - began
    return corpus


def shown(path: Path, finding: Finding) -> Iterator[str]:
    """A finding below the lines that it is about."""
    lines = path.read_bytes().decode("utf-8", "replace").splitlines()
    first = max(finding.where.line - _ABOUT, 1)
    for number, line in enumerate(lines[first - 1 : finding.where.line + _ABOUT], start=first):
        yield f"    {number:6} | {printable(line)}"
    yield f"    {finding.level} {finding.rule}: {printable(finding.text)}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Lint all files and print counts, refusals, slow files and what is drawn; always 0."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="where the databases are, at any depth")
    parser.add_argument("--count", type=int, default=30, help="findings to draw (default: 30)")
    parser.add_argument("--seed", type=int, default=1, help="(default: 1)")
    parser.add_argument(
        "--slow", type=float, default=10, help="seconds that are long (default: 10)"
    )
    options = parser.parse_args(arguments)
    corpus = linted(options.folder)
    for why in corpus.refused.values():
        print(f"refused: {printable(why)}")
    for path, seconds in corpus.seconds.items():
        if seconds > options.slow:
            print(f"slow: {path.relative_to(options.folder)}: {seconds:.1f} s")
    print(f"\n{len(corpus.seconds):6} files, {len(corpus.refused)} refused")
    for rule, count in corpus.rules().most_common():
        print(f"{count:6} {rule}")
    for number, (path, finding) in enumerate(corpus.drawn(options.count, options.seed), start=1):
        print(f"\n{number}. {path.relative_to(options.folder)}")
        print("\n".join(shown(path, finding)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
