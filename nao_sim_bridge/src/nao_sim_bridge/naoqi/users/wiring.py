"""ALUserSession and ALUserInfo put together; nothing is made until one is called, a face learnt or a human tracked."""

from __future__ import annotations

import threading
from typing import Any

from nao_sim_bridge.base.imports import imported
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.later import Later
from nao_sim_bridge.naoqi.binding.signals import Signals
from nao_sim_bridge.naoqi.life.awareness import NOBODY, TRACKED
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.system.time_zone import TimeZone
from nao_sim_bridge.naoqi.vision.face_detection_people import KnownPeople

_LISTS = "createdUsers deletedUsers openedSessions closedSessions addedPermanentUsers removedPermanentUsers".split()
SESSION_SIGNALS = {**dict.fromkeys(_LISTS, "([i])"), "focusedUser": "(i)", "noOpenSession": "(b)"}
INFO_SIGNALS = {"userInfoEdited": "(ism)", "userInfoRemoved": "(is)"}


class UserModules:
    """ALUserSession and ALUserInfo of one robot."""

    def __init__(
        self, simulation: Simulation, memory: MemoryStore, files: ClientFiles, zone: TimeZone, people: KnownPeople
    ) -> None:
        self._lock = threading.Lock()
        self._users: Any = None
        self._of = (simulation, memory, files, zone, people)
        self._session_signals, self._info_signals = Signals(SESSION_SIGNALS), Signals(INFO_SIGNALS)
        self.modules = {
            "ALUserSession": Later(self._session, self._session_signals),
            "ALUserInfo": Later(self._info, self._info_signals),
        }
        memory.listen(TRACKED, self._track, declare=False)
        people.changed.append(self._made)

    def close(self) -> None:
        """Returns when what is known of users is in the files."""
        if self._users is not None:
            self._users.close()

    def _session(self) -> list[Any]:
        return [imported("naoqi.users.user_session:ALUserSession")(self._made())]

    def _info(self) -> list[Any]:
        return [imported("naoqi.users.user_info:ALUserInfo")(self._made(), self._info_signals)]

    def _track(self, face: int) -> None:
        if face != NOBODY or self._users is not None:
            self._made().track(face)

    def _made(self) -> Any:
        with self._lock:
            if self._users is None:
                self._users = imported("naoqi.users.users:Users")(*self._of, self._session_signals)
            return self._users
