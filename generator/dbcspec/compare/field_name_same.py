"""A field keeps the name that generated code gives it."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, signal_change
from typedcan.model.protocol import Aspect


def _check(pairing: Pairing) -> Iterator[Change]:
    for signal in pairing.signals:
        old, new = signal.old.python_name, signal.new.python_name
        # A renamed signal takes its field with it.
        if old != new and signal.old.name == signal.new.name:
            yield signal_change(signal, "field", old, new)


PROMISE = Promise(
    "field-name-same",
    "The field of a signal is called the same in generated code.",
    Class.SOURCE,
    Breaks.BOTH,
    _check,
    needs=Aspect.PYTHON_NAMES,
)
