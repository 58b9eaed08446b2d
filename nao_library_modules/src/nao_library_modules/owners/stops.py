"""Stops what has lost its owner: by calls of the robot, goals of servers by their cancellation."""

from __future__ import annotations

import json
import logging
from collections.abc import Mapping
from functools import partial
from typing import Any, Callable

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT, LOST_PATIENCE

from ..nao.joint_names import MOTION
from .watch import Owned

log = logging.getLogger(__name__)


class Stops:
    """Stops things of one robot.

    Args:
        robot: Its proxies and connection.
        elsewhere: Stops what is not the robot's, by its word in the place of a module: `GOAL`, with topic and id,
            `SERVICE`, with its name and that of the node that has died.
    """

    def __init__(self, robot: Any, elsewhere: Mapping[str, Callable[[str, str], None]]) -> None:
        self._robot = robot
        self._elsewhere = elsewhere

    def stop(self, owned: Owned) -> None:
        """Stop something; errors are logged."""
        module, method, arguments = json.loads(owned.cure)
        try:
            if module in self._elsewhere:
                self._elsewhere[module](method, arguments)
            else:
                self._robot.connection.wait_connected(LOST_PATIENCE)
                completed = self._completed(module, method, arguments)
                # Not waited for: a walk ends on both feet, and the next thing is to be stopped meanwhile.
                self._robot.proxy(module).call_async(method, *completed).add_done_callback(partial(_log_failure, owned))
        except NaoError as error:
            log.error("%s has died, and its %s may go on: %s", owned.owner, owned.what, error)
        else:
            log.warning("%s has died: its %s is stopped", owned.owner, owned.what)

    def _completed(self, module: str, method: str, arguments: list[Any]) -> list[Any]:
        """Joints in the place of chains; and the commanded angles, as the new target that ends the former."""
        if module != MOTION or not arguments:
            return arguments
        joints = [joint for name in arguments[0] for joint in self._ask(MOTION, "getBodyNames", name)]
        return [joints, self._ask(MOTION, "getAngles", joints, False), 1.0] if method == "setAngles" else [joints]

    def _ask(self, module: str, method: str, *arguments: Any) -> Any:
        return self._robot.proxy(module).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)


def _log_failure(owned: Owned, call: Any) -> None:
    try:
        call.result(timeout=0)
    except NaoError as error:
        log.error("the %s of %s, which has died, may go on: %s", owned.what, owned.owner, error)
