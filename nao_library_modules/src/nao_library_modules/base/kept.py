"""What users have set up in a node and what is there again after the node has died: a small file. No ROS.

It is of one run of the ROS master: what was set up in another is forgotten. A node that ends in order forgets it, too.
"""

from __future__ import annotations

import contextlib
import json
import logging
from pathlib import Path
from typing import Any

from .whole_file import FileTrouble, write_whole

log = logging.getLogger(__name__)


class Kept:
    """The file of one node; `run` is the same in a node that was started again, and in no other run."""

    def __init__(self, path: Path, run: str) -> None:
        self._path = path
        self._run = run
        self._forgotten = False

    def load(self) -> Any:
        """What was kept in this run; None if nothing was, or it cannot be read."""
        try:
            told = json.loads(self._path.read_text(encoding="utf-8"))
            return told["kept"] if told["run"] == self._run else None
        except FileNotFoundError:
            return None
        except (OSError, ValueError, KeyError, TypeError) as error:
            log.warning("what was kept in %s cannot be read: %s", self._path, error)
            return None

    def save(self, value: Any) -> None:
        """Keep a value that JSON has words for, instead of the former one; a full disk is no reason to refuse it."""
        if self._forgotten:
            return
        try:
            write_whole(self._path, json.dumps({"run": self._run, "kept": value}))
        except FileTrouble as error:
            log.warning("if this node dies it will not know what was set up: %s", error)

    def forget(self) -> None:
        """Keep nothing any more, neither what there is nor what the steps of the node's end would save."""
        self._forgotten = True
        with contextlib.suppress(OSError):
            self._path.unlink()
