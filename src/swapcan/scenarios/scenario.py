"""A scenario: what is done to a pack, by whom, for how long, and how the pack is to react."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from swapcan.nodes.plan import PlannedStep
from typedcan.judge.rule import Rule
from typedcan.model.errors import TypedcanError
from typedcan.report.language import Text
from typedcan.simulate.faults import PlannedFault


class ScenarioError(TypedcanError):
    """A scenario that there is not, or that cannot be played here."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """What is done, apart from the doing.

    Parameters
    ----------
    name, title
        Its name in lower case with hyphens, and what is done in a few words.
    plays
        The nodes without which it makes no sense: those that are played.
    may_play
        Others that may be played beside them.
    plan
        What the nodes do, in seconds since they began; what is for a node that is not played is
        left out.
    faults
        What is wrong with them; a fault of the transmission hits every frame.
    seconds
        How long it lasts, without the time that switching off takes.
    rules
        How the pack is to react: reactions, and rules that every log is judged by too, to which
        the scenario gives something to judge.
    """

    name: str
    title: Text
    plays: tuple[str, ...]
    may_play: tuple[str, ...] = ()
    plan: tuple[PlannedStep, ...]
    faults: tuple[PlannedFault, ...] = ()
    seconds: float
    rules: tuple[Rule, ...]

    def played(self, nodes: Sequence[str] = ()) -> tuple[str, ...]:
        """The nodes that are played where those are asked for; raises `ScenarioError`."""
        for node in nodes:
            if node not in (*self.plays, *self.may_play):
                raise ScenarioError(f"{self.name} does not play {node}")
        for node in self.plays:
            if nodes and node not in nodes:
                raise ScenarioError(f"{self.name} has to play {node}")
        return tuple(nodes) or self.plays

    def steps(self, nodes: Sequence[str]) -> tuple[PlannedStep, ...]:
        """The plan of those nodes."""
        return tuple(step for step in self.plan if step.node in nodes)
