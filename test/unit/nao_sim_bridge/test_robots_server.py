"""Robots in one world on the network: a port each, one time, and each shuts down for itself."""

from __future__ import annotations

import math
import time

import pytest
import qi

from nao_sim_bridge.robots_server import SEED_STEP, RobotsServer, open_server
from nao_sim_bridge.server import ServerOptions, SimulatorServer
from nao_sim_bridge.sim.errors import BadValue, NotAllowed
from nao_sim_bridge.sim.places import parse_places
from nao_sim_bridge.sim.runner import FASTEST
from nao_sim_bridge.sim.scene import Scene

PATIENCE = 20.0


class Robots:
    """Two robots that face each other; time passes when asked."""

    def __init__(self, folder):
        places = parse_places("0,0,0; 1,0,180")
        scene = Scene(seed=3)
        options = ServerOptions(scene, port=0, speed=FASTEST, paused=True, record_dir=folder, robots=2, places=places)
        self.server = RobotsServer(options)
        self.server.start()
        self.sessions = [qi.Session() for _ in self.server.servers]
        for session, one in zip(self.sessions, self.server.servers):
            session.connect(f"tcp://127.0.0.1:{one.broker.port}")

    def of(self, module):
        """A module of each robot."""
        return [session.service(module) for session in self.sessions]

    def close(self):
        for session in self.sessions:
            session.close()
        self.server.stop()


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    made = Robots(tmp_path_factory.mktemp("files"))
    yield made
    made.close()


@pytest.fixture
def robots(shared):
    shared.of("NaoSimulation")[0].reset()
    return shared


def test_each_robot_has_a_port_a_name_a_seed_and_a_folder_of_its_own(robots, tmp_path_factory):
    servers = robots.server.servers
    assert len({server.broker.port for server in servers}) == 2
    assert robots.server.names == ("nao1", "nao2")
    assert [server.simulation.scene.seed for server in servers] == [3, 3 + SEED_STEP]
    assert [server.files.folder.name for server in servers] == ["nao1", "nao2"]
    assert all(service.robotName() == name for service, name in zip(robots.of("ALSystem"), robots.server.names))


def test_what_one_is_told_only_one_does(robots):
    first, second = robots.of("ALMotion")
    wake = first.wakeUp(_async=True)
    robots.of("NaoSimulation")[1].advance(2.5)
    assert wake.wait(int(PATIENCE * 1000)) == qi.FutureState.FinishedWithValue
    assert (first.robotIsWakeUp(), second.robotIsWakeUp()) == (True, False)
    heights = [service.torsoPose()[2] for service in robots.of("NaoSimulation")]
    assert heights[0] > 0.32 > heights[1]


def test_time_is_one(robots):
    first, second = robots.of("NaoSimulation")
    before = first.time()
    assert second.advance(0.5) == pytest.approx(before + 0.5) == first.time()
    second.setSpeed(0.5)
    assert first.speed() == 0.5
    first.setSpeed(0.0)
    assert first.isPaused() and second.isPaused()


def test_things_and_sounds_are_one(robots):
    first, second = robots.of("NaoSimulation")
    first.placeObject("{name: b, ball: 0.04, position: [0.5, 0.3, 0.04]}")
    assert "b" in second.objectPoses() and "b" in second.objects()
    first.addSound("hum", "tone:440", [0.5, 0.0, 0.5], 50.0, True)
    assert list(second.sounds()) == ["hum"]
    said = [service.personSays("hello", [0.5, 0.5, 1.0], "", 0.0, _async=True) for service in (first, second)]
    deadline = time.monotonic() + PATIENCE
    while not all(future.isFinished() for future in said) and time.monotonic() < deadline:
        second.advance(0.5)
    assert [future.value() for future in said] == [None, None], "both have a voice of their own"
    second.reset()
    assert "b" not in first.objectPoses() and not first.sounds()


def test_a_reset_is_of_the_world_and_told_to_all(robots):
    motion, simulation = robots.of("ALMotion"), robots.of("NaoSimulation")
    wakes = [one.wakeUp(_async=True) for one in motion]
    simulation[0].advance(2.5)
    for wake in wakes:
        wake.wait(int(PATIENCE * 1000))
    simulation[1].reset()
    assert [one.robotIsWakeUp() for one in motion] == [False, False]
    assert [one.getData("robotIsWakeUp") for one in robots.of("ALMemory")] == [False, False]


def test_a_reboot_is_of_one_robot(robots):
    simulation = robots.of("NaoSimulation")
    for one in simulation:
        one.push([0.0, 60.0, 0.0], 0.3, "torso")
    simulation[0].placeObject("{name: b, ball: 0.04, position: [0.5, -0.3, 0.04]}")
    simulation[0].advance(1.0)
    before = simulation[0].torsoPose()
    robots.of("ALSystem")[1].reboot()
    assert simulation[1].torsoPose()[:2] == pytest.approx([1.0, 0.0], abs=0.03)
    assert simulation[0].torsoPose() == before
    assert "b" in simulation[0].objectPoses()


def test_pictures_show_the_others(robots):
    shown = robots.server.servers[0].pictures.state()
    (other,) = shown.others
    assert other.base_position == robots.server.servers[1].runner.snapshot.torso.position
    x, y, z, w = other.base_orientation
    assert abs(math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))) == pytest.approx(math.pi, abs=0.05)


def test_robots_shut_down_one_by_one(tmp_path):
    robots = Robots(tmp_path)
    try:
        robots.of("ALSystem")[0].shutdown()
        assert robots.server.servers[0].ended.wait(PATIENCE) and not robots.server.ended.is_set()
        second = robots.of("NaoSimulation")[1]
        assert second.advance(0.1) > 0.0
        robots.of("ALSystem")[1].shutdown()
        assert robots.server.ended.wait(PATIENCE)
    finally:
        robots.close()


def test_one_robot_is_a_server_of_its_own(tmp_path):
    server = open_server(ServerOptions(record_dir=tmp_path))
    assert isinstance(server, SimulatorServer) and server.simulation.shared.robots == [server.simulation]
    server.simulation.close()


def test_a_place_of_ones_own_is_told_too(tmp_path):
    server = open_server(ServerOptions(record_dir=tmp_path, places=parse_places("1,2,90")))
    assert server.simulation.snapshot.torso.position[:2] == pytest.approx((1.0, 2.0), abs=0.02)
    server.simulation.close()


def test_a_place_inside_a_thing_is_refused(tmp_path):
    options = ServerOptions(Scene("lab"), record_dir=tmp_path, robots=2, places=parse_places("0,0,0; 1,0,180"))
    with pytest.raises(NotAllowed, match="robot 2 would be 0.0.* m inside 'table': choose other places"):
        RobotsServer(options)


@pytest.mark.parametrize(
    "options, problem",
    [
        ({"port": 65535}, "at most 65534 for the first robot"),
        ({"sound_card": True}, "more than one robot"),
        ({"places": parse_places("0,0")}, "one for each of the 2 robots"),
        ({"places": parse_places("0,0;0.1,0")}, "0.35 m or more"),
    ],
)
def test_what_several_robots_cannot_have_is_refused(tmp_path, options, problem):
    with pytest.raises(BadValue, match=problem):
        RobotsServer(ServerOptions(record_dir=tmp_path, robots=2, **options))
