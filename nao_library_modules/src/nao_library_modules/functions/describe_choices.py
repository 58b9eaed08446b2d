"""Words that only the robot knows: names of its lights, joints, postures, voices. Asked once for each connection."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT

from ..base.once_per_connection import OncePerConnection
from ..nao.light_names import plain_words
from .fields import Question

log = logging.getLogger(__name__)


LIGHTS: Sequence[Question] = (("ALLeds", "listGroups"), ("ALLeds", "listLEDs"))
JOINTS: Sequence[Question] = (("ALMotion", "getBodyNames", "Chains"), ("ALMotion", "getBodyNames", "Body"))
POSTURES: Sequence[Question] = (("ALRobotPosture", "getPostureList"),)
VOICES: Sequence[Question] = (("ALTextToSpeech", "getAvailableVoices"),)
LANGUAGES: Sequence[Question] = (("ALTextToSpeech", "getAvailableLanguages"),)
HEARD_LANGUAGES: Sequence[Question] = (("ALSpeechRecognition", "getAvailableLanguages"),)


class Choices:
    """What one robot answers. Any thread may ask."""

    def __init__(self, robot: Any, own: Callable[[str, str], Sequence[str]]) -> None:
        """Ask nothing yet.

        `robot`: proxies and connection. `own`: function, field -> words that the module itself knows.
        """
        self._own = own
        self._robot = robot
        self._lock = threading.Lock()
        # Answers by the question's text: arguments may be lists.
        self._known: OncePerConnection[dict[str, tuple[str, ...]]] = OncePerConnection(robot, dict)

    def of(self, function: str, field: str, asked: Sequence[Question]) -> tuple[str, ...]:
        """Words that a field of a function may hold; none where nobody has a say or the robot cannot be asked.

        `field`: the name of the field. `asked`: what the field declares to ask the robot.
        """
        own = self._own(function, field)
        if own:
            return tuple(own)
        if not asked or self._robot.connection.state != "connected" or self._robot.connection.silent:
            return ()
        told = [word for question in asked for word in self._answer(question)]
        words = plain_words(told) if asked is LIGHTS else []
        return tuple(dict.fromkeys([*told, *words]))

    def _answer(self, question: Question) -> tuple[str, ...]:
        with self._lock:
            known, key = self._known(), repr(question)
            if key not in known:
                module, method, *arguments = question
                try:
                    answer = self._robot.proxy(module).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)
                except NaoError as error:
                    log.debug("%s.%s cannot be asked: %s", module, method, error)
                    return ()
                known[key] = tuple(map(str, answer))
            return known[key]
