"""Why an edit, a press or a text is refused.

NaoError                 (naoqi.errors)
    EditConflict         the file has changed on the disk since it was read
    PressRefused         a button or a text is not sent; the text tells why

What is wrong with the file itself is a `files.yaml_file.ConsoleFileError`.
"""

from __future__ import annotations

from pathlib import Path

from naoqi.errors import NaoError


class EditConflict(NaoError):
    """The file has changed on the disk since its text was read."""

    def __init__(self, path: Path) -> None:
        super().__init__(f"{path} has changed on the disk since you opened it: load it again, or save over it")
        self.path = path


class PressRefused(NaoError):
    """A button or a text is not sent to the robot."""
