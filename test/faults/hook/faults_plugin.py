"""The pytest side of run.py: records what each test reaches, or runs chosen tests in a given order."""

from __future__ import annotations

import itertools
import json
import mmap
import os
import sys
import time

import pytest

REACH, PICKS = os.environ.get("FAULTS_REACH"), os.environ.get("FAULTS_PICKS")


class Recorder:
    """One line a test: name, outcome, duration in s, numbers of the blocks; before them lines that name the numbers."""

    def __init__(self, grouped):
        self.grouped = grouped
        page = f"{REACH}/page-{os.getpid()}"
        with open(page, "wb") as file:
            file.write(b"\0" * 4096)
        with open(page, "r+b") as file:
            self.page = mmap.mmap(file.fileno(), 4096)
        os.environ["FAULTS_PAGE"] = page
        self.file = open(f"{REACH}/tests-{os.getpid()}.txt", "w")
        self.numbers, self.generations = {}, itertools.count(1)
        self.reports = {}

    def name_of(self, nodeid):
        return nodeid.rpartition("@")[0] if self.grouped else nodeid  # xdist adds the group

    def pytest_runtest_logstart(self, nodeid):
        self.page[8:] = self.name_of(nodeid).encode()[:4080].ljust(4088, b"\0")
        self.page[:8] = next(self.generations).to_bytes(8, "little")
        sys.reached.clear()
        self.reports = {}

    def pytest_runtest_logreport(self, report):
        self.reports[report.when] = report

    def pytest_runtest_logfinish(self, nodeid):
        reached = list(sys.reached)
        for name in reached:
            if name not in self.numbers:
                self.numbers[name] = len(self.numbers)
                self.file.write(f"#\t{self.numbers[name]}\t{name}\n")
        outcome = "passed" if all(r.outcome == "passed" for r in self.reports.values()) else "failed"
        took = sum(r.duration for r in self.reports.values())
        numbers = " ".join(str(self.numbers[name]) for name in reached)
        self.file.write(f"{self.name_of(nodeid)}\t{outcome}\t{took:.3f}\t{numbers}\n")
        self.file.flush()


class Picker:
    """Runs the tests that a file names, in its order, until one fails or time is up; writes what happened."""

    def __init__(self):
        with open(PICKS) as file:
            order = json.load(file)
        self.order, self.result, self.end = order["tests"], order["result"], time.monotonic() + order["seconds"]
        self.ran, self.over = 0, False

    def write(self, over=False, **facts):
        """Keep what happened; after a failure nothing more."""
        if self.over:
            return
        self.over = over
        with open(self.result, "w") as file:
            json.dump({"ran": self.ran, **facts}, file)

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items):
        found = {item.nodeid: item for item in items}
        items[:] = [found[name] for name in self.order if name in found]
        packages = [sys.modules.get(name) for name in ("nao_sim_bridge", "nao_library_modules", "almath")]
        foreign = [p.__file__ for p in packages if p and not p.__file__.startswith(os.getcwd())]
        if foreign:
            raise pytest.UsageError(f"not the packages of this copy: {foreign}")
        self.write(missing=len(self.order) - len(items))

    def pytest_collectreport(self, report):
        if report.failed:
            self.write(True, killed=report.nodeid, why=str(report.longrepr)[-300:])

    def pytest_runtest_logstart(self, nodeid):
        self.ran += 1
        self.write(running=nodeid)

    def pytest_runtest_logreport(self, report):
        if report.failed:
            crash = getattr(report.longrepr, "reprcrash", None)
            self.write(True, killed=report.nodeid, why=str(crash.message if crash else report.longrepr)[:300])

    def pytest_runtest_logfinish(self):
        self.write()

    def pytest_runtest_protocol(self, item):
        if self.over or time.monotonic() > self.end:
            item.session.shouldstop = "enough"
            return True


def pytest_configure(config):
    # The process that only hands out work to others has no tests of its own.
    if REACH and (hasattr(config, "workerinput") or not config.getoption("numprocesses", None)):
        config.pluginmanager.register(Recorder(config.getoption("loadgroup", False)), "faults-recorder")
    if PICKS:
        config.pluginmanager.register(Picker(), "faults-picker")
