"""actionlib's SimpleActionClient, which learns of the end of every goal."""

from __future__ import annotations

import threading
from typing import Any

import actionlib


class SimpleActionClient(actionlib.SimpleActionClient):
    """As actionlib's, for goals that may be over within milliseconds.

    actionlib's notes which goal it sent after it has sent it. What the server says before that is taken for news of
    another goal and dropped (ros/actionlib #206): on a busy computer, the end of one goal in a thousand that only asks
    for a value. Then `wait_for_result` waits for ever, or up to its limit.

    The servers of this library end no goal so soon (`~soonest_end`, 5 ms; docs/functions.md), so actionlib's own client
    with a limit does for them. This one is for servers of others, and for whoever sets `~soonest_end` to 0 because
    goals shall take no longer than they must. It looks at news when the goal is noted, and says nothing of news of the
    goal before.
    """

    def __init__(self, name: str, action: type) -> None:
        self._sending = threading.RLock()
        super().__init__(name, action)

    def send_goal(self, *arguments: Any, **options: Any) -> None:
        """Send a goal, and forget about the one before; arguments as actionlib's."""
        with self._sending:
            super().send_goal(*arguments, **options)

    # The names are actionlib's: it calls them in the threads of its topics.

    def _handle_transition(self, gh: Any) -> None:
        if self._is_of_this_goal(gh):
            super()._handle_transition(gh)

    def _handle_feedback(self, gh: Any, feedback: Any) -> None:
        if self._is_of_this_goal(gh):
            super()._handle_feedback(gh, feedback)

    def _is_of_this_goal(self, gh: Any) -> bool:
        with self._sending:  # not during what follows: a callback may wait for who sends
            return gh == self.gh
