"""What users have set up in a node and what is there again after the node has died: a small file. No ROS.

It is of one run of the ROS master: what was set up in another is forgotten. A node that ends in order forgets it, too.
"""

from __future__ import annotations

import contextlib
import json
import logging
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from naoqi.errors import NaoError

from .whole_file import FileTrouble, put_aside, write_whole

UNUSABLE = (NaoError, OSError, ValueError, TypeError, LookupError, ArithmeticError, AttributeError, RecursionError)
"""What reading a file of anything may raise."""
log = logging.getLogger(__name__)
Read = TypeVar("Read")


class Kept:
    """The file of one node; `run` is the same in a node that was started again, and in no other run."""

    def __init__(self, path: Path, run: str) -> None:
        self._path = path
        self._run = run
        self._forgotten = False

    def load(self, read: Callable[[Any], Read]) -> Read | None:
        """What `read` makes of what was kept in this run; None if nothing was.

        A file that cannot be used is put aside, and nothing was kept.

        Args:
            read: Raises any of `UNUSABLE` where the value is not one that was saved.
        """
        try:
            told = json.loads(self._path.read_text(encoding="utf-8"))
            _encoded(told)
            return read(told["kept"]) if told["run"] == self._run else None
        except FileNotFoundError:
            return None
        except UNUSABLE as error:
            put_aside(self._path, error, "this node begins without what was set up")
            return None

    def save(self, value: Any) -> None:
        """Keep a value that JSON has words for, instead of the former one; a full disk is no reason to refuse it."""
        if self._forgotten:
            return
        try:
            write_whole(self._path, _encoded({"run": self._run, "kept": value}))
        except (FileTrouble, ValueError, RecursionError) as error:
            log.warning("if this node dies it will not know what was set up: %s", error)

    def forget(self) -> None:
        """Keep nothing any more, neither what there is nor what the steps of the node's end would save."""
        self._forgotten = True
        with contextlib.suppress(OSError):
            self._path.unlink()


def _encoded(value: Any) -> bytes:
    """The bytes of a file; a ValueError for numbers that are not finite and halves of characters."""
    return json.dumps(value, ensure_ascii=False, allow_nan=False).encode()
