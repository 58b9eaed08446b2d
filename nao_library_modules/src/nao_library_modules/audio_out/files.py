"""Files that a chain plays or writes, and sounds that are loaded."""

from __future__ import annotations

from typing import Any

from ..base.errors import BadGoal


class FileNotes:
    """Account of the files that a chain played or wrote.

    Attributes:
        names: Names of the files, in order.
        durations: How long each was to be heard, or of a file that was written, how long it is, s.
    """

    def __init__(self) -> None:
        """Nothing yet."""
        self.names: list[str] = []
        self.durations: list[float] = []

    def note(self, name: str, duration: float) -> None:
        """A file was played or written."""
        self.names.append(name)
        self.durations.append(max(0.0, duration))


class LoadedSounds:
    """Ids of sounds that this server has loaded, by the names of their files; forgotten with the connection."""

    def __init__(self, connection: Any) -> None:
        """Nothing is loaded yet.

        Args:
            connection: The connection to the robot: a new one may lead to a robot that has loaded nothing.
        """
        self._connection = connection
        self._generation: int | None = None
        self._ids: dict[str, int] = {}

    @property
    def names(self) -> list[str]:
        """Names of the loaded files, the last one loaded last."""
        if self._generation != self._connection.generation:
            self._ids.clear()
            self._generation = self._connection.generation
        return list(self._ids)

    def add(self, name: str, number: int) -> None:
        """A file was loaded; of a name that was loaded before, the new id counts."""
        self.remove(name)
        self._ids[name] = number

    def remove(self, name: str) -> None:
        """A file was unloaded."""
        if name in self.names:
            del self._ids[name]

    def clear(self) -> None:
        """All were unloaded."""
        self._ids.clear()

    def number(self, name: str) -> int:
        """Id of a loaded file; of the one loaded last without a name.

        Raises:
            BadGoal: If there is none: the chain was checked, but the robot may have been exchanged since.
        """
        names = self.names
        if not names or (name and name not in names):
            problem = f"{name!r} is not loaded any more" if name else "no sound is loaded any more"
            raise BadGoal("str_param", name, "loadFile comes first", problem=problem)
        return self._ids[name or names[-1]]

    def name(self, number: int) -> str:
        """Name of the loaded file of an id; the id as text if others have loaded it."""
        return next((name for name in self.names if self._ids[name] == number), str(number))
