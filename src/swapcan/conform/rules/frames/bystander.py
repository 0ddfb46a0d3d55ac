"""Whom findings are noted for that are nobody's fault."""

from __future__ import annotations

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.findings import Findings


def bystander(findings: Findings) -> str:
    """The first of the nodes that are judged."""
    return next(node for node in PROTOCOL.nodes if node in findings.nodes)
