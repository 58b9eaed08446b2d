"""A ROS master for as long as a program needs it, on a port that the system gives it when it begins to listen."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from naoqi.errors import NaoError

from .supervisor import WITH_ITS_PARENT

if TYPE_CHECKING:
    from rosmaster.master import Master

LOOK_PERIOD = 0.1
"""s between two looks whether the master has been told to end."""


class MasterFailed(NaoError):
    """A ROS master did not come up."""


class OwnMaster:
    """A ROS master in a process of its own, which ends with this one. It answers from the start on.

    Attributes:
        uri: What nodes have in ROS_MASTER_URI.

    Args:
        log: File for its output.

    Raises:
        MasterFailed: It ended before it listened.
    """

    def __init__(self, log: Path) -> None:
        command = [*WITH_ITS_PARENT, sys.executable, "-m", __name__]
        with log.open("wb") as output:
            self._process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=output, text=True
            )
        assert self._process.stdout is not None
        with self._process.stdout as told:
            self.uri = told.readline().strip()
        if not self.uri:
            status = self._process.wait()
            words = log.read_text(encoding="utf-8", errors="replace").strip().rpartition("\n")[2]
            raise MasterFailed(f"the ROS master has ended with exit status {status}: {words or 'it printed nothing'}")

    @property
    def pid(self) -> int:
        return self._process.pid

    def alive(self) -> bool:
        return self._process.poll() is None

    def stop(self) -> None:
        self._process.terminate()
        self._process.wait()

    def __enter__(self) -> OwnMaster:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()


def serve_master() -> tuple[Master, str]:
    """Start a ROS master in threads of this process, on a port that the system gives; the master and its URI."""
    from rosmaster.master import Master

    master = Master(port=0)
    master.start()  # returns when it listens
    return master, f"http://127.0.0.1:{master.master_node.port}"


def main() -> None:
    """Serve a master until the process is told to end; its URI is the one line on standard output."""
    master, uri = serve_master()
    print(uri, flush=True)
    while master.ok():
        time.sleep(LOOK_PERIOD)


if __name__ == "__main__":
    main()
