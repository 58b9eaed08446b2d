"""A simulated robot on the network, and a client of it: real libqi, time that passes only when asked."""

from __future__ import annotations

import queue
import sys
import threading
from contextlib import contextmanager

import pytest
import qi

from nao_sim_bridge.broker import Broker
from nao_sim_bridge.server import ServerOptions, SimulatorServer
from nao_sim_bridge.services.binding import make_service
from nao_sim_bridge.sim.simulation import Scene


class Client:
    """A client of a simulated robot that stands still in time; it wakes up limp in Stand."""

    def __init__(self, server, patience):
        self.server = server
        self.patience = patience
        self.session = connected(server.broker.port)
        self._services = {}

    def __getattr__(self, name):
        """A service of the robot by its name, for example `robot.ALMotion`."""
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._services:
            self._services[name] = self.session.service(name)
        return self._services[name]

    @property
    def now(self):
        """The last snapshot."""
        return self.server.runner.snapshot

    def advance(self, seconds):
        """Let simulated time pass."""
        return self.NaoSimulation.advance(seconds)

    def post(self, module, method, *arguments):
        """Call without waiting; the future of the answer."""
        return getattr(self, module).call(method, *arguments, _async=True)

    def settled(self):
        """Return when the simulation has run every command it was given."""
        self.server.runner.call(lambda: None, self.patience)

    def finish(self, module, method, *arguments, after):
        """Call a method that takes simulated time and let `after` s pass; its answer."""
        future = self.post(module, method, *arguments)
        self.handed_over(module)
        self.advance(after)
        return self.answer(future)

    def handed_over(self, module):
        """Return when the module has heard every call of this client before: one object takes one call at a time."""
        getattr(self, module).ping()
        self.settled()

    def answer(self, future):
        """The value of a future that is due."""
        return future.value(int(1000 * self.patience))

    @contextmanager
    def busy_simulation(self):
        """The simulation has no time for anybody."""
        done = threading.Event()
        self.server.runner.execute(lambda: done.wait(self.patience))
        try:
            yield
        finally:
            done.set()

    def close(self):
        self.session.close()


def connected(port):
    session = qi.Session()
    session.connect(f"tcp://127.0.0.1:{port}")
    return session


@pytest.fixture(scope="module")
def shared_robot(client_of, tmp_path_factory):
    interval = sys.getswitchinterval()
    records = tmp_path_factory.mktemp("records")
    server = SimulatorServer(ServerOptions(Scene(posture="Stand"), port=0, paused=True, record_dir=records))
    server.start()
    client = client_of(server)
    yield client
    client.close()
    server.stop()
    sys.setswitchinterval(interval)


@pytest.fixture(scope="session")
def client_of(patience):
    """Makes a client of a server."""
    return lambda server: Client(server, patience)


@pytest.fixture
def robot(shared_robot):
    """The robot of this file, put to its start; keys of the memory stay."""
    shared_robot.NaoSimulation.reset()
    return shared_robot


@pytest.fixture
def told(robot):
    """Values of an event that an action leads to, each with the time, s after the begin of the action."""

    def of(event, action):
        values, begin = [], robot.now.time
        robot.server.memory.listen(event, lambda value: values.append((value, robot.now.time - begin)))
        action()
        return list(values)

    return of


@pytest.fixture
def heard(robot):
    """Gives a queue of the values that an event tells from then on, by the name of the event."""
    subscribers = []  # who lets go of one hears nothing more

    def of(event):
        values = queue.Queue()
        subscriber = robot.ALMemory.subscriber(event)
        subscriber.signal.connect(values.put)
        subscribers.append(subscriber)
        return values

    return of


@pytest.fixture
def stiff_robot(robot):
    """The robot, stiff, standing."""
    robot.ALMotion.setStiffnesses("Body", 1.0)
    return robot


class Listener:
    """A module of a client that events call back, and that has signals."""

    def __init__(self):
        self.heard = queue.Queue()
        self.touched = qi.Signal("(i)")
        self.moved = qi.Signal("(ii)")

    @qi.bind(qi.Void, [qi.String, qi.Dynamic, qi.String])
    def onEvent(self, name, value, message):
        self.heard.put((name, value, message))


@pytest.fixture(scope="module")
def shared_listener(shared_robot):
    """Registered as the module "Listener" once for all: libqi takes its time to forget a module of the same name."""
    session = connected(shared_robot.server.broker.port)
    session.listen("tcp://127.0.0.1:0")
    module = Listener()
    session.registerService("Listener", module)
    yield module
    session.close()


@pytest.fixture
def listener(shared_listener):
    """The module "Listener"; what it hears is in its queue `heard`."""
    shared_listener.heard = queue.Queue()
    return shared_listener


@pytest.fixture(scope="module")
def broker():
    """A broker of its own for modules that a test makes up."""
    made = Broker("test_broker")
    made.listen("127.0.0.1", 0)
    yield made
    made.close()


@pytest.fixture
def session(broker):
    """A client of `broker`, new for each test: it must not remember what another one served under the same name."""
    client = connected(broker.port)
    yield client
    client.close()


def _found(session, module, tries=50):
    """A service that was registered a moment ago: now and then libqi asks the one of that name that has just gone."""
    for _ in range(tries - 1):
        try:
            return session.service(module)
        except RuntimeError as error:
            if "could not be handled" not in str(error):
                raise
    return session.service(module)


@pytest.fixture
def serve(broker, session):
    """Serves objects as a NAOqi module; returns what a client gets to see of it."""
    served = []

    def make(module, *parts):
        broker.register(module, make_service(module, parts, broker))
        served.append(module)
        return _found(session, module)

    yield make
    for module in served:
        broker.unregister(module)
