"""zlib streams with bounded memory: by libdeflate where it is installed, whatever can be saved."""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Iterator
from contextlib import suppress

try:
    from deflate import DeflateError, zlib_decompress
except ImportError:

    def _fast(_body: bytes, _size: int) -> bytes | bytearray | None:
        return None
else:

    def _fast(_body: bytes, _size: int) -> bytes | bytearray | None:
        try:
            return zlib_decompress(_body, _size)
        except DeflateError:
            return None


PIECE = 2**20
"""The most bytes that are inflated at a time."""


class BrokenStream(Exception):
    """What was inflated so far is all there is; the text says why.

    ``early`` says that nothing else is wrong than that the data end.
    """

    def __init__(self, problem: str, *, early: bool = False) -> None:
        super().__init__(problem)
        self.early = early


def inflated(body: bytes, size: int) -> bytes | bytearray | None:
    """A whole stream at once, or None if it is not a sound one of ``size`` bytes.

    This is fast and takes no more memory than ``size``. `pieces` does what this leaves undone.
    """
    if not 0 < size <= PIECE:
        return None
    whole = _fast(body, size)
    if whole is None:
        stream = zlib.decompressobj()
        try:
            whole = stream.decompress(body, size + 1)
        except zlib.error:
            return None
        if not stream.eof:
            return None
    return whole if len(whole) == size else None


def pieces(chunks: Iterable[bytes]) -> Iterator[bytes]:
    """A stream that comes in chunks, inflated piece by piece.

    Raises `BrokenStream`, after all bytes that could be inflated, where it is damaged or ends too
    early.
    """
    stream = zlib.decompressobj()
    for chunk in chunks:
        rest, more = chunk, True
        while more and not stream.eof:
            before = stream.copy()
            try:
                piece = stream.decompress(rest, PIECE)
            except zlib.error as error:
                yield _up_to_the_damage(before, rest)
                raise BrokenStream(str(error).rpartition(": ")[2]) from None
            yield piece
            rest = stream.unconsumed_tail
            more = bool(rest) or len(piece) == PIECE  # more may wait within the stream
    if not stream.eof:
        raise BrokenStream("the compressed data end too early", early=True)


def _up_to_the_damage(stream: zlib._Decompress, data: bytes) -> bytes:
    """Byte by byte: zlib keeps to itself what it made of a call that fails."""
    found = bytearray()
    with suppress(zlib.error):
        for place in range(len(data)):
            found += stream.decompress(data[place : place + 1])
    return bytes(found)
