"""The rules that hold for any protocol, made from its model."""

from __future__ import annotations

from typedcan.judge.rule import Rule
from typedcan.judge.rules import content, frames, protection, requests, timing, transfers
from typedcan.judge.scope import Scope
from typedcan.wire.protocol import Protocol

_ALL = Scope()


def rules_for(protocol: Protocol, scope: Scope = _ALL) -> tuple[Rule, ...]:
    """The rules that a protocol can be judged by, in the order of reports.

    Those that judge nobody, such as that of checksums where none has one, are left out.

    Parameters
    ----------
    scope
        What has to be known beyond its model.
    """
    every = (
        *frames.rules(protocol),
        *protection.rules(protocol, scope),
        *timing.rules(protocol, scope),
        *content.rules(protocol, scope),
        *requests.rules(protocol),
        *transfers.rules(protocol, scope),
    )
    return tuple(rule for rule in every if rule.judges)
