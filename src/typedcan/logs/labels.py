"""Codes as the labels that the database gives them: Arrow dictionary arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

LABEL_TYPE = pa.dictionary(pa.int32(), pa.string())


def label_array(
    values: NDArray[Any], labels: Mapping[int, str], valid: NDArray[np.bool_] | None
) -> pa.Array[Any]:
    """Raw codes as labels, of type `LABEL_TYPE`; a code without a label becomes its digits.

    The dictionary begins with all labels, in the order of their codes.
    """
    codes, words = known_codes(values.dtype, labels)
    places = places_of(values, codes)
    missing = places < 0
    if valid is not None:
        missing &= valid
    if missing.any():
        others, inverse = np.unique(values[missing], return_inverse=True)
        places[missing] = len(words) + inverse
        words = [*words, *(str(code) for code in others.tolist())]
    if valid is not None:
        places[~valid] = 0
    # Two codes can share a label; Arrow wants each word of a dictionary once.
    first = {word: place for place, word in reversed(list(enumerate(words)))}
    if len(first) < len(words):
        ordered = sorted(first, key=first.__getitem__)
        rank = {word: place for place, word in enumerate(ordered)}
        places = np.array([rank[word] for word in words], np.int32)[places]
        words = ordered
    indices = pa.array(places, pa.int32(), mask=None if valid is None else ~valid)
    return pa.DictionaryArray.from_arrays(indices, pa.array(words, pa.string()), safe=False)


def known_codes(dtype: np.dtype[Any], labels: Mapping[Any, str]) -> tuple[NDArray[Any], list[str]]:
    """The codes that a number of that type can be, ascending, and their labels."""
    codes = sorted(labels)
    if dtype.kind in "iu":
        limits = np.iinfo(dtype)
        codes = [code for code in codes if limits.min <= code <= limits.max]
    return np.array(codes, dtype), [labels[code] for code in codes]


def places_of(values: NDArray[Any], codes: NDArray[Any]) -> NDArray[np.int32]:
    """For each value its index among the ascending codes, -1 where it is none of them."""
    if not len(codes):
        return np.full(len(values), -1, np.int32)
    places = np.searchsorted(codes, values).astype(np.int32)
    np.minimum(places, len(codes) - 1, out=places)
    places[codes[places] != values] = -1
    return places
