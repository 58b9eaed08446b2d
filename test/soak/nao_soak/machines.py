"""Where servers and robot run: on two machines out of network namespaces, or on this one where they cannot be made."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from typing import Any, Union

from named_port import named_port

CABLE = "to_robot"
INSIDE = "NAO_SOAK_INSIDE"
READY_LIMIT = 10.0


def machines() -> Machines:
    """Two machines if they can be made, this process on the first of them: the program starts anew there."""
    if os.environ.get(INSIDE):
        return TwoMachines()
    try:
        trial = ["unshare", "--net", "ip", "link", "add", "name", CABLE, "type", "veth", "peer", "name", "other_end"]
        tried = subprocess.run(trial, capture_output=True, text=True, check=False)
        failure = tried.stderr.strip() if tried.returncode else ""
    except OSError as error:
        failure = str(error)
    if failure:
        print(f"on one machine, as network namespaces cannot be made ({failure}); root may, with unshare and ip")
        return OneMachine()
    os.environ[INSIDE] = "1"
    os.execvp("unshare", ["unshare", "--net", sys.executable, *sys.argv])


class OneMachine:
    """This machine for both; a context. For want of a cable the robot stops: it is there, but nothing comes from it."""

    here = robot = "127.0.0.1"

    def __enter__(self) -> OneMachine:
        """Choose ports: the simulator that was killed has its own again."""
        self.ros_port, self.nao_port = named_port(0), named_port(1)
        return self

    def __exit__(self, *_: Any) -> None:
        """Nothing is left."""

    def on_robot(self, command: Sequence[str]) -> list[str]:
        """The command that runs `command` where the robot is."""
        return list(command)

    def pull_the_cable(self, robot: int) -> None:
        """Let nothing come from the robot, a process group, from now on; nobody is told."""
        os.killpg(robot, signal.SIGSTOP)

    def plug_in(self, robot: int) -> None:
        """Let it go on."""
        os.killpg(robot, signal.SIGCONT)


class TwoMachines:
    """The other machine and the cable; a context. What runs on the other machine is ended by who started it.

    Both machines are gone when the last process on them has ended.
    """

    here, robot = "10.77.0.1", "10.77.0.2"
    ros_port, nao_port = 11311, 9559

    def __enter__(self) -> TwoMachines:
        """Make the other machine and connect it."""
        self._holder = subprocess.Popen(["unshare", "--net", "sleep", "infinity"])
        deadline = time.monotonic() + READY_LIMIT
        while os.readlink(f"/proc/{self._holder.pid}/ns/net") == os.readlink("/proc/self/ns/net"):
            if time.monotonic() > deadline:
                raise RuntimeError(f"the second namespace was not there within {READY_LIMIT:g} s")
            time.sleep(0.01)
        _ip("link", "set", "lo", "up")
        _ip("link", "add", "name", CABLE, "type", "veth", "peer", "name", CABLE, "netns", str(self._holder.pid))
        _ip("addr", "add", f"{self.here}/24", "dev", CABLE)
        _ip("link", "set", CABLE, "up")
        for words in (("addr", "add", f"{self.robot}/24", "dev", CABLE), ("link", "set", CABLE, "up"), _LO):
            subprocess.run(self.on_robot(["ip", *words]), check=True)
        return self

    def __exit__(self, *_: Any) -> None:
        """Let go of the other machine."""
        self._holder.kill()
        self._holder.wait()

    def on_robot(self, command: Sequence[str]) -> list[str]:
        """The command that runs `command` on the other machine."""
        return ["nsenter", "--target", str(self._holder.pid), "--net", "--", *command]

    def pull_the_cable(self, _robot: int) -> None:
        """Let nothing through from now on; nobody is told."""
        _ip("link", "set", CABLE, "down")

    def plug_in(self, _robot: int) -> None:
        """Let everything through again."""
        _ip("link", "set", CABLE, "up")


Machines = Union[OneMachine, TwoMachines]
_LO = ("link", "set", "lo", "up")


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True)
