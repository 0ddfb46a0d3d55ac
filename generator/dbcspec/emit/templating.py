"""The one Jinja environment of the emitters."""

from __future__ import annotations

from functools import cache

import jinja2


@cache
def template(name: str) -> jinja2.Template:
    """A template of ``emit/templates``; an undefined name in it is an error."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("dbcspec.emit", "templates"),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )
    return environment.get_template(name)
