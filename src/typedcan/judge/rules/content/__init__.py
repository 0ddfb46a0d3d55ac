"""What single signals say: codes and ranges."""

from __future__ import annotations

from typedcan.judge.rule import Rule
from typedcan.judge.rules.content import code_defined, code_reserved, invalid_lasting, value_range
from typedcan.judge.scope import Scope
from typedcan.wire.protocol import Protocol


def rules(protocol: Protocol, scope: Scope) -> tuple[Rule, ...]:
    """Those of a protocol, in the order of reports."""
    return (
        code_defined.rule(protocol, scope),
        value_range.rule(protocol),
        code_reserved.rule(protocol, scope),
        invalid_lasting.rule(protocol, scope),
    )
