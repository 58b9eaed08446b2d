"""Has the robot say texts, without waiting for the end. No ROS."""

from __future__ import annotations

import logging
from typing import Any

from naoqi.errors import NaoError, UnknownModule

log = logging.getLogger(__name__)

SPEECH = "ALTextToSpeech"


class Speaker:
    """Says texts on a robot that can speak; on others it tells in the log what would have been said."""

    def __init__(self, robot: Any) -> None:
        """Keep the robot; it need not be there yet.

        Args:
            robot: Its proxies and connection, see `nao_library_modules.robot`.
        """
        self._robot = robot

    def say(self, text: str) -> None:
        """Begin to say a text."""
        try:
            call = self._robot.proxy(SPEECH).call_async("say", text)
        except UnknownModule:
            log.info("the robot has no %s, so this is not said: %s", SPEECH, text)
            return
        except NaoError as error:
            log.error("%r is not said: %s", text, error)
            return
        call.add_done_callback(lambda ended: _log_failure(ended, text))


def _log_failure(call: Any, text: str) -> None:
    try:
        call.result(timeout=0)
    except NaoError as error:
        log.error("%r was not said: %s", text, error)
