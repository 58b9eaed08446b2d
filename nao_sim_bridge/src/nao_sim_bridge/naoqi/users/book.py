"""Users of the robot, and whose session is open. No libqi; times and dates are passed in."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from datetime import datetime
from enum import Enum
from typing import Any, Callable, Iterable, Mapping, Sequence

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.base.sizes import load_sizes

NOBODY = -1
LARGEST_NUMBER = 2**31 - 1
"""That NAOqi's calls can carry."""
DATES = ("created", "first", "last")
UNSEEN_S = 2.0
"""After so long without being seen, a session is closed, s of simulated time."""
FORGOTTEN_S = 600.0
"""After so long without a session, whoever is not known by name is forgotten, s of simulated time."""


class News(Enum):
    """What changes, with the numbers of users or a truth value."""

    CREATED = "created"
    DELETED = "deleted"
    OPENED = "opened"
    CLOSED = "closed"
    KNOWN = "known"  # permanent from now on
    UNKNOWN = "unknown"  # permanent no more
    FOCUSED = "focused"
    NOBODY_HERE = "nobody here"


@dataclass
class User:
    """Somebody.

    Attributes:
        number: The UserSession ID.
        name: Of the face that has been learnt; empty for who is not permanent.
        created: When the robot has made the user.
        first: When the first session began, None before it; the next ones alike.
        current: When the session began that is open.
        last: When the last session ended.
        away: Simulated time of that, or of the creation, s.
    """

    number: int
    name: str
    created: datetime
    first: datetime | None = None
    current: datetime | None = None
    last: datetime | None = None
    away: float = 0.0

    @property
    def permanent(self) -> bool:
        return bool(self.name)


@dataclass
class _Face:
    """A face that the cameras see, by the number of it: whose it may be, and when it was seen last, s."""

    name: str
    seen: float
    user: int = NOBODY  # whose session is open because of it


class UserBook:
    """Who there is, who is here, and whom the robot looks at. Not thread-safe.

    `date` says what date it is, with the zone.
    """

    def __init__(self, date: Callable[[], datetime]) -> None:
        self.focused = NOBODY
        self._date = date
        self._users: dict[int, User] = {}
        self._next = 1
        self._faces: dict[int, _Face] = {}
        self._news: dict[News, list[int]] = defaultdict(list)
        self._told: tuple[int, bool] = (NOBODY, True)  # who was focused, and whether nobody was here, when it was told

    # --- to and from a file ------------------------------------------------------------------------------------------

    def content(self) -> dict[str, Any]:
        """What outlasts a run: who is known by name."""
        rows = [
            {
                "number": u.number,
                "name": u.name,
                **{d: v.isoformat() for d in DATES if (v := getattr(u, d)) is not None},
            }
            for u in self._users.values()
            if u.permanent
        ]
        return {"next": self._next, "users": rows}

    def restore(self, content: Mapping[str, Any]) -> None:
        """Know whom `content` has told of, and nobody else; nobody where it is empty.

        Raises:
            ValueError: It is not what `content` tells. So do TypeError and LookupError; nothing has changed then.
        """
        users: dict[int, User] = {}
        for row in content["users"] if content else []:
            user = User(_number(row["number"]), row["name"], **_dates(row))
            if not isinstance(user.name, str) or not user.name or user.number in users:
                raise ValueError(f"{row!r} is no user with a name and a number of its own")
            users[user.number] = user
        self._next = max(max([*users, 0]) + 1, _number(content["next"]) if content else 1)
        self._users = users

    # --- who there is ------------------------------------------------------------------------------------------------

    @property
    def numbers(self) -> list[int]:
        return sorted(self._users)

    @property
    def open(self) -> list[int]:
        """Whose session is open."""
        return sorted(user.number for user in self._users.values() if user.current is not None)

    @property
    def permanent(self) -> list[int]:
        return sorted(user.number for user in self._users.values() if user.permanent)

    def user(self, number: int) -> User:
        """An UnknownName when there is no such user."""
        if number not in self._users:
            raise UnknownName("user", number, map(str, self._users))
        return self._users[number]

    def of_name(self, name: str) -> User | None:
        return next((user for user in self._users.values() if name and user.name == name), None)

    def user_of_face(self, face: int) -> int:
        return self._faces[face].user if face in self._faces else NOBODY

    def face_of_user(self, number: int) -> int:
        return next((face for face, entry in self._faces.items() if entry.user == number != NOBODY), NOBODY)

    # --- what happens ------------------------------------------------------------------------------------------------

    def learn(self, names: Sequence[str], time: float) -> None:
        """These are the people whose faces are known. Who is here alone when a face is learnt is its owner."""
        for user in [user for user in self._users.values() if user.permanent and user.name not in names]:
            self._delete(user)
        for name in names:
            if self.of_name(name) is None:
                here = [self._users[number] for number in self.open]
                if len(here) == 1 and not here[0].permanent:
                    here[0].name = name
                    self._news[News.KNOWN].append(here[0].number)
                else:
                    self._create(name, time)

    def see(self, faces: Mapping[int, str], time: float) -> None:
        """A picture shows these faces: number -> name, empty for who is not recognised."""
        for number, name in faces.items():
            face = self._face(number, name, time)
            face.seen, face.name = time, name or face.name
            known = self.of_name(face.name)
            if face.user != NOBODY and known is not None and known.number != face.user:
                was, face.user = face.user, known.number
                if self.focused == was:
                    self.focused = known.number
                self._open(known)
                self._close_unseen([was], time)

    def track(self, face: int, time: float) -> None:
        """The robot looks at this face from now on, or at nobody."""
        if face == NOBODY:
            self.focused = NOBODY
            return
        entry = self._face(face, "", time)
        entry.seen = time
        if entry.user == NOBODY:
            user = self.of_name(entry.name) or self._create("", time)
            entry.user = user.number
            self._open(user)
        self.focused = entry.user

    def pass_time(self, time: float) -> None:
        """Close sessions of those who have not been seen, and forget those who have been away for long."""
        gone = [face for face, entry in self._faces.items() if time - entry.seen > UNSEEN_S]
        users = [self._faces.pop(face).user for face in gone]
        self._close_unseen(users, time)
        for user in list(self._users.values()):
            if not user.permanent and user.current is None and time - user.away > FORGOTTEN_S:
                self._delete(user)

    def news(self) -> list[tuple[News, Any]]:
        """What has changed since this was asked last."""
        found: list[tuple[News, Any]] = [(kind, self._news[kind]) for kind in News if self._news.get(kind)]
        self._news = defaultdict(list)
        focused, nobody = self._told
        if self.focused != focused:
            found.append((News.FOCUSED, self.focused))
        if (not self.open) != nobody:
            found.append((News.NOBODY_HERE, not self.open))
        self._told = (self.focused, not self.open)
        return found

    def _face(self, number: int, name: str, time: float) -> _Face:
        """A face by its number; of too many the one that was not seen for longest is forgotten."""
        if number not in self._faces and len(self._faces) >= load_sizes().clients.seen_faces:
            oldest = min(self._faces, key=lambda one: self._faces[one].seen)
            self._close_unseen([self._faces.pop(oldest).user], time)
        return self._faces.setdefault(number, _Face(name, time))

    def _create(self, name: str, time: float) -> User:
        if len(self._users) >= load_sizes().kept.users:
            away = [user for user in self._users.values() if user.current is None and not user.permanent]
            for user in sorted(away, key=lambda one: one.away)[:1]:
                self._delete(user)
        user = self._users[self._next] = User(self._next, name, self._date(), away=time)
        self._next += 1
        self._news[News.CREATED].append(user.number)
        if name:
            self._news[News.KNOWN].append(user.number)
        return user

    def _open(self, user: User) -> None:
        if user.current is None:
            user.current = self._date()
            user.first = user.first or user.current
            self._news[News.OPENED].append(user.number)

    def _close_unseen(self, numbers: Iterable[int], time: float) -> None:
        """Close the sessions of those of whom no face is seen."""
        for number in numbers:
            user = self._users.get(number)
            if user is not None and user.current is not None and self.face_of_user(number) == NOBODY:
                user.current, user.last, user.away = None, self._date(), time
                self._news[News.CLOSED].append(number)
                if self.focused == number:
                    self.focused = NOBODY

    def _delete(self, user: User) -> None:
        for entry in self._faces.values():
            if entry.user == user.number:
                entry.user, entry.name = NOBODY, ""
        self._close_unseen([user.number], user.away)
        del self._users[user.number]
        self._news[News.DELETED].append(user.number)
        if user.permanent:
            self._news[News.UNKNOWN].append(user.number)


def _number(value: Any) -> int:
    if type(value) is not int or not 1 <= value <= LARGEST_NUMBER:
        raise ValueError(f"{value!r} is no number of a user, 1 to {LARGEST_NUMBER}")
    return value


def _dates(row: Mapping[str, Any]) -> dict[str, datetime]:
    dates = {name: datetime.fromisoformat(row[name]) for name in DATES if name in row}
    if any(date.tzinfo is None for date in dates.values()):
        raise ValueError(f"{row!r} has a date without a zone")
    return dates
