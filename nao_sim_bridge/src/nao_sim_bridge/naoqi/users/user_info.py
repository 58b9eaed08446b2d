"""ALUserInfo of the simulated robot: what programs keep about users."""

from __future__ import annotations

from typing import Any, Callable

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.users.book import NOBODY
from nao_sim_bridge.naoqi.users.users import TYPES, Users, nobody_focused

OWN = "com.aldebaran.userinfo"
"""The domain of the robot itself: programs read it."""
EDITED, REMOVED = "userInfoEdited", "userInfoRemoved"


class ALUserInfo:
    """ALUserInfo as the simulated robot offers it: texts, whole numbers and truth values by domain, user and name.

    Without the number of a user the one counts whom the robot looks at, without a domain that of the robot.
    """

    def __init__(self, users: Users, signals: Callable[..., None]) -> None:
        self._users = users
        self._signals = signals

    def get(self, *where: Any) -> Any:
        domain, number, name = self._place(where)
        return self._values(domain, number).get(name)

    def has(self, *where: Any) -> bool:
        domain, number, name = self._place(where)
        return name in self._values(domain, number)

    def set(self, domain: str, *rest: Any) -> bool:
        *number, name, value = rest
        user = self._user(number)
        self._users.put(_writable(domain), user, name, value)
        self._signals(EDITED, user, name, value)
        return True

    def remove(self, domain: str, *rest: Any) -> bool:
        *number, name = rest
        user = self._user(number)
        return self._tell_removed(user, self._users.drop(_writable(domain), user, name))

    def removeUser(self, domain: str, *number: int) -> bool:
        user = self._user(list(number))
        return self._tell_removed(user, self._users.drop(_writable(domain), user))

    def getType(self, domain: str, name: str) -> str:
        """Of the user whom the robot looks at, or else of the first who has it."""
        focused, numbers = self._users.ask(lambda book: (book.focused, book.numbers))
        for number in sorted(numbers, key=lambda one: one != focused):
            values = self._values(domain, number)
            if name in values:
                return TYPES[type(values[name])]
        raise UnknownName(f"data of users in {domain!r}", name, ())

    def _tell_removed(self, user: int, names: list[str]) -> bool:
        for name in names:
            self._signals(REMOVED, user, name)
        return bool(names)

    def _place(self, where: tuple[Any, ...]) -> tuple[str, int, str]:
        """Domain, user and name, of which the first two may be left out."""
        *before, name = where
        domain = before.pop(0) if before and isinstance(before[0], str) else OWN
        return domain, self._user(before), name

    def _user(self, given: list[int]) -> int:
        number = given[0] if given else self._users.ask(lambda book: book.focused)
        if number == NOBODY:
            raise nobody_focused()
        return number

    def _values(self, domain: str, number: int) -> dict[str, Any]:
        if domain != OWN:
            return self._users.values(domain, number)
        name = self._users.ask(lambda book: book.user(number).name)
        return {"name": name} if name else {}


def _writable(domain: str) -> str:
    if domain == OWN:
        raise NaoqiError(f"{OWN} is the robot's own, of the faces that it has learnt: use a domain of your program")
    return domain
