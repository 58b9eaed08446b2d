"""A trial whose program is gone: something can be added to its log without running it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any

from ..robots.events import ConsoleEvent
from .log import TrialLog
from .state import TRIAL, TrialState


class LeftTrial:
    """What its recordings need of it.

    Args:
        trial: Its id.
        trial_log: Opened.
        events: Of the log so far.
        robot: The `RobotClient`; None: there is none, and events have the time of the last one.
    """

    def __init__(self, trial: str, trial_log: TrialLog, events: Iterable[Mapping[str, Any]], robot: Any = None) -> None:
        known = list(events)
        self.id, self.robot = trial, robot
        self.state = TrialState.of(known)
        self._log = trial_log
        self._namespace = str(known[-1].get("robot", "")) if known else ""
        self._stamp = float(known[-1].get("stamp") or 0.0) if known else 0.0

    def tell(self, what: str, text: str, by: str = "", **more: Any) -> None:
        """Add an event of the trial; its state follows."""
        self._add(TRIAL, text, by, {**more, "trial": self.id, "what": what})

    def deviation(self, text: str, by: str = "") -> None:
        """Mark that something was not as the protocol has it."""
        self._add("deviation", text, by, {"trial": self.id, "path": self.state.path})

    def _add(self, kind: str, text: str, by: str, data: Mapping[str, Any]) -> None:
        stamp = self._stamp if self.robot is None else self.robot.now()
        self.state.apply(self._log.add(asdict(ConsoleEvent(stamp, kind, self._namespace, text, by, data))))
