"""The simulator server of a test worker, in this process: real libqi, real physics, time that the test moves."""

from __future__ import annotations

import queue
import shutil
import sys
import threading
import time
from contextlib import contextmanager

import qi

import naoqi
from nao_sim_bridge.server import ServerOptions, SimulatorServer
from nao_sim_bridge.sim.simulation import Scene

PATIENCE = 15.0
"""Longest wait for something that must happen, in s of wall time; passing tests do not come near it."""
DEVICE = "Device/SubDeviceList/{}/Actuator/Value"


def connected(port):
    session = qi.Session()
    session.connect(f"tcp://127.0.0.1:{port}")
    return session


class Simulator:
    """A simulator server and a libqi client of it. Time stands still unless the test lets it pass.

    Modules are attributes: `robot.ALMotion.getAngles("Body", True)` is a call over libqi.
    """

    patience = PATIENCE

    def __init__(self, record_dir, **options):
        self._interval = sys.getswitchinterval()
        options = {"scene": Scene(posture="Stand"), "port": 0, "paused": True, **options}
        self.server = SimulatorServer(ServerOptions(record_dir=record_dir, **options))
        self.server.start()
        self.session = connected(self.port)
        self._services = {}
        self.lockstep = Lockstep(self)

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._services:
            self._services[name] = self.session.service(name)
        return self._services[name]

    # --- where it is -------------------------------------------------------------------------------------------------

    @property
    def port(self):
        return self.server.broker.port

    @property
    def address(self):
        return "127.0.0.1", self.port

    def proxy(self, name, **options):
        """A module through the product's own proxy layer."""
        return naoqi.ALProxy(name, *self.address, **options)

    # --- time --------------------------------------------------------------------------------------------------------

    @property
    def now(self):
        """The last snapshot."""
        return self.server.runner.snapshot

    def advance(self, seconds):
        """Let simulated time pass, as fast as possible; returns the time after it."""
        return self.server.runner.advance(seconds).result(4 * PATIENCE).time

    def advance_until(self, condition, limit, step=0.05, what="the condition"):
        """Let time pass until `condition()` holds, at most `limit` s of simulated time."""
        end = self.now.time + limit
        while not condition():
            assert self.now.time < end, f"not within {limit} s of simulated time: {what}"
            self.advance(step)

    def fresh(self, world=""):
        """Put the server into the state of one that has just started, with an empty folder for recordings."""
        naoqi.close_all()  # whoever asks for a connection gets a new one
        self.server.runner.pause()
        for path in self.server.files.folder.glob("*"):
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        self.server.factory_reset(world)
        self.lockstep.attach()

    # --- calls that take simulated time ------------------------------------------------------------------------------

    def post(self, module, method, *arguments):
        """Call without waiting; the future of the answer."""
        return getattr(self, module).call(method, *arguments, _async=True)

    def answer(self, future):
        """The value of a future that is due."""
        return future.value(int(1000 * PATIENCE))

    def finish(self, module, method, *arguments, after):
        """Call a method that takes simulated time and let `after` s pass; its answer."""
        future = self.post(module, method, *arguments)
        self.handed_over(module)
        self.advance(after)
        return self.answer(future)

    def settled(self):
        """Return when the simulation has run every command it was given."""
        self.server.runner.call(lambda: None, PATIENCE)

    def handed_over(self, module):
        """Return when the module has heard every call of this client before: one object takes one call at a time."""
        getattr(self, module).ping()
        self.settled()

    @contextmanager
    def busy_simulation(self):
        """The simulation has no time for anybody."""
        done = threading.Event()
        self.server.runner.execute(lambda: done.wait(PATIENCE))
        try:
            yield
        finally:
            done.set()

    # --- looking -----------------------------------------------------------------------------------------------------

    def value(self, key):
        """What ALMemory has under a key."""
        return self.ALMemory.getData(key)

    def led(self, device):
        """Intensity 0..1 of an LED device, for example "Head/Led/Front/Right/1"."""
        return self.value(DEVICE.format(device))

    def heard(self, event):
        """A queue of the values that an event has from now on."""
        values = queue.Queue()
        subscriber = self.ALMemory.subscriber(event)
        subscriber.signal.connect(values.put)
        values.subscriber = subscriber  # who lets go of it hears nothing more
        return values

    def close(self):
        naoqi.connection(*self.address, wait=False).close()
        self.session.close()
        self.server.stop()
        sys.setswitchinterval(self._interval)


class Lockstep:
    """Lets time pass only while every goal under test waits for time or for the robot.

    So a goal sees the same times on a slow machine as on a fast one. A call to the robot that is not answered within
    `QUICK` s of wall time is one that takes simulated time; when something that takes time has ended on the robot, time
    holds until a call has its answer, at most `ANSWER` s. A goal that waits for something else, such as an event,
    counts as waiting when nothing has happened for `QUIET` s.
    """

    QUICK = 0.004
    ANSWER = 0.25
    QUIET = 0.1

    def __init__(self, simulator):
        self._simulator = simulator
        self._lock = threading.Lock()
        self._goals = 0
        self._calls = 0
        self._waiters = []
        self._changed = self._answer_due = 0.0
        self.attach()

    def attach(self):
        """To the present simulation."""
        simulation = self._simulator.server.simulation
        if self._closed not in simulation.holds:
            simulation.holds.append(self._closed)
            self._watch(simulation.task_ids)
            simulation.after_tick.append(self._tick)

    def _watch(self, ids):
        make = ids.make

        def watched(*arguments, **options):
            task = make(*arguments, **options)
            task.add_done_callback(self._task_ended)
            return task

        ids.make = watched

    # --- the goals under test ----------------------------------------------------------------------------------------

    def goal_begins(self):
        self._change(goals=1)

    def goal_is_over(self):
        self._change(goals=-1)

    def call_begins(self):
        self._change(calls=1)

    def _task_ended(self, _task):
        with self._lock:
            if self._goals and self._calls:
                self._answer_due = time.monotonic() + self.ANSWER

    def call_ended(self, _call=None):
        self._answer_due = 0.0
        self._change(calls=-1)

    def _change(self, goals=0, calls=0):
        with self._lock:
            self._goals += goals
            self._calls += calls
            self._changed = time.monotonic()
        self._simulator.server.simulation.wake()

    # --- the clock of the module under test --------------------------------------------------------------------------

    def time(self):
        return self._simulator.now.time

    def wait(self, duration, interrupt):
        """As WallClock.wait, in simulated time."""
        if interrupt.is_set():
            return False
        due = threading.Event()
        waiter = (self.time() + duration, due)
        with interrupt.waking(due.set):
            with self._lock:
                self._waiters.append(waiter)
            self._change()
            due.wait()
            with self._lock:
                if waiter in self._waiters:
                    self._waiters.remove(waiter)
            self._change()
        return not interrupt.is_set()

    def _tick(self, snapshot):
        """In the simulation thread: time holds again before those wake up who waited for it."""
        with self._lock:
            over = [w for w in self._waiters if w[0] <= snapshot.time + 1e-9 or w[1].is_set()]
            for waiter in over:
                self._waiters.remove(waiter)
        for _, due in over:
            due.set()

    def _closed(self):
        with self._lock:
            if not self._goals or any(not due.is_set() for _, due in self._waiters):
                return False
            now = time.monotonic()
            return now < self._answer_due or now - self._changed < (self.QUICK if self._calls else self.QUIET)
