"""A gzip file as a stream of bytes that gives all there is before any damage."""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from contextlib import suppress
from io import FileIO

GZIP = b"\x1f\x8b"
"""How a gzip file begins."""

_CHUNK = 1 << 16
_PIECE = 1 << 18
_WITH_HEADER = 31


class BrokenGzip(Exception):
    """The compressed data are damaged; the text says how."""


def gunzip(file: FileIO) -> Iterator[bytes]:
    """The content, in pieces of bounded size.

    Raises `BrokenGzip`, after all bytes that could be inflated, where the file is damaged or ends
    too early.
    """
    stream = zlib.decompressobj(_WITH_HEADER)
    while chunk := file.read(_CHUNK):
        while chunk:
            if stream.eof:  # another member may follow, or zeros that fill a block
                chunk = chunk.lstrip(b"\0")
                stream = zlib.decompressobj(_WITH_HEADER) if chunk else stream
                continue
            before = stream.copy()
            try:
                yield stream.decompress(chunk, _PIECE)
            except zlib.error as error:
                yield _up_to_the_damage(before, chunk)
                raise BrokenGzip(str(error).rpartition(": ")[2]) from None
            chunk = stream.unused_data if stream.eof else stream.unconsumed_tail
    yield stream.flush()
    if not stream.eof:
        raise BrokenGzip("the compressed data end too early")


def _up_to_the_damage(stream: zlib._Decompress, data: bytes) -> bytes:
    """Byte by byte: zlib keeps to itself what it made of a call that fails."""
    found: list[bytes] = []
    with suppress(zlib.error):
        found.extend(stream.decompress(data[place : place + 1]) for place in range(len(data)))
    return b"".join(found)
