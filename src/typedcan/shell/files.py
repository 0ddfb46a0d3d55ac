"""Files that appear whole or not at all."""

from __future__ import annotations

import os
import secrets
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from typedcan.shell.console import CommandError


def put_in_place(files: Mapping[Path, bytes]) -> None:
    """Write all files beside their places, then move them there; raises `CommandError`.

    A file that is replaced leaves its mode to the new one, a link to one stays a link. What is no
    file, such as a device or a pipe, is written to as it is. Nothing is left of what fails.
    """
    targets = {Path(os.path.realpath(path)): (path, data) for path, data in files.items()}
    drafts: dict[Path, Path] = {}
    try:
        for target, (path, data) in targets.items():
            with _named(path):
                mode = _mode(target)
                if mode is not None and not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):
                    target.write_bytes(data)
                    continue
                drafts[target] = target.with_name(f".{target.name[:200]}.{secrets.token_hex(8)}")
                _write_new(drafts[target], data, mode)
        for target, draft in drafts.items():
            with _named(targets[target][0]):
                draft.replace(target)
    finally:
        for draft in drafts.values():
            with suppress(OSError):
                draft.unlink(missing_ok=True)


def _mode(target: Path) -> int | None:
    """The mode of what is there, None where nothing is."""
    with suppress(FileNotFoundError):
        return target.stat().st_mode
    return None


def _write_new(path: Path, data: bytes, mode: int | None) -> None:
    """Write a file that nobody has made before, so that no link of somebody's is followed."""
    with path.open("xb") as file:
        if mode is not None:
            path.chmod(stat.S_IMODE(mode))
        file.write(data)


@contextmanager
def _named(path: Path) -> Iterator[None]:
    """Turn what goes wrong while a path is written into one line that names it."""
    try:
        yield
    except OSError as error:
        raise CommandError(f"{path}: cannot be written: {error.strerror or error}") from None
    except ValueError:
        raise CommandError(f"{str(path)!r}: is no path") from None
