"""Processes below a process, so that none of them outlives it. Linux only: it reads /proc.

roslaunch starts every node in a session of its own: a signal to roslaunch's process group does not reach
them.
"""

from __future__ import annotations

import os
import signal
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class ProcessId:
    """A process; its start, in clock ticks since boot, distinguishes it from a later one with the same number."""

    pid: int
    started: int


def _stat(pid: int) -> list[str]:
    """Fields of /proc/<pid>/stat after the name (which may hold spaces); empty when the process is gone."""
    try:
        text = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return []
    return text[text.rindex(")") + 2 :].split()


def identify(pid: int) -> ProcessId | None:
    """The process with that number, None if there is none or it has ended."""
    fields = _stat(pid)
    if not fields or fields[0] == "Z":
        return None
    return ProcessId(pid, int(fields[19]))


def descendants(pid: int) -> list[ProcessId]:
    """All processes below `pid` that are alive, parents before their children."""
    children: dict[int, list[int]] = {}
    for entry in os.listdir("/proc"):
        if entry.isdigit():
            fields = _stat(int(entry))
            if fields:
                children.setdefault(int(fields[1]), []).append(int(entry))
    found = []
    pending = [pid]
    while pending:
        for child in children.get(pending.pop(0), ()):
            pending.append(child)
            identity = identify(child)
            if identity is not None:
                found.append(identity)
    return found


def kill_survivors(processes: list[ProcessId]) -> list[int]:
    """Kill those of the processes that are still alive; their numbers."""
    killed = []
    for process in processes:
        if identify(process.pid) == process:
            try:
                os.kill(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                continue
            killed.append(process.pid)
    return killed
