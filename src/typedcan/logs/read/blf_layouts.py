"""Where the objects of a BLF log keep a frame's properties."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

CAN_MESSAGE = 1
CAN_ERROR = 2
CAN_ERROR_EXT = 73
CAN_MESSAGE2 = 86
CAN_FD_MESSAGE = 100
CAN_FD_MESSAGE_64 = 101
CAN_FD_ERROR_64 = 104

FRAME_TYPES = frozenset(
    {
        CAN_MESSAGE,
        CAN_ERROR,
        CAN_ERROR_EXT,
        CAN_MESSAGE2,
        CAN_FD_MESSAGE,
        CAN_FD_MESSAGE_64,
        CAN_FD_ERROR_64,
    }
)

_KINDS = {
    3: "overload frames",
    4: "statistics",
    31: "errors of the interface",
    32: "events",
    92: "comments",
    96: "markers",
}


def kind_of(type_: int) -> str:
    """What objects of a type that is no frame are, for people."""
    return _KINDS.get(type_, "objects of other kinds")


HEADER_SIZES = {1: 32, 2: 40}
"""Bytes before an object's body, by the version of its header."""

_HEADER = {
    "header_size": ("<u2", 4),
    "size": ("<u4", 8),
    "time_unit": ("<u4", 16),
    "time": ("<u8", 24),
}

_CLASSIC = {
    "channel": ("<u2", 0),
    "flags": ("u1", 2),
    "dlc": ("u1", 3),
    "id": ("<u4", 4),
    "data": ("8u1", 8),
}

_BODIES: dict[int, dict[str, tuple[str, int]]] = {
    CAN_MESSAGE: _CLASSIC,
    CAN_MESSAGE2: _CLASSIC,
    CAN_ERROR: {"channel": ("<u2", 0)},
    CAN_ERROR_EXT: {
        "channel": ("<u2", 0),
        "dlc": ("u1", 10),
        "id": ("<u4", 16),
        "data": ("8u1", 24),
    },
    CAN_FD_MESSAGE: {
        "channel": ("<u2", 0),
        "flags": ("u1", 2),
        "dlc": ("u1", 3),
        "id": ("<u4", 4),
        "fd_flags": ("u1", 13),
        "valid": ("u1", 14),
        "data": ("64u1", 20),
    },
    CAN_FD_MESSAGE_64: {
        "channel": ("u1", 0),
        "dlc": ("u1", 1),
        "valid": ("u1", 2),
        "id": ("<u4", 4),
        "fd_flags": ("<u4", 12),
        "direction": ("u1", 34),
        "extra": ("u1", 35),
        "checksum": ("<u4", 36),
    },
    CAN_FD_ERROR_64: {
        "channel": ("u1", 0),
        "dlc": ("u1", 1),
        "valid": ("u1", 2),
        "extra": ("u1", 10),
        "id": ("<u4", 12),
        "last": ("<u2", 42),
    },
}


@dataclass(frozen=True, slots=True)
class Layout:
    """How objects of one type, ``kind``, and header version look.

    ``record`` is the object as a structured type: its itemsize is the least size of such an object.
    """

    kind: int
    record: np.dtype[np.void]


def _layout(kind: int, version: int) -> Layout:
    body = {
        name: (form, HEADER_SIZES[version] + offset)
        for name, (form, offset) in _BODIES[kind].items()
    }
    fields = _HEADER | body
    record = np.dtype(
        {
            "names": list(fields),
            "formats": [form for form, _ in fields.values()],
            "offsets": [offset for _, offset in fields.values()],
        }
    )
    return Layout(kind, record)


LAYOUTS = {
    (kind, version): _layout(kind, version) for kind in FRAME_TYPES for version in HEADER_SIZES
}
"""By type and version of the header."""
