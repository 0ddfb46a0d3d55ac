"""MF4 files through asammdf: a channel group per table, with units and labels."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from typedcan.logs.arrow import STATES
from typedcan.logs.write.plain import is_plain, text_array
from typedcan.model.errors import TypedcanError

_SHORT = 8
"""Bits."""

_DIGITS, _NAME = 160, 32
"""Bytes of a number beyond 64 bits, as digits (512 bits have 155), and of a channel's name."""

_LONGEST = 8192
"""Bytes of a text; each sample takes as many as the longest can have."""


class Mf4Error(TypedcanError):
    """An MF4 file cannot be written: asammdf is missing."""


class Mf4File:
    """All tables in one MF4 file; time stamps are relative to its start time.

    Raises
    ------
    Mf4Error
        Where asammdf is not installed.
    """

    def __init__(self, path: Path) -> None:
        try:
            package = import_module("asammdf")
        except ModuleNotFoundError:
            raise Mf4Error("MF4 needs asammdf: pip install 'swapcan[mf4]'") from None
        self._signal: Any = package.Signal
        self._mdf: Any = package.MDF(version="4.10")
        self._path = path
        self._groups: dict[str, int] = {}
        self._begin = 0.0

    def begin(self, timestamp: float) -> None:
        """The time stamp of the first frame."""
        self._begin = timestamp
        if timestamp > 0:
            self._mdf.header.start_time = datetime.fromtimestamp(timestamp, UTC)
            self._begin = self._mdf.header.start_time.timestamp()

    def write(self, name: str, rows: pa.Table) -> None:
        """Add rows to the channel group of that name."""
        times = rows.column("timestamp").to_numpy() - self._begin
        signals = [
            self._channel(part, rows.column(part.name).combine_chunks(), times)
            for part in rows.schema
            if part.name != "timestamp"
        ]
        if name in self._groups:
            data = [(signal.samples, signal.invalidation_bits) for signal in signals]
            self._mdf.extend(self._groups[name], [(times, None), *data])
        else:
            self._groups[name] = self._mdf.append(signals, acq_name=name, comment=name)

    def close(self) -> None:
        """Write the file."""
        self._mdf.save(self._path, overwrite=True, compression=1)
        self._mdf.close()

    def abort(self) -> None:
        """Give up; nothing is written."""
        self._mdf.close()

    def _channel(self, part: pa.Field[Any], column: Any, times: NDArray[np.float64]) -> Any:
        metadata = {key.decode(): value.decode() for key, value in (part.metadata or {}).items()}
        array = column.chunk(0) if isinstance(column, pa.ChunkedArray) else column
        samples, conversion = _samples(array, metadata)
        missing = np.asarray(array.is_null())
        return self._signal(
            samples=samples,
            timestamps=times,
            name=part.name,
            unit=metadata.get("unit", ""),
            conversion=conversion,
            comment=metadata.get("reference", ""),
            encoding="utf-8" if samples.dtype.kind == "S" else None,
            # Always: whoever extends a group later may have values that are none.
            invalidation_bits=missing,
        )


def _samples(array: Any, metadata: dict[str, str]) -> tuple[NDArray[Any], dict[str, Any] | None]:
    """The samples of a column, and the conversion that shows codes by their labels."""
    labels = _labels(metadata)
    plain = float(metadata.get("factor", "1")) == 1 and float(metadata.get("offset", "0")) == 0
    if not pa.types.is_dictionary(array.type):
        if not is_plain(array.type):
            array = text_array(array)
        if pa.types.is_string(array.type):
            width = min(int(metadata.get("bytes", _DIGITS)), _LONGEST)
            return _bytes(array.fill_null(""), width), None
        samples = array.fill_null(0).to_numpy()
        return samples, _conversion(labels) if plain and samples.dtype.kind in "iu" else None
    indices = array.indices.fill_null(0).to_numpy()
    words: list[str] = array.dictionary.to_pylist()
    if words == list(STATES):
        return indices.astype(np.uint8), _conversion(dict(enumerate(STATES)))
    if not labels:
        return _bytes(array.dictionary.take(array.indices).fill_null(""), _NAME), None
    codes = {word: code for code, word in reversed(labels.items())}
    numbers = np.array([codes[word] if word in codes else int(word) for word in words], np.int64)
    return numbers[indices] if len(words) else indices.astype(np.int64), _conversion(labels)


def _labels(metadata: dict[str, str]) -> dict[int, str]:
    """The labels of a column's codes; of short signals each code has one, if only its digits.

    asammdf shows a code that a conversion leaves out as an empty text.
    """
    given = {int(code): word for code, word in json.loads(metadata.get("labels", "{}")).items()}
    length = int(metadata.get("length", "64"))
    if not given or min(given) < 0 or length > _SHORT:
        return given
    return {code: given.get(code, str(code)) for code in range(1 << length)}


def _bytes(array: Any, width: int) -> NDArray[Any]:
    return np.array([text.encode()[:width] for text in array.to_pylist()], f"S{width}")


def _conversion(labels: dict[int, str]) -> dict[str, Any] | None:
    """A value-to-text conversion as asammdf takes it."""
    if not labels:
        return None
    conversion: dict[str, Any] = {}
    for place, (code, word) in enumerate(labels.items()):
        conversion[f"val_{place}"] = code
        conversion[f"text_{place}"] = word.encode()
    return conversion
