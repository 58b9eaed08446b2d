"""What can be wrong with a study, beside its files: those are ConsoleFileError."""

from __future__ import annotations

from naoqi.errors import NaoError


class StudyError(NaoError):
    """A study or a trial cannot be done, or what it has left cannot be read."""
