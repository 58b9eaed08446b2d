"""Whether the robot has fallen, and whether it should stand: of its posture and its falls. Pure."""

from __future__ import annotations

STANDING, LYING, UNKNOWN = "Standing", "Lying", "Unknown"
"""Families of postures; those of a robot that lies begin with `LYING`."""


class Stance:
    """How a robot stands or lies.

    Attributes:
        family: Of its posture; empty while it is not known.
        fallen: It has fallen and has not stood or sat since.
        stood: The last family that was neither lying nor unknown was `STANDING`.
    """

    def __init__(self) -> None:
        self.family = ""
        self.fallen = self.stood = False
        self._had_fallen = False  # at some time; whether it has got up since is not known yet

    @property
    def lies(self) -> bool:
        return self.family.startswith(LYING)

    def fell(self, news: bool) -> None:
        """The robot's memory reports a fall. `news`: a new one; otherwise the value that an older one has left."""
        if news:
            self.fallen = True
        elif self.family in ("", UNKNOWN):
            self._had_fallen = True
        else:
            self.fallen = self.fallen or self.lies

    def forget_family(self) -> None:
        """The robot is lost; posture and last fall arrive in any order when it is reconnected."""
        self.family, self._had_fallen = "", False

    def take(self, family: str) -> None:
        """The family of its posture."""
        self.family = family
        if self.lies:
            self.fallen = self.fallen or self._had_fallen
        elif family != UNKNOWN:
            self.fallen, self.stood = False, family == STANDING
        else:
            return
        self._had_fallen = False
