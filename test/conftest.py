"""What all levels share: which tests run, in which order, and the closing line."""

from __future__ import annotations

import json
import random
import signal
from pathlib import Path

import pytest
from amount import LONG
from hypothesis import settings
from xdist.scheduler import LoadGroupScheduling

LEVELS = ("logic", "robot", "ros", "slow")
HERE = Path(__file__).parent
RESULTS = HERE.parent / ".ws" / "test_results"
DURATIONS = RESULTS / "durations.json"
"""How long each file took when it last ran, in s: what takes longest starts first."""
SLOWEST = 20
STACK = "ros"
LIMITS = {"ros": 900, "slow": 1800}
"""s that a case of a level may take, where not as pyproject.toml says; the first one starts the stack."""

# Whoever starts the tests in the background of a shell has them ignore Ctrl-C, and so would the programs that they
# start and interrupt.
signal.signal(signal.SIGINT, signal.default_int_handler)
settings.register_profile("nao", derandomize=True, deadline=None, print_blob=False, database=None)
settings.load_profile("nao")


@pytest.fixture(scope="session")
def stack(tmp_path_factory):
    """Simulator, driver and servers; this process is a node beside them. One for the levels ros and slow."""
    from ros_stack import RosStack  # the other levels need no ROS

    stack = RosStack(tmp_path_factory.mktemp("ros"))
    yield stack
    stack.close()


def pytest_addoption(parser):
    parser.addoption("--words", default="", help="run tests with one of these words in their path or name")
    parser.addoption("--closing", default="", help="file for the closing line")
    parser.addoption("--shuffle", default="", help="run the files in a random order of this seed")


def pytest_configure(config):
    for level in LEVELS:
        config.addinivalue_line("markers", f"{level}: a test of the level {level}")
    config.addinivalue_line("markers", "long: a test that only the long form of the level slow runs")
    if not hasattr(config, "workerinput"):
        config.pluginmanager.register(FailuresAtOnce(config))


class FailuresAtOnce:
    """Tells of each failure when it happens: a run that is cut off has told what it knew."""

    def __init__(self, config):
        self._config = config

    @pytest.hookimpl(trylast=True)
    def pytest_runtest_logreport(self, report):
        if report.failed:
            crash = getattr(report.longrepr, "reprcrash", None)
            said = crash.message.split("\n")[0] if crash else report.longreprtext.strip().split("\n")[-1]
            terminal = self._config.pluginmanager.get_plugin("terminalreporter")
            terminal.ensure_newline()
            terminal.write_line(f"{_name(report)}: {said}")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    words = config.getoption("--words").lower().split()
    left_out = {item for item in items if words and not any(word in item.nodeid.lower() for word in words)}
    if not words and not LONG:
        left_out |= {item for item in items if item.get_closest_marker("long")}
    config.hook.pytest_deselected(items=list(left_out))
    items[:] = [item for item in items if item not in left_out]
    seed = config.getoption("--shuffle")
    if seed:
        random.Random(seed).shuffle(items)
        place = {item.cls: number for number, item in reversed(list(enumerate(items)))}
        items.sort(key=lambda item: place[item.cls] if item.cls else 0)  # what a class sets up is set up once
    items.sort(key=lambda item: getattr(item.cls, "world", ""))  # the running stack starts once in each world
    for item in items:
        # The cases of a file share what takes long to start.
        file = item.path.relative_to(HERE).as_posix()
        limit = LIMITS.get(file.split("/")[0])
        if limit and item.get_closest_marker("timeout") is None:
            item.add_marker(pytest.mark.timeout(limit))
        if item.get_closest_marker("xdist_group") is None:
            stack = [STACK, getattr(item.cls, "world", "")] if "stack" in item.fixturenames else []
            item.add_marker(pytest.mark.xdist_group(" ".join([*stack, file])))


class LongestFirst(LoadGroupScheduling):
    """Hands out the files that took longest when they last ran, or in random order.

    One worker takes those of the running stack, world by world; another one starts a stack when nothing else is left.
    """

    def _assign_work_unit(self, node):
        if not self.workqueue:  # few cases: another worker has them all
            return
        seed, took = self.config.getoption("--shuffle"), _durations()
        own, *others = (
            any(map(_on_stack, self.assigned_work[each]))
            for each in sorted(self.nodes, key=lambda each: each is not node)
        )
        wants_stack = own or not any(others)

        def rank(group):
            *world, file = group.split(" ")
            longest = random.Random(seed + group).random() if seed else -took.get(file, 0.0)
            return (_on_stack(group) != wants_stack, world, longest)

        self.workqueue.move_to_end(min(self.workqueue, key=rank), last=False)
        super()._assign_work_unit(node)
        if self.workqueue and self._pending_of(self.assigned_work[node]) < 2:
            self._assign_work_unit(node)  # a worker begins with a case when it knows the next one

    def _reschedule(self, node):
        if node in self.registered_collections:  # one that replaces a lost worker may still be reading the tests
            super()._reschedule(node)

    def remove_node(self, node):
        """A case that ends its worker is not run again: it would end the next one as well."""
        units = self.assigned_work.get(node, {})
        crashed, unit = next(((case, unit) for unit in units.values() for case in unit if not unit[case]), (None, None))
        if crashed:
            unit[crashed] = True
            for name in [name for name, unit in units.items() if all(unit.values())]:
                del units[name]
        super().remove_node(node)
        return crashed


def pytest_xdist_make_scheduler(config, log):
    return LongestFirst(config, log)


def _on_stack(group):
    return group.startswith(f"{STACK} ")


def _durations():
    try:
        return json.loads(DURATIONS.read_text())
    except (OSError, ValueError):
        return {}


def _name(report):
    """Name of the test of a report, without its group of xdist."""
    return report.nodeid.rpartition("@")[0] or report.nodeid


def pytest_terminal_summary(terminalreporter, config):
    """The slowest tests, how long each file took, and the closing line."""
    if hasattr(config, "workerinput"):
        return
    reports = [r for group in terminalreporter.stats.values() for r in group if hasattr(r, "duration")]
    took, cases = {}, {}
    for report in reports:
        name = _name(report)
        file = name.split("::")[0].replace("test/", "", 1)
        took[file] = took.get(file, 0.0) + report.duration
        cases[name] = cases.get(name, 0.0) + report.duration
    terminalreporter.section(f"slowest {SLOWEST}")
    for name, duration in sorted(cases.items(), key=lambda case: -case[1])[:SLOWEST]:
        terminalreporter.line(f"{duration:7.2f} s  {name}")
    RESULTS.mkdir(parents=True, exist_ok=True)
    DURATIONS.write_text(json.dumps({**_durations(), **{file: round(t, 2) for file, t in took.items()}}, indent=0))
    count = {name: len(terminalreporter.stats.get(name, [])) for name in ("passed", "failed", "error")}
    closing = config.getoption("--closing")
    if closing:
        Path(closing).write_text(f"{count['passed']} passed, {count['failed'] + count['error']} failed\n")


def pytest_report_header(config):
    seed = config.getoption("--shuffle")
    return f"random order, seed {seed}: repeat it with SEED={seed}" if seed else None


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(item, nextitem):
    """The stack takes no time of the processor when its cases are over."""
    stack = item.funcargs.get("stack")
    yield
    if stack and "stack" not in getattr(nextitem, "fixturenames", ()):
        stack.rest()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    report = yield
    if report.skipped and not hasattr(report, "wasxfail"):
        report.outcome = "failed"
        report.longrepr = f"skipped, which shows nothing: {call.excinfo.value}"
    return report
