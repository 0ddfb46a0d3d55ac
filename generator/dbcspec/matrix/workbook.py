"""A workbook's bytes made the same on every machine, at every time, under every library build."""

from __future__ import annotations

import io
import xml.etree.ElementTree as ET
import zipfile

from openpyxl import Workbook

_DECLARATION = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
_FIRST_TIME = (1980, 1, 1, 0, 0, 0)
_CORE = (
    '<cp:coreProperties xmlns:cp="http://schemas.openxmlformats.org/package/2006/metadata/'
    'core-properties"></cp:coreProperties>'
)
_APP = (
    '<Properties xmlns="http://schemas.openxmlformats.org/officeDocument/2006/'
    'extended-properties"></Properties>'
)
_FIXED = {"docProps/core.xml": _CORE, "docProps/app.xml": _APP}


def workbook_bytes(book: Workbook) -> bytes:
    """Save a workbook as the same bytes for the same content.

    Times, program names and versions are left out. The XML is put in canonical form, because the
    library writes it differently with and without lxml, and is stored uncompressed, because
    compressors differ between systems.
    """
    saved = io.BytesIO()
    book.save(saved)
    made = io.BytesIO()
    with zipfile.ZipFile(saved) as source, zipfile.ZipFile(made, "w") as target:
        for name in sorted(source.namelist(), key=lambda part: (part[0] != "[", part)):
            text = _FIXED.get(name) or ET.canonicalize(source.read(name).decode("utf-8"))
            entry = zipfile.ZipInfo(name, _FIRST_TIME)
            entry.create_system = 0
            entry.external_attr = 0
            target.writestr(entry, (_DECLARATION + text).encode("utf-8"))
    return made.getvalue()
