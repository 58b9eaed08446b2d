"""The simulator server of a test worker, in this process: real libqi, real physics, time that the test moves."""

from __future__ import annotations

import queue
import shutil
import sys
import threading

import qi

import naoqi
import naoqi.calls
from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.core.simulation import Scene
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.server.simulator_server import SimulatorServer
from naoqi.errors import NaoError

PATIENCE = 60.0
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
        options = {"scene": Scene(posture="Stand"), "port": 0, "paused": True, "allow_private_streams": True, **options}
        self.server = SimulatorServer(ServerOptions(record_dir=record_dir, **options))
        self.server.start()
        self.session = connected(self.port)
        self._services = {}
        self._posted = []  # (module, future)
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
        snapshot = self.server.runner.advance(seconds).result(4 * PATIENCE)
        self._posted = [(module, future) for module, future in self._posted if future.isRunning()]
        for module in {module for module, _ in self._posted}:
            getattr(self, module).ping()  # what has ended is answered
        return snapshot.time

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
        self._posted = []
        self.lockstep.attach()

    # --- calls that take simulated time ------------------------------------------------------------------------------

    def post(self, module, method, *arguments):
        """Call without waiting; the future of the answer."""
        future = getattr(self, module).call(method, *arguments, _async=True)
        if module.startswith("AL"):  # the simulator's own service has no ping
            self._posted.append((module, future))
        return future

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
        self.lockstep.close()
        sys.setswitchinterval(self._interval)


def _is_woken(frame):
    """Whether a thread that waits for a condition has been notified, and only has had no processor since."""
    waiter = frame.f_locals.get("waiter")
    return waiter is not None and not waiter.locked()


class OpenCall:
    """A call that is not answered, or a callback of it that has not run."""

    def __init__(self, proxy, call=None):
        self.proxy, self.call = proxy, call


class Lockstep:
    """Lets time pass only while every goal under test waits for time or for the robot.

    So a goal sees the same times on a slow machine as on a fast one: what is waited for is counted, not timed. Whatever
    happens to a goal (a call begins or ends, a wait for time is over, something on the robot has ended) holds time.
    It passes again when, `ROUNDS` times in a row, the robot has answered a ping of every module that has not answered a
    call of the goal, the simulation has run a command, no callback of an answer is still to run, and the threads of the
    goals have been seen waiting. A module takes one call at a time, so a call that is still open then is one that takes
    simulated time.
    """

    ROUNDS = 4
    STUCK = 500
    """Looks after which a thread counts as waiting that is never seen to: it calls the robot unwatched. No time: on a
    computer that has much else to do, a thread that works may not be seen to wait for long."""
    PAUSE = 0.001
    """s until the next look at a thread that works."""

    def __init__(self, simulator):
        self._simulator = simulator
        self._news = threading.Condition()
        self._goals = []
        self._calls = []
        self._waiters = []
        self._change = self._quiet = 0
        self._looks = {}  # at threads that have not been seen waiting since
        self._ended = False
        threading.Thread(target=self._look, name="lockstep", daemon=True).start()
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
            task.add_done_callback(lambda _: self.changed())
            return task

        ids.make = watched

    # --- the goals under test ----------------------------------------------------------------------------------------

    def goal_begins(self, thread=None):
        """Hold time for a goal; `thread` is the one it runs in, where there is only one."""
        self.changed(lambda: self._goals.append(thread))

    def goal_is_over(self, thread=None):
        self.changed(lambda: self._goals.remove(thread))

    def call_begins(self, proxy, call=None):
        """Hold time for a call, or for a callback of it; returns what `call_ended` takes."""
        opened = OpenCall(proxy, call)
        self.changed(lambda: self._calls.append(opened))
        return opened

    def call_ended(self, opened):
        self.changed(lambda: self._calls.remove(opened))

    def changed(self, change=lambda: None):
        """Something has happened to a goal: time holds until it waits again."""
        with self._news:
            change()
            self._change += 1
            self._news.notify_all()

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
            self.changed(lambda: self._waiters.append(waiter))
            due.wait()
            self.changed(lambda: waiter in self._waiters and self._waiters.remove(waiter))
        return not interrupt.is_set()

    def _tick(self, snapshot):
        """In the simulation thread: time holds again before those wake up who waited for it."""
        over = [w for w in list(self._waiters) if w[0] <= snapshot.time + 1e-9 or w[1].is_set()]
        if over:
            self.changed(lambda: [self._waiters.remove(waiter) for waiter in over if waiter in self._waiters])
            for _, due in over:
                due.set()

    # --- whether they wait -------------------------------------------------------------------------------------------

    def _closed(self):
        """In the simulation thread."""
        return bool(self._goals) and self._quiet != self._change

    def _look(self):
        rounds, seen = 0, 0
        while True:
            with self._news:
                self._news.wait_for(lambda: self._ended or (self._goals and self._quiet != self._change))
                if self._ended:
                    return
                rounds = rounds if seen == self._change else 0
                seen, goals, calls = self._change, list(self._goals), list(self._calls)
            self._round({id(opened.proxy): opened.proxy for opened in calls}.values())
            if seen != self._change:
                continue
            heard = not any(opened.call is not None and opened.call.done() for opened in calls)
            if not heard or not all(self._waits(goal, bool(calls)) for goal in goals):
                rounds = 0
                with self._news:
                    self._news.wait(self.PAUSE)
                continue
            rounds += 1
            if rounds == self.ROUNDS:
                self._quiet, rounds = seen, 0
                self._simulator.server.simulation.wake()

    def _round(self, proxies):
        try:
            for proxy in proxies:
                proxy.call("ping")
            self._simulator.settled()
        except (NaoError, SimulationError):
            pass  # the robot is lost, which the goal sees as well

    def _waits(self, thread, called):
        """Whether a goal does nothing now: its thread waits for another, or for an answer that is known of."""
        frame = thread and sys._current_frames().get(thread.ident)
        file = frame and frame.f_code.co_filename
        woken = file == threading.__file__ and _is_woken(frame)
        if not frame or (file == threading.__file__ and not woken) or (called and file == naoqi.calls.__file__):
            self._looks.pop(thread, None)
            return True
        self._looks[thread] = self._looks.get(thread, 0) + 1
        return self._looks[thread] > self.STUCK

    def close(self):
        with self._news:
            self._ended = True
            self._news.notify_all()
