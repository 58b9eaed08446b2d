"""What ALUserSession and ALUserInfo have in common: users, data about them, and who is told of changes."""

from __future__ import annotations

import logging
import threading
from typing import Any, Callable, Iterable, TypeVar

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.whole_file import FileTrouble, put_aside
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.background import Background
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.system.robot_file import WITHOUT, RobotFile
from nao_sim_bridge.naoqi.system.time_zone import TimeZone
from nao_sim_bridge.naoqi.users.book import NOBODY, News, UserBook
from nao_sim_bridge.naoqi.vision import face_detection
from nao_sim_bridge.naoqi.vision.face_detection_people import KnownPeople

USERS_FILE, DATA_FILE = ".local/share/ALUserSession/users.json", ".local/share/ALUserInfo/data.json"
PERIOD = 0.5
"""Between two looks for who has gone, s of simulated time."""
OPEN_SESSIONS = "UserSession/OpenSessions"
EVENTS = {
    News.CREATED: "UserSession/CreatedUsers",
    News.DELETED: "UserSession/DeletedUsers",
    News.OPENED: "UserSession/SessionsOpened",
    News.CLOSED: "UserSession/SessionsClosed",
    News.FOCUSED: "UserSession/FocusedUser",
    News.NOBODY_HERE: "UserSession/NoOpenSessions",
}
SHOULD_EXIT = "UserSession/ShouldExitInteractiveActivity"
SIGNALS = {
    News.CREATED: "createdUsers",
    News.DELETED: "deletedUsers",
    News.OPENED: "openedSessions",
    News.CLOSED: "closedSessions",
    News.KNOWN: "addedPermanentUsers",
    News.UNKNOWN: "removedPermanentUsers",
    News.FOCUSED: "focusedUser",
    News.NOBODY_HERE: "noOpenSession",
}
TYPES = {bool: "bool", int: "int", str: "string"}
"""Of data about users: Python's types -> NAOqi's words."""

Data = dict  # domain -> number of the user as a text -> name -> value
Answer = TypeVar("Answer")
log = logging.getLogger("nao_sim.users")


class Users:
    """Users and data about them, kept in files of the robot as far as they outlast a run. Any thread.

    Basic awareness and face detection say who is here: that counts at once, and a thread of its own writes it. What
    programs keep is in the file before it counts. Nothing that happens waits for a file to be written.
    """

    def __init__(
        self,
        simulation: Simulation,
        memory: MemoryStore,
        files: ClientFiles,
        zone: TimeZone,
        people: KnownPeople,
        signals: Callable[..., None],
    ) -> None:
        self._simulation = simulation
        self._memory = memory
        self._people = people
        self._signals = signals
        self._lock = threading.Lock()  # of the book
        self._writing = threading.Lock()  # of the files, and of `_data`, which is replaced and never changed
        self._learning = threading.Lock()
        self._background = Background()
        self._next_look = 0.0
        self._users_file, self._data_file = RobotFile(files, USERS_FILE), RobotFile(files, DATA_FILE)
        self._book = UserBook(zone.now)
        self._users_file.load(self._book.restore)
        self._kept = self._book.content()
        data = self._data_file.load(_data_of)
        if self._users_file.aside and data:  # whose users are in the other one: they belong together
            put_aside(files.folder / DATA_FILE, f"it is about users of {self._users_file.aside}", WITHOUT)
            data = {}
        self._data: Data = _about(self._book.numbers, data)
        for event in (*EVENTS.values(), SHOULD_EXIT):
            memory.declare_event(event, "ALUserSession")
        memory.put_quietly(OPEN_SESSIONS, [])
        people.changed.append(self._learn)
        memory.listen(face_detection.EVENT, self._see, declare=False)
        simulation.after_tick.append(self._tick)
        self._learn()

    def track(self, face: Any) -> None:
        """Basic awareness follows this face, or nobody (-1); anything else that a client may have raised is ignored."""
        if face != NOBODY and not _is_face(face):
            return
        names = _faces(self._memory.get_many([face_detection.EVENT])[0])
        self._change(lambda book, time: (book.see(names, time), book.track(face, time)))

    def ask(self, question: Callable[[UserBook], Answer]) -> Answer:
        """What `question` answers about the users, who do not change meanwhile."""
        with self._lock:
            return question(self._book)

    def close(self) -> None:
        """Returns when what has changed is in the files, as far as it can be."""
        self._background.in_turn(lambda _: self._save(), "users").result()

    def _save(self) -> None:
        with self._writing:
            try:
                self._write(self._data)
            except (NaoqiError, FileTrouble, ValueError, OSError) as error:
                log.error("what is known of users could not be saved: %s", error)

    # --- data --------------------------------------------------------------------------------------------------------

    @property
    def domains(self) -> list[str]:
        return sorted(self._data)

    def values(self, domain: str, number: int) -> dict[str, Any]:
        """Data about a user in a domain, by name; an UnknownName when there is no such user."""
        self.ask(lambda book: book.user(number))
        return dict(self._data.get(domain, {}).get(str(number), {}))

    def put(self, domain: str, number: int, name: str, value: Any) -> None:
        """Keep something about a user; a BadValue when it is neither a text, nor a whole number, nor true or false."""
        with self._writing:
            values = self.values(domain, number)
            if type(value) not in TYPES:
                raise BadValue("value", value, "a text, a whole number, true or false")
            self._keep(domain, number, {**values, name: value})

    def drop(self, domain: str, number: int, name: str | None = None) -> list[str]:
        """Forget something about a user, or all in a domain; the names of what there was of it."""
        with self._writing:
            values = self.values(domain, number)
            gone = [key for key in values if name in (None, key)]
            if gone:
                self._keep(domain, number, {key: value for key, value in values.items() if key not in gone})
        return gone

    def _keep(self, domain: str, number: int, values: dict[str, Any]) -> None:
        """Have these be the data about a user in a domain; `_writing` is held."""
        self._write({**self._data, domain: {**self._data.get(domain, {}), str(number): values}})

    def _write(self, data: Data) -> None:
        """Have the files hold the users of now and of these data what is about them; `_writing` is held."""
        content, numbers = self.ask(lambda book: (book.content(), book.numbers))
        data = _about(numbers, data)
        if content != self._kept:
            self._users_file.save(content)
            self._kept = content
        if data != self._data:
            self._data_file.save(data)
            self._data = data

    # --- what happens ------------------------------------------------------------------------------------------------

    def _learn(self) -> None:
        with self._learning:  # who has learnt last is heard last
            names = self._people.names
            self._change(lambda book, time: book.learn(names, time))

    def _see(self, value: Any) -> None:
        names = _faces(value)
        self._change(lambda book, time: book.see(names, time))

    def _tick(self, snapshot: Snapshot) -> None:
        if snapshot.time >= self._next_look:
            self._next_look = snapshot.time + PERIOD
            self._change(lambda book, time: book.pass_time(time))

    def _change(self, change: Callable[[UserBook, float], Any]) -> None:
        with self._lock:
            change(self._book, self._simulation.snapshot.time)
            news, sessions = self._book.news(), self._book.open
        if news and self._background.unfinished < 2:  # one that waits for its turn will write this as well
            self._background.in_turn(lambda _: self._save(), "users")
        for kind, value in news:
            if kind in EVENTS:
                self._memory.raise_event(EVENTS[kind], value)
            self._signals(SIGNALS[kind], value)
            if kind is News.NOBODY_HERE:
                self._memory.put_quietly(OPEN_SESSIONS, sessions)
                if value:
                    self._memory.raise_event(SHOULD_EXIT, True)
            elif kind in (News.OPENED, News.CLOSED):
                self._memory.put_quietly(OPEN_SESSIONS, sessions)


def _faces(value: Any) -> dict[int, str]:
    """Name by number of the faces in a value of `FaceDetected`, which clients may have raised with anything."""
    try:
        most = load_sizes().clients.seen_faces  # clients may raise it with any number
        found = [(face[1][0], face[1][2]) for face in value[1][:-1][:most]]  # behind them is what is new about names
    except (TypeError, LookupError):
        return {}
    return {number: name for number, name in found if _is_face(number) and isinstance(name, str)}


def _is_face(number: Any) -> bool:
    return type(number) is int and 0 <= number < 2**31  # what NAOqi's calls can carry


def _data_of(content: dict[str, Any]) -> Data:
    """Data as a file has them; a ValueError for anything else, an AttributeError for what has no entries."""
    for entries in content.values():
        for number, values in entries.items():
            if not number.isdecimal() or any(type(value) not in TYPES for value in values.values()):
                raise ValueError(f"{number!r} has not texts, whole numbers and truth values by name alone")
            if any(type(value) is int and not -(2**63) <= value < 2**64 for value in values.values()):
                raise ValueError(f"{number!r} has a number that NAOqi's calls cannot carry")
    return content


def _about(numbers: Iterable[int], data: Data) -> Data:
    """Data about these users alone, without what is empty."""
    users = set(map(str, numbers))
    left = {domain: {n: v for n, v in entries.items() if n in users and v} for domain, entries in data.items()}
    return {domain: entries for domain, entries in left.items() if entries}


def nobody_focused() -> NaoqiError:
    return NaoqiError("the robot looks at no user: give the userID, one of ALUserSession.getUserList")
