"""Voice, language and volume of a text, restored afterwards. No ROS."""

from __future__ import annotations

import logging
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT

from .speech_settings import SpeechSettings

log = logging.getLogger(__name__)

SPEECH = "ALTextToSpeech"
METHODS = {
    "language": ("getLanguage", "setLanguage"),
    "voice": ("getVoice", "setVoice"),
    "volume": ("getVolume", "setVolume"),
}
"""In this order: another language brings another voice with it."""
SAME_VOLUME = 0.005


class BorrowedVoice:
    """Changes how the robot speaks for a while, and restores it.

    Changes that others make meanwhile are left alone. What could not be restored because the robot was lost is restored
    when it is back. Used by one thread at a time.
    """

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._before: dict[str, Any] = {}
        self._ours: dict[str, Any] = {}

    @property
    def owed(self) -> bool:
        return bool(self._before)

    def take(self, settings: SpeechSettings) -> None:
        """Apply the settings that are given; raises NaoError if the robot cannot, and then it speaks as before."""
        if self.owed:
            self._settle()
        wanted = {"language": settings.language, "voice": settings.voice, "volume": settings.volume}
        wanted = {name: value for name, value in wanted.items() if value not in ("", None)}
        if not wanted:
            return
        touched = [name for name in METHODS if name in wanted or (name == "voice" and "language" in wanted)]
        self._before = {name: self._get(name) for name in touched}
        self._ours = dict(self._before)
        try:
            for name in touched:
                if name in wanted and not _same(self._get(name), wanted[name]):
                    self._ask(METHODS[name][1], wanted[name])
                    self._ours = {each: self._get(each) for each in touched}
        except NaoError:
            self._settle()
            raise

    def give_back(self) -> None:
        """Restore the former values; raises NaoError if the robot cannot be asked, and then they are still owed."""
        if not self.owed:
            return
        now = {name: self._get(name) for name in self._before}
        still_ours = [name for name in self._before if _same(now[name], self._ours[name])]
        changed = [name for name in still_ours if not _same(now[name], self._before[name])]
        if "language" in changed and "voice" in still_ours and "voice" not in changed:
            changed.append("voice")
        for name in METHODS:
            if name in changed:
                self._ask(METHODS[name][1], self._before[name])
        self._before, self._ours = {}, {}

    def _settle(self) -> None:
        """Restore what the robot accepts; what it refuses must not keep it silent."""
        try:
            self.give_back()
        except NaoError as error:
            log.warning("the robot keeps the voice that it was given: %s", error)
            self._before, self._ours = {}, {}

    def _get(self, name: str) -> Any:
        return self._ask(METHODS[name][0])

    def _ask(self, method: str, *arguments: Any) -> Any:
        return self._robot.proxy(SPEECH).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, (int, float)) and isinstance(other, (int, float)):
        return abs(one - other) < SAME_VOLUME
    return one == other
