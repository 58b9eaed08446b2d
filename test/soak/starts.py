#!/usr/bin/env python3
"""Starts two whole stacks side by side, again and again, on a busy computer whose ports come and go: all come up.

Beside them run processes that only compute, and others that open and close thousands of sockets. Each stack is up when
all its servers are there and a goal has reached the robot. A line of JSON a start goes to the standard output, and one
at the end; the exit status is 1 if a stack did not come up. All that was started ends with this program.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from pathlib import Path

import rosgraph

from nao_library_modules.core.processes import WITH_ITS_PARENT
from nao_library_modules.core.server_types import ACTIONS, servers_among
from nao_library_modules.ros.own_stack import OwnStack, StackFailed

COMPUTES = "while True: pass"
SOCKETS = """
import socket, time
while True:
    listeners = [socket.create_server(("127.0.0.1", 0)) for _ in range(100)]
    connections = [socket.create_connection(one.getsockname()) for one in listeners]
    accepted = [one.accept()[0] for one in listeners]
    for one in (*connections, *accepted, *listeners):
        one.close()
    time.sleep({pause})
"""
SIDE_BY_SIDE = 2
GOAL = ("nao", "leds", "FaceLeds", "green")
LIMIT = 300.0
"""s that a stack may take: this is about whether it comes up, on a computer that has much else to do."""


@contextmanager
def load(busy: int, sockets: int, pause: float):
    """Processes that compute, and that open and close sockets, until the context ends."""
    programs = [*[COMPUTES] * busy, *[SOCKETS.format(pause=pause)] * sockets]
    started = [subprocess.Popen([*WITH_ITS_PARENT, sys.executable, "-c", program]) for program in programs]
    try:
        yield
        ended = [one.args[-1] for one in started if one.poll() is not None]
        if ended:
            raise RuntimeError(f"a process of the load has ended by itself: {ended[0]}")
    finally:
        for one in started:
            one.kill()
            one.wait()


def start_one(folder: Path) -> dict[str, object]:
    """Start a stack and end it; what came of it."""
    began = time.monotonic()
    record: dict[str, object] = {"up": False}
    try:
        with OwnStack(folder / "stack.txt", {"record_dir": str(folder / "records")}) as stack:
            stack.wait_for_robot(LIMIT)
            record["robot"] = round(time.monotonic() - began, 1)
            master = rosgraph.Master("/starts", stack.master_uri)
            stack.wait_until(lambda: all_servers(master), "all servers", LIMIT)
            environment = {**os.environ, "ROS_MASTER_URI": stack.master_uri}
            done = subprocess.run(GOAL, env=environment, capture_output=True, text=True, timeout=LIMIT)
            stack.check()
            record.update(up=done.returncode == 0, all=round(time.monotonic() - began, 1), told=done.stderr.strip())
    except (StackFailed, subprocess.TimeoutExpired) as error:
        record["told"] = str(error)
    return record


def all_servers(master: rosgraph.Master) -> bool:
    """Whether the master knows all servers."""
    services = [name for name, _ in master.getSystemState()[2]]
    return len(servers_among(services)) == len(ACTIONS)


def main() -> int:
    """Start them; the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--starts", type=int, default=200, help="of two stacks each (default: %(default)s)")
    parser.add_argument("--busy", type=int, default=4, help="processes that only compute (default: %(default)s)")
    parser.add_argument("--sockets", type=int, default=2, help="that open and close sockets (default: %(default)s)")
    parser.add_argument("--pause", type=float, default=1.0, help="of these between two hundreds, s (%(default)s)")
    parser.add_argument("--output", type=Path, help="folder for the logs of the stacks (default: a temporary one)")
    options = parser.parse_args()
    with ExitStack() as held:
        output = options.output or Path(held.enter_context(tempfile.TemporaryDirectory(prefix="nao_starts_")))
        held.enter_context(load(options.busy, options.sockets, options.pause))
        stacks = held.enter_context(ThreadPoolExecutor(SIDE_BY_SIDE))
        records = []
        for number in range(options.starts):
            folders = [output / f"{number}_{letter}" for letter in "ab"]
            for folder in folders:
                folder.mkdir(parents=True)
            os.environ.update(dict.fromkeys(("ROS_HOME", "ROS_LOG_DIR"), str(output / "ros")))
            both = list(stacks.map(start_one, folders))
            records += both
            print(json.dumps({"start": number, "stacks": both}), flush=True)
    up = [record for record in records if record["up"]]
    slowest = max((record["all"] for record in up), default=None)
    print(json.dumps({"starts": options.starts, "stacks": len(records), "up": len(up), "slowest": slowest}))
    return int(len(up) < len(records))


if __name__ == "__main__":
    sys.exit(main())
