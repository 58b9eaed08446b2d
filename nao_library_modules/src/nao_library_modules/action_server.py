"""actionlib's SimpleActionServer without its stall between goals."""

from __future__ import annotations

import logging
from typing import Any

import actionlib
import rospy

log = logging.getLogger(__name__)

SHUTDOWN_POLL = 0.1
"""s between two looks whether the node has ended, for nothing wakes the waiting thread then."""


class PromptActionServer(actionlib.SimpleActionServer):
    """Takes up a goal as soon as the one before is over.

    The loop it replaces waits before it looks: a goal that came while the last one was being ended was announced to
    nobody, and lies there for a tenth of a second. This one looks under the lock that announcements are made under.
    Everything else is actionlib's.
    """

    # The name is actionlib's: the constructor starts a thread with it.
    def executeLoop(self) -> None:  # noqa: N802
        """Carry out goals, one after the other, until the server or the node ends."""
        while not rospy.is_shutdown() and not self._terminated():
            with self.execute_condition:
                if not self.is_new_goal_available():
                    self.execute_condition.wait(SHUTDOWN_POLL)
                    continue
            self._carry_out(self.accept_new_goal())

    def _terminated(self) -> bool:
        with self.terminate_mutex:
            return self.need_to_terminate

    def _carry_out(self, goal: Any) -> None:
        try:
            self.execute_callback(goal)
            problem = "no end state was set"
        except Exception as error:
            log.exception("a goal failed")
            problem = f"unexpected error: {error!r}"
        if self.is_active():
            self.set_aborted(None, problem)
