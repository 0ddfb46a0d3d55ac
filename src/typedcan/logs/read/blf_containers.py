"""The containers of a BLF log, one after another, inflated."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from io import BufferedReader

from typedcan.logs.read.blf_scan import BASE_SIZE, SIGNATURE
from typedcan.logs.read.inflate import PIECE, BrokenStream, inflated, pieces

_LOG_CONTAINER = 10
_LAST_KIND = 1023  # Vector has numbered fewer than 200 kinds of objects
_STORED = 0
_DEFLATED = 2

_BASE = struct.Struct("<4s4xLL")  # signature, size, type
_CONTAINER = struct.Struct("<H6xL4x")  # method, inflated size


class BrokenLog(Exception):
    """A BLF log is damaged from byte ``at`` on; the text says how.

    ``missing`` bytes at least were once behind the end of the file.
    """

    def __init__(self, at: int, problem: str, missing: int = 0) -> None:
        super().__init__(problem)
        self.at = at
        self.missing = missing


@dataclass(frozen=True, slots=True)
class Piece:
    """Inflated bytes of a container.

    Parameters
    ----------
    at
        The byte of the file where the container begins.
    end
        So far the file is read.
    data
        The bytes.
    checked
        Whether a checksum confirmed them.
    """

    at: int
    end: int
    data: bytes | bytearray
    checked: bool

    def broken(self, problem: str) -> BrokenLog:
        """What to raise where the contents of the container are damaged."""
        doubt = "" if self.checked else "; frames from here on are unchecked"
        return BrokenLog(self.at, problem + doubt)


def containers(file: BufferedReader, size: int) -> Iterator[Piece]:
    """What the containers from here to byte ``size``, the end of the file, hold.

    Raises `BrokenLog`, after all that could be inflated.
    """
    at = file.tell()
    while base := file.read(BASE_SIZE):
        if len(base) < BASE_SIZE:
            raise BrokenLog(at, "the file ends within the header of a container")
        signature, length, kind = _BASE.unpack(base)
        if signature != SIGNATURE or length < BASE_SIZE or kind > _LAST_KIND:
            raise BrokenLog(at, "no container begins here")
        end = at + length
        if kind == _LOG_CONTAINER:
            yield from _container(file, at, end, size)
            if end > size:
                raise BrokenLog(size, "the file ends within a container", end - size)
        elif end > size:
            raise BrokenLog(at, "the file ends within an object")
        at = min(end + length % 4, size)
        file.seek(at)


def _container(file: BufferedReader, at: int, end: int, size: int) -> Iterator[Piece]:
    header = file.read(_CONTAINER.size)
    if len(header) < _CONTAINER.size or file.tell() > end:
        raise BrokenLog(at, "the header of a container is cut off")
    method, stated = _CONTAINER.unpack(header)
    if method not in (_STORED, _DEFLATED):
        raise BrokenLog(at, f"a container has compression {method}, which is unknown")
    chunks = _chunks(file, end)
    first = next(chunks, b"")
    if method == _DEFLATED and file.tell() == end:
        whole = inflated(first, stated)
        if whole is not None:
            yield Piece(at, end, whole, checked=True)
            return
    piece = Piece(at, end, b"", checked=False)
    stream = _with(first, chunks)
    try:
        for data in stream if method == _STORED else pieces(stream):
            piece = Piece(at, file.tell(), data, checked=False)
            yield piece
    except BrokenStream as error:
        if end <= size or not error.early:  # else it is the file that was cut off
            raise piece.broken(str(error)) from None
    else:
        if method == _DEFLATED and end > size:
            raise piece.broken("a container says that it is longer than it is")


def _chunks(file: BufferedReader, end: int) -> Iterator[bytes]:
    while chunk := file.read(min(end - file.tell(), PIECE)):
        yield chunk


def _with(first: bytes, rest: Iterator[bytes]) -> Iterator[bytes]:
    yield first
    yield from rest


def batches(read: Iterator[Piece], size: int) -> Iterator[list[Piece]]:
    """The same pieces, about ``size`` inflated bytes at a time; raises what ``read`` raises."""
    batch: list[Piece] = []
    count = 0
    try:
        for piece in read:
            batch.append(piece)
            count += len(piece.data)
            if count >= size:
                yield batch
                batch, count = [], 0
    except BrokenLog:
        if batch:
            yield batch
        raise
    if batch:
        yield batch
