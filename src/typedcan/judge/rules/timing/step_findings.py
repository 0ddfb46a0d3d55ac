"""Puts single steps that are wrong among the findings, however many there are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.findings import KEPT, Findings, Occurrence, Subject
from typedcan.judge.measure.steps import Steps
from typedcan.report.language import Text


def add_steps(
    findings: Findings,
    steps: Steps,
    wrong: NDArray[np.bool_],
    measure: NDArray[np.float64],
    text: Text,
    values: Mapping[str, Any],
) -> None:
    """Judge steps; each that is wrong is an occurrence.

    Where more are wrong than are kept, the rest are counted, and only the worst of them is made.

    Parameters
    ----------
    wrong, measure
        Which of the steps are wrong, and how bad each step is.
    text, values
        What is wrong; the step's ``step`` in seconds and its ``periods`` are filled in beside.
    """
    node = steps.message.SENDER
    if node not in findings.nodes:
        return
    findings.examine(node, len(steps))
    found = np.flatnonzero(wrong)
    if not len(found):
        return
    found = found[np.argsort(steps.time[found], kind="stable")]
    room = max(KEPT - len(findings.kept), 0)
    rest = found[room:]
    if len(rest):
        worst = rest[np.argmax(measure[rest])]
        found = np.append(found[:room], worst)
        findings.add_frames(steps.message.NAME, len(rest) - 1)
    for step, order in zip(found.tolist(), steps.before(found).tolist(), strict=True):
        findings.add(_occurrence(steps, step, order, float(measure[step]), text, values))


def _occurrence(
    steps: Steps, step: int, order: int, measure: float, text: Text, values: Mapping[str, Any]
) -> Occurrence:
    """One step, which begins with the frame of that number in the log."""
    message = steps.message
    length, end = float(steps.length[step]), float(steps.time[step])
    return Occurrence(
        subject=Subject(message.SENDER, message.NAME, "", steps.detail(step)),
        start=end - length,
        end=end,
        order=order,
        measure=measure,
        text=text,
        values={**values, "step": length, "periods": length / (message.PERIOD or 1.0)},
    )
