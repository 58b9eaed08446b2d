"""ALUserSession of the simulated robot. Only NAOqi methods live here."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.naoqi.users.users import Users

FACE = "ALFaceDetection"
"""The binding that ties users to what the robot recognises them by: the name of a learnt face."""
DATE_FORMAT = "%Y-%b-%d %H:%M:%S"


class ALUserSession:
    """ALUserSession as the simulated robot offers it.

    Permanent users are the people whose faces ALFaceDetection has learnt; a stranger is a user from when basic
    awareness follows the face until ten minutes after it has gone.
    """

    def __init__(self, users: Users) -> None:
        self._users = users
        self._ask = users.ask

    def doesUserExist(self, number: int) -> bool:
        return self._ask(lambda book: number in book.numbers)

    def doUsersExist(self, numbers: list[int]) -> bool:
        return self._ask(lambda book: set(numbers) <= set(book.numbers))

    def getUserList(self) -> list[int]:
        return self._ask(lambda book: book.numbers)

    def getNumUsers(self) -> int:
        return self._ask(lambda book: len(book.numbers))

    def getFocusedUser(self) -> int:
        return self._ask(lambda book: book.focused)

    def getOpenUserSessions(self) -> list[int]:
        return self._ask(lambda book: book.open)

    def isUserSessionOpen(self, number: int) -> bool:
        return self._ask(lambda book: number in book.open)

    def areUserSessionsOpen(self, numbers: list[int]) -> bool:
        return self._ask(lambda book: set(numbers) <= set(book.open))

    def isUserPermanent(self, number: int) -> bool:
        return self._ask(lambda book: number in book.permanent)

    def areUsersPermanent(self, numbers: list[int]) -> bool:
        return self._ask(lambda book: set(numbers) <= set(book.permanent))

    def getPermanentUserList(self) -> list[int]:
        return self._ask(lambda book: book.permanent)

    def getUsidFromPpid(self, face: int) -> int:
        """The numbers of faces that ALFaceDetection sees stand for those of people."""
        return self._ask(lambda book: book.user_of_face(face))

    def getPpidFromUsid(self, number: int) -> int:
        return self._ask(lambda book: book.face_of_user(number))

    # --- bindings ----------------------------------------------------------------------------------------------------

    def getBindingList(self) -> list[str]:
        return [FACE]

    getBindingSources = getBindingList

    def doesBindingExist(self, name: str) -> bool:
        return name == FACE

    doesBindingSourceExist = doesBindingExist

    def getUserBindings(self, number: int) -> dict[str, str]:
        name = self._ask(lambda book: book.user(number).name)
        return {FACE: name} if name else {}

    def getUserBinding(self, number: int, binding: str) -> str:
        return self.getUserBindings(number).get(_binding(binding), "")

    def findUsersWithBinding(self, binding: str, value: str) -> list[int]:
        _binding(binding)
        found = self._ask(lambda book: book.of_name(value))
        return [] if found is None else [found.number]

    # --- dates -------------------------------------------------------------------------------------------------------

    def getUserCreationDate(self, number: int) -> str:
        return _date(self._ask(lambda book: book.user(number).created))

    def getFirstEncounterDate(self, number: int) -> str:
        return _date(self._ask(lambda book: book.user(number).first))

    def getCurrentEncounterDate(self, number: int) -> str:
        return _date(self._ask(lambda book: book.user(number).current))

    def getLastEncounterDate(self, number: int) -> str:
        return _date(self._ask(lambda book: book.user(number).last))

    def getSecondsSinceLastEncounter(self, number: int) -> int:
        current, last = self._ask(lambda book: (book.user(number).current, book.user(number).last))
        if last is None:
            return -1 if current is None else 0
        return max(0, int((datetime.now(last.tzinfo) - last).total_seconds()))

    # --- data, for programs older than ALUserInfo --------------------------------------------------------------------

    def getUserDataSources(self) -> list[str]:
        """The domains of ALUserInfo."""
        return self._users.domains

    def doesUserDataSourceExist(self, source: str) -> bool:
        return source in self._users.domains

    def getUserData(self, number: int, name: str, source: str | None = None) -> Any:
        """What a source says, None if nothing, or what all say by source; an UnknownName when there is no such user."""
        self._ask(lambda book: book.user(number))
        if source is not None:
            return self._users.values(source, number).get(name)
        found = {domain: self._users.values(domain, number) for domain in self._users.domains}
        return {domain: values[name] for domain, values in found.items() if name in values}

    def setUserData(self, number: int, name: str, source: str, value: Any) -> None:
        self._users.put(source, number, name, value)


def _binding(name: str) -> str:
    if name != FACE:
        raise UnknownName("binding", name, [FACE])
    return name


def _date(date: datetime | None) -> str:
    return "" if date is None else date.strftime(DATE_FORMAT)
