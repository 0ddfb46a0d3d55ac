"""The spec's own grammar as JSON Schema, so that editors complete and check while one types."""

from __future__ import annotations

import json
from collections.abc import Mapping

from dbcspec.spec.schema import Record, json_schema


def emit_json_schemas(documents: Mapping[str, type[Record]]) -> dict[str, str]:
    """One schema per kind of document, file name to text."""
    return {
        f"{name}.json": json.dumps(
            {
                "$schema": "http://json-schema.org/draft-07/schema#",
                "title": (record.__doc__ or "").strip(),
                **json_schema(record),
            },
            indent=2,
        )
        + "\n"
        for name, record in documents.items()
    }
