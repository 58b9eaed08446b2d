"""Runs a timeline: each entry in a branch of its own, which waits for its time."""

from __future__ import annotations

from typing import Any, Callable

from ...process_modules.language.control import do, par
from ...process_modules.language.flow import sleep, wait_until
from ...process_modules.language.fluents import Fluent
from ..language.program import BarrierNode, Node, OnTimeline, name_of, servers_in
from .report import RunReport


class _Moments:
    """When an entry began and ended, s from the beginning of the behaviour; None until then."""

    def __init__(self, name: str) -> None:
        self.begun = Fluent(f"{name} began", None)
        self.over = Fluent(f"{name} ended", None)


class TimelineRun:
    """One run of a timeline.

    Args:
        report: Its clock counts.
        step: Runs a step: `step(node, due, begun)`.
        zero: When the timeline began, s from the beginning of the behaviour.
    """

    def __init__(self, node: OnTimeline, report: RunReport, step: Callable[..., Any], zero: float) -> None:
        self._entries = node.nodes
        self._report = report
        self._step = step
        self._zero = zero
        self._moments = [_Moments(each.what) for each in node.nodes]
        self._by_name = {name_of(each): m for each, m in zip(node.nodes, self._moments) if name_of(each)}

    def run(self) -> None:
        """Run all entries; over when the last one is."""
        par(*(do(self._entry, i, name=entry.what) for i, entry in enumerate(self._entries)))

    def _entry(self, i: int) -> None:
        entry, moments = self._entries[i], self._moments[i]
        due = self._due(i, entry)
        wait = due - self._report.now()
        if wait > 0.0:
            sleep(wait)
        self._let_go_first(i, entry)

        def begun() -> None:
            if moments.begun.value is None:
                moments.begun.value = self._report.now()

        self._step(entry, due, begun)
        begun()
        moments.over.value = self._report.now()

    def _due(self, i: int, entry: Node) -> float:
        """When an entry is to begin, s from the beginning of the behaviour; waits until that is known."""
        if isinstance(entry, BarrierNode):
            return max(self._known(moments.over) for moments in self._moments[:i])
        if not entry.at.label:
            return self._zero + entry.at.offset
        other = self._by_name[entry.at.label]
        return self._known(other.over if entry.at.of_end else other.begun) + entry.at.offset

    def _let_go_first(self, i: int, entry: Node) -> None:
        """Of entries at the same time that need the same server, those above go first."""
        servers = servers_in(entry)
        for other, moments in zip(self._entries[:i], self._moments):
            if other.at != entry.at or isinstance(other, BarrierNode):
                continue
            if not servers.keys().isdisjoint(servers_in(other)):
                self._known(moments.begun)

    @staticmethod
    def _known(moment: Fluent) -> float:
        wait_until(lambda: moment.value is not None, [moment])
        return float(moment.value)
