#!/usr/bin/env python3
"""Runs the rostest scenarios, one process each, and tells how far it is.

Every scenario has its own ROS master, results, logs and NAOqi port (NAO_PORT), so two can run at once. In
RESULTS/<scenario>/ it leaves `status` and JUnit XML files for summarize_tests, `output.txt` and `log/` for
people.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from summarize_tests import TIMED_OUT, Outcome, collect_run, find_scenarios

ROSTEST = (sys.executable, "-c", "import rostest; rostest.rostestmain()")
"""rostest, but with the interpreter that runs this file: its program would put another one first."""
TEST_TIME_LIMIT = 60.0
"""What rostest allows a test without a time-limit, in s."""
MARGIN = 90.0
"""Time for starting and ending the nodes of a scenario, in s, beyond the limits of its tests."""
PATIENCE = 30.0
"""How long an interrupted rostest may take to end its nodes, in s; it gives each of them 15 s."""
MARK = "NAO_LIBRARY_SCENARIO"
"""Environment variable by which the processes of a scenario are known."""
ROBOTS = 4
"""How many ports in a row a scenario may use: one a robot."""
PORTS = range(20000, 32000, ROBOTS)
"""Ports for NAOqi: below those that Linux gives to outgoing connections, of which ROS makes many."""
ALONE = "<!-- alone"
"""Comment in a scenario that wants the computer for itself: it measures times that no simulated clock rules."""


def time_limit(scenario: Path) -> float:
    """Return how long a scenario may take, in s: the limits of all its tests, with retries, and a margin.

    A file that is not XML gets the margin only: rostest is going to report it.
    """
    try:
        tests = list(ElementTree.parse(scenario).getroot().iter("test"))
    except ElementTree.ParseError:
        tests = []
    return MARGIN + sum(
        _number(test.get("time-limit"), TEST_TIME_LIMIT) * (1 + _number(test.get("retry"), 0)) for test in tests
    )


def _number(text: str | None, default: float) -> float:
    """Read a number; roslaunch may have left something to be filled in, such as $(arg limit)."""
    try:
        return float(text or default)
    except ValueError:
        return default


def free_port() -> int:
    """Return a TCP port of the loopback interface that nobody uses at the moment, nor those of further robots."""
    while True:
        port = random.choice(PORTS)
        if all(_is_free(port + robot) for robot in range(ROBOTS)):
            return port


def in_groups(folder: Path, scenarios: Sequence[Path], jobs: int) -> list[tuple[int, list[Path]]]:
    """Return what runs after each other: how many at once, and scenarios, those first that may take longest."""
    if jobs == 1:
        return [(1, list(scenarios))]
    alone = [s for s in scenarios if ALONE in (folder / s).read_text(encoding="utf-8", errors="replace")]
    others = sorted((s for s in scenarios if s not in alone), key=lambda s: -time_limit(folder / s))
    return [(number, group) for number, group in ((jobs, others), (1, alone)) if group]


def _is_free(port: int) -> bool:
    with socket.socket() as probe:
        try:
            probe.bind(("127.0.0.1", port))
        except OSError:
            return False
    return True


def processes_of(mark: str) -> dict[int, str]:
    """Return process id and command of all processes that carry a mark in their environment."""
    wanted = f"{MARK}={mark}".encode()
    found = {}
    for path in Path("/proc").glob("[0-9]*"):
        try:
            if wanted in (path / "environ").read_bytes().split(b"\0"):
                command = (path / "cmdline").read_bytes().replace(b"\0", b" ")
                found[int(path.name)] = command.decode(errors="replace").strip()
        except OSError:  # it ended in the meantime, or belongs to somebody else
            continue
    return found


@dataclass
class Runner:
    """Runs scenarios and keeps their results.

    `run` is called from worker threads; `stop` from the main thread, while they run. The lock guards
    `running` and `stopped`.

    Attributes:
        folder: Where the scenarios are.
        results: Where each scenario gets a directory of its own.
    """

    folder: Path
    results: Path
    running: list[subprocess.Popen] = field(default_factory=list)
    stopped: bool = False
    lock: threading.Lock = field(default_factory=threading.Lock)

    def run(self, scenario: Path) -> str:
        """Run one scenario (path relative to the folder) and return its verdict in one line."""
        directory = self.results / scenario.with_suffix("")
        shutil.rmtree(directory, ignore_errors=True)
        directory.mkdir(parents=True)
        mark = f"{os.getpid()}-{scenario}"
        started = time.monotonic()
        status = self._run_rostest(self.folder / scenario, directory, mark)
        elapsed = time.monotonic() - started
        left_behind = self._end_processes(mark)
        if status is None:
            return "interrupted"
        (directory / "status").write_text(f"{status}\n")
        return _verdict(directory, scenario, elapsed) + "".join(
            f"\n    left behind and ended: {command}" for command in left_behind
        )

    def _run_rostest(self, scenario: Path, directory: Path, mark: str) -> int | None:
        """Return the exit status of rostest, or None if the runner was stopped."""
        environment = dict(
            os.environ,
            ROS_TEST_RESULTS_DIR=str(directory),
            ROS_LOG_DIR=str(directory / "log"),
            ROS_HOME=str(directory / "ros_home"),
            NAO_IP="127.0.0.1",
            NAO_PORT=str(free_port()),
            **{MARK: mark},
        )
        (directory / "ros_home").mkdir()
        with open(directory / "output.txt", "wb") as output:
            with self.lock:
                if self.stopped:
                    return None
                # A session of its own: Ctrl-C reaches it through stop, once, and not twice.
                process = subprocess.Popen(
                    [*ROSTEST, str(scenario)],
                    env=environment,
                    stdin=subprocess.DEVNULL,
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    start_new_session=True,
                )
                self.running.append(process)
            try:
                status = process.wait(time_limit(scenario))
            except subprocess.TimeoutExpired:
                _end([process])
                status = TIMED_OUT
        with self.lock:
            self.running.remove(process)
            return None if self.stopped else status

    def stop(self) -> None:
        """Interrupt what runs and start nothing more."""
        with self.lock:
            self.stopped = True
            running = list(self.running)
        _end(running)

    @staticmethod
    def _end_processes(mark: str) -> list[str]:
        """End the processes that outlived their scenario, and return their commands."""
        found = processes_of(mark)
        for process in found:
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                continue
        return list(found.values())


def _end(processes: Sequence[subprocess.Popen]) -> None:
    """End runs of rostest: politely, so that they end their nodes, then by force."""
    for process in processes:
        process.send_signal(signal.SIGINT)
    for process in processes:
        try:
            process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def _verdict(directory: Path, scenario: Path, elapsed: float) -> str:
    cases = collect_run(directory, str(scenario))
    failed = sum(case.outcome is Outcome.FAILED for case in cases)
    if failed:
        return f"FAILED {elapsed:.1f} s ({failed} of {len(cases)}; see {directory})"
    return f"ok {elapsed:.1f} s ({len(cases)} test{'s' if len(cases) > 1 else ''})"


def run_all(runner: Runner, scenarios: Sequence[Path], jobs: int) -> bool:
    """Run the scenarios, up to `jobs` at a time, and print a line for each; return False if it was interrupted."""
    done = 0
    for at_once, group in in_groups(runner.folder, scenarios, jobs):
        with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
            futures = {pool.submit(runner.run, scenario): scenario for scenario in group}
            try:
                for future in concurrent.futures.as_completed(futures):
                    done += 1
                    print(f"[{done}/{len(scenarios)}] {futures[future]} ... {future.result()}", flush=True)
            except KeyboardInterrupt:
                print("interrupted: ending what runs...", flush=True)
                runner.stop()
                return False
    return True


def _interrupt(signal_number: int, frame: object) -> None:
    raise KeyboardInterrupt


def main(arguments: Sequence[str] | None = None) -> int:
    """Run what was asked for; the status is 0 even if tests failed, for summarize_tests gives the verdict."""
    parser = argparse.ArgumentParser(description="Run the rostest scenarios.")
    parser.add_argument("--folder", type=Path, required=True, help="folder with the .test files")
    parser.add_argument("--results", type=Path, required=True, help="directory for the results")
    parser.add_argument("--jobs", type=int, default=1, help="how many scenarios run at once (default: 1)")
    parser.add_argument("patterns", nargs="*", help="only the scenarios whose path contains one of these")
    options = parser.parse_args(arguments)
    if options.jobs < 1:
        parser.error(f"--jobs is {options.jobs}; it must be 1 or more")

    scenarios = find_scenarios(options.folder, options.patterns)
    if not scenarios:
        available = ", ".join(map(str, find_scenarios(options.folder))) or "none"
        print(f"no scenario fits {options.patterns or 'here'}; available: {available}", file=sys.stderr)
        return 2
    signal.signal(signal.SIGTERM, _interrupt)
    runner = Runner(options.folder.absolute(), options.results.absolute())
    return 0 if run_all(runner, scenarios, options.jobs) else 130


if __name__ == "__main__":
    sys.exit(main())
