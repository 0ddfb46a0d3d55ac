"""Findings as one HTML file that needs no network and no script."""

from __future__ import annotations

from functools import cache

import jinja2

from typedcan.report.item import LEVELS, LINT_LEVELS, Report
from typedcan.report.summary import has_summary, summary_lines
from typedcan.report.texts import (
    MEANINGS,
    WHOLE,
    broken,
    casualties,
    counted,
    details,
    grouped,
    purposes,
)
from typedcan.shell.printing import printable


@cache
def _template() -> jinja2.Template:
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("typedcan.report", "templates"),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=True,
    )
    environment.filters["printable"] = printable
    return environment.get_template("report.html.j2")


def to_html(report: Report) -> str:
    """A page for phone, desktop and paper, light and dark, every text of it escaped.

    Boxes that hide the findings of a level work by style sheet alone.
    """
    return _template().render(
        report=report,
        groups=grouped(report.items),
        counts=report.counts(),
        levels=LEVELS,
        meanings=MEANINGS,
        whole=WHOLE,
        counted=counted(report),
        casualties=casualties(report),
        broken=broken,
        details=details,
        purposes=purposes(report),
        summary=summary_lines(report) if has_summary(report) else [],
        promised=lambda item: item.level not in LINT_LEVELS,
    )
