"""The rosbag of a trial: a process of its own, which goes on when the console is killed.

It is the recorder itself, not the program `rosbag` around it: where signals were ignored when that one began, as in the
background of a shell, a signal ends it with an error before the recorder has closed its file.
"""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from naoqi.errors import NaoError

from ...ros.master_api import GONE, Api, Refused
from ..robots.waits import within

LONGEST = "4h"
"""Of a bag whose console does not come back."""
BAG_LIMIT = 30.0
"""s of this computer that the recorder has for its end."""
BEGIN_LIMIT = 15.0
"""s of this computer that it has until it reads all topics."""
SETTLED = 1.0
"""s of this computer without a new connection, behind which a publisher that is still missing counts as dead."""
ACTIVE = ".active"
"""End of the name of a bag that is not whole yet."""
CALLER, NODE = "/nao_study", "/nao_study_bag"


class BagRecorder:
    """Records topics into a file.

    `file`: the bag. `topics`: full names. `log`: where the recorder writes what it has to say. Raises NaoError if there
    is no recorder.
    """

    def __init__(self, file: Path, topics: Sequence[str], log: Path) -> None:
        self.file, self.topics = file, tuple(topics)
        self._node = f"{NODE}_{os.getpid()}_{time.monotonic_ns()}"
        self._connections: Counter[str] = Counter()
        self._changed = 0.0
        command = [_program(), "--lz4", "--duration", LONGEST, "-O", str(file), *topics, f"__name:={self._node[1:]}"]
        environment = {name: value for name, value in os.environ.items() if name != "ROS_NAMESPACE"}
        with log.open("ab") as output:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=output,
                env=environment,
                start_new_session=True,  # neither Ctrl-C nor the end of the console ends it
            )

    @property
    def pid(self) -> int:
        """Of its process."""
        return self._process.pid

    def wait_until_it_records(self) -> None:
        """Wait until it has a file and is connected to those who publish its topics.

        Raises NaoError if it ends before, or that takes too long.
        """
        missing = list(self.topics)

        def records() -> bool:
            if self._process.poll() is not None:
                raise NaoError("rosbag has ended at once: see rosbag.log")
            if not self.file.with_name(self.file.name + ACTIVE).exists():
                return False
            missing[:] = self._missing()
            return not missing

        if not within(BEGIN_LIMIT, records):
            what = f"does not read {', '.join(missing)}"
            raise NaoError(f"rosbag {what} after {BEGIN_LIMIT:g} s: what comes before is missing in the bag")

    def wait_for_end(self) -> None:
        """Wait until its process is over. Raises NaoError if that takes too long."""
        try:
            self._process.wait(BAG_LIMIT)
        except subprocess.TimeoutExpired:
            raise NaoError(f"rosbag (process {self.pid}) has not ended within {BAG_LIMIT:g} s") from None

    def _missing(self) -> list[str]:
        """Topics that somebody publishes and that it does not get yet."""
        import rosgraph

        master = Api(rosgraph.get_master_uri(), CALLER)
        try:
            publishers = {topic: len(nodes) for topic, nodes in master.ask("getSystemState")[0]}
            links = Api(master.ask("lookupNode", self._node), CALLER).ask("getBusInfo")
        except (Refused, *GONE):
            return list(self.topics)
        found = Counter(link[4] for link in links if link[2] == "i" and link[5])
        if found != self._connections:
            self._connections, self._changed = found, time.monotonic()
        most = 1 if time.monotonic() > self._changed + SETTLED else max(publishers.values(), default=0)
        return [topic for topic in self.topics if found[topic] < min(most, publishers.get(topic, 0))]


def is_bag(file: Path, about: Mapping[str, Any]) -> bool:
    """Whether the process that was noted records into a file: other programs may have had its number since."""
    try:
        arguments = Path(f"/proc/{int(about['pid'])}/cmdline").read_bytes().split(b"\0")
    except (OSError, KeyError, ValueError):
        return False
    wanted = os.path.realpath(os.fsencode(file))
    return b"-O" in arguments and any(os.path.realpath(each) == wanted for each in arguments if each)


def end_bag(file: Path, about: Mapping[str, Any], recorder: BagRecorder | None = None) -> None:
    """End a recording, and wait until its file is whole.

    `recorder`: it, if this program began it. Raises NaoError if it does not end, or has left no whole file.
    """
    if is_bag(file, about):
        os.kill(int(about["pid"]), signal.SIGINT)
    if recorder is not None and recorder.pid == about["pid"]:
        recorder.wait_for_end()
    elif not within(BAG_LIMIT, lambda: not is_bag(file, about)):
        raise NaoError(f"rosbag (process {about['pid']}) has not ended within {BAG_LIMIT:g} s")
    if not file.exists():
        raise NaoError("rosbag left no whole file: see rosbag.log")


def _program() -> str:
    from roslib.packages import find_node

    found = find_node("rosbag", "record")
    if not found:
        raise NaoError("rosbag is not installed: apt install ros-noetic-rosbag, or rosbag of your system")
    return str(found[0])
