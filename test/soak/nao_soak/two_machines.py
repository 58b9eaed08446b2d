"""Two machines out of network namespaces: this process is on the one, the robot on the other, a cable between them."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Sequence
from typing import Any

HERE, ROBOT = "10.77.0.1", "10.77.0.2"
"""Addresses of the two machines."""
CABLE = "to_robot"
INSIDE = "NAO_SOAK_INSIDE"
READY_LIMIT = 10.0


class NoNamespaces(RuntimeError):
    """Network namespaces cannot be made here."""


def enter() -> None:
    """Start this program anew on a machine of its own; returns when it is there.

    Raises:
        NoNamespaces: It may not.
    """
    if os.environ.get(INSIDE):
        return
    try:
        tried = subprocess.run(["unshare", "--net", "ip", "link"], capture_output=True, text=True, check=False)
    except OSError as error:
        raise NoNamespaces(f"network namespaces need unshare and ip (Debian: util-linux, iproute2): {error}") from error
    if tried.returncode:
        raise NoNamespaces(f"network namespaces cannot be made: {tried.stderr.strip()}; root may")
    os.environ[INSIDE] = "1"
    os.execvp("unshare", ["unshare", "--net", sys.executable, *sys.argv])


class TwoMachines:
    """The other machine and the cable; a context. What runs on the other machine is ended by who started it.

    Both machines are gone when the last process on them has ended.
    """

    def __enter__(self) -> TwoMachines:
        """Make the other machine and connect it."""
        self._holder = subprocess.Popen(["unshare", "--net", "sleep", "infinity"])
        deadline = time.monotonic() + READY_LIMIT
        while os.readlink(f"/proc/{self._holder.pid}/ns/net") == os.readlink("/proc/self/ns/net"):
            if time.monotonic() > deadline:
                raise NoNamespaces(f"the second namespace was not there within {READY_LIMIT:g} s")
            time.sleep(0.01)
        _ip("link", "set", "lo", "up")
        _ip("link", "add", "name", CABLE, "type", "veth", "peer", "name", CABLE, "netns", str(self._holder.pid))
        _ip("addr", "add", f"{HERE}/24", "dev", CABLE)
        _ip("link", "set", CABLE, "up")
        for words in (("addr", "add", f"{ROBOT}/24", "dev", CABLE), ("link", "set", CABLE, "up"), _LO):
            subprocess.run(self.on_robot(["ip", *words]), check=True)
        return self

    def __exit__(self, *_: Any) -> None:
        """Let go of the other machine."""
        self._holder.kill()
        self._holder.wait()

    def on_robot(self, command: Sequence[str]) -> list[str]:
        """The command that runs `command` on the other machine."""
        return ["nsenter", "--target", str(self._holder.pid), "--net", "--", *command]

    def pull_the_cable(self) -> None:
        """Let nothing through from now on; nobody is told."""
        _ip("link", "set", CABLE, "down")

    def plug_in(self) -> None:
        """Let everything through again."""
        _ip("link", "set", CABLE, "up")


_LO = ("link", "set", "lo", "up")


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True)
