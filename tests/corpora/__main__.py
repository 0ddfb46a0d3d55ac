"""Packages of all databases in a folder: cd tests; python -m corpora FOLDER.

Each file is generated from as `dbcspec generate --from` does; each package is imported in a process
of its own, and its messages are held against cantools. What cannot be made is listed with why.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from corpora.packages import Outcome, Result, databases_in, tried


def main() -> int:
    """Try all files, print a table of counts and the failures; 1 where there is one."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("folder", type=Path, help="where the databases are, at any depth")
    options.add_argument("--jobs", type=int, default=2, help="files at a time (default: 2)")
    arguments = options.parse_args()
    results: list[Result] = []
    for result in tried(databases_in(arguments.folder), jobs=arguments.jobs):
        results.append(result)
        if result.outcome is not Outcome.SOUND:
            name = result.path.relative_to(arguments.folder)
            print(f"{result.outcome.value}: {name}: {result.why}", flush=True)
    print(f"\n{len(results):6} files")
    for outcome in Outcome:
        print(f"{sum(each.outcome is outcome for each in results):6} {outcome.value}")
    print(f"{sum(each.messages for each in results):6} messages as cantools has them")
    print(f"{sum(each.values for each in results):6} values of their columns too")
    return 1 if any(each.outcome is Outcome.FAILED for each in results) else 0


if __name__ == "__main__":
    sys.exit(main())
