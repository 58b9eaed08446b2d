"""Robots in one world: a port each, one time, things and sounds for all, and each shuts down for itself."""

from __future__ import annotations

import math
import threading

import numpy as np
import pytest
import qi
from simulator import PATIENCE, connected

from nao_sim_bridge.base.errors import BadValue, NotAllowed
from nao_sim_bridge.core.runner import FASTEST
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.core.simulation import SEED_STEP
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.server.robots_server import RobotsServer, open_server
from nao_sim_bridge.server.simulator_server import SimulatorServer
from nao_sim_bridge.world.places import parse_places

TOP, VGA, RGB = 0, 2, 11


class Robots:
    """Robots on the network; time passes when asked."""

    def __init__(self, folder, places="0,0,0; 1,0,180", **scene):
        places = parse_places(places)
        options = ServerOptions(Scene(seed=3, **scene), port=0, speed=FASTEST, paused=True, record_dir=folder)
        self.server = RobotsServer(ServerOptions(**{**vars(options), "robots": len(places), "places": places}))
        self.server.start()
        self.sessions = [connected(one.broker.port) for one in self.server.servers]

    def of(self, module):
        """A module of each robot."""
        return [session.service(module) for session in self.sessions]

    def advance_until(self, condition, limit=10.0):
        simulation, begin = self.sessions[-1].service("NaoSimulation"), self.server.runner.snapshot.time
        while not condition():
            assert self.server.runner.snapshot.time < begin + limit
            simulation.advance(0.25)

    def wake(self):
        """All of them stand."""
        calls = [motion.wakeUp(_async=True) for motion in self.of("ALMotion")]
        self.advance_until(lambda: all(call.isFinished() for call in calls))

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
    """Two that face each other, as they have just started."""
    shared.server.factory_reset()
    return shared


@pytest.fixture
def made(tmp_path):
    """Makes robots of one's own."""
    groups = []

    def make(*arguments, **options):
        groups.append(Robots(tmp_path, *arguments, **options))
        return groups[-1]

    yield make
    for group in groups:
        group.close()


def test_each_robot_has_a_port_a_name_a_seed_and_a_folder_of_its_own(robots):
    servers = robots.server.servers
    assert len({server.broker.port for server in servers}) == 2 and robots.server.names == ("nao1", "nao2")
    assert [server.simulation.scene.seed for server in servers] == [3, 3 + SEED_STEP]
    assert [server.files.folder.name for server in servers] == ["nao1", "nao2"]
    assert [service.robotName() for service in robots.of("ALSystem")] == ["nao1", "nao2"]


def test_what_one_is_told_only_one_does_and_others_see_it(robots):
    first, second = robots.of("ALMotion")
    wake = first.wakeUp(_async=True)
    robots.of("NaoSimulation")[1].advance(2.5)
    assert wake.wait(int(PATIENCE * 1000)) == qi.FutureState.FinishedWithValue
    assert (first.robotIsWakeUp(), second.robotIsWakeUp()) == (True, False)
    heights = [service.torsoPose()[2] for service in robots.of("NaoSimulation")]
    assert heights[0] > 0.32 > heights[1]
    (other,) = robots.server.servers[0].simulation.render_state().others
    assert other.base_position == robots.server.servers[1].runner.snapshot.torso.position
    x, y, z, w = other.base_orientation
    assert abs(math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))) == pytest.approx(math.pi, abs=0.05)


def test_time_things_and_sounds_are_one(robots):
    first, second = robots.of("NaoSimulation")
    assert second.advance(0.5) == pytest.approx(0.5) == first.time()
    second.setSpeed(0.5)
    assert first.speed() == 0.5 and first.isPaused() and second.isPaused()
    first.setSpeed(0.0)
    first.placeObject("{name: b, ball: 0.04, position: [0.5, 0.3, 0.04]}")
    assert "b" in second.objectPoses() and "b" in second.objects()
    first.addSound("hum", "tone:440", [0.5, 0.0, 0.5], 50.0, True)
    assert list(second.sounds()) == ["hum"]
    said = [service.personSays("hello", [0.5, 0.5, 1.0], "", 0.0, _async=True) for service in (first, second)]
    robots.advance_until(lambda: all(future.isFinished() for future in said))
    assert [future.value() for future in said] == [None, None]  # both have a voice of their own
    second.reset()
    assert "b" not in first.objectPoses() and not first.sounds()


def test_a_reset_is_of_the_world_and_a_reboot_of_one_robot(robots):
    simulation = robots.of("NaoSimulation")
    robots.wake()
    simulation[1].reset()
    assert [one.robotIsWakeUp() for one in robots.of("ALMotion")] == [False, False]
    assert [one.getData("robotIsWakeUp") for one in robots.of("ALMemory")] == [False, False]
    for one in simulation:
        one.push([0.0, 60.0, 0.0], 0.3, "torso")
    simulation[0].placeObject("{name: b, ball: 0.04, position: [0.5, -0.3, 0.04]}")
    simulation[0].advance(1.0)
    before = simulation[0].torsoPose()
    robots.of("ALSystem")[1].reboot()
    assert simulation[1].torsoPose()[:2] == pytest.approx([1.0, 0.0], abs=0.03)
    assert simulation[0].torsoPose() == before and "b" in simulation[0].objectPoses()


def test_a_factory_reset_is_of_all_robots_also_in_another_world(robots):
    simulation, memory = robots.of("NaoSimulation"), robots.of("ALMemory")
    heard = []
    subscribers = [one.subscriber("NAOqiReady") for one in memory]
    for subscriber in subscribers:
        subscriber.signal.connect(lambda _: heard.append(1))
    for one in memory:
        one.insertData("Test/Own", 1)
    robots.wake()
    began = [server.now[1] for server in robots.server.servers]
    simulation[1].factoryReset()
    assert [one.time() for one in simulation] == [0.0, 0.0]
    assert [server.now[1] for server in robots.server.servers] == pytest.approx(began)
    assert not any("Test/Own" in one.getDataListName() for one in memory)
    assert [one.robotIsWakeUp() for one in robots.of("ALMotion")] == [False, False]
    simulation[0].reset("slope_3deg")
    assert {server.simulation.scene.world for server in robots.server.servers} == {"slope_3deg"}
    with pytest.raises(RuntimeError, match="inside"):
        simulation[0].reset("lab")  # a table stands where the second one would
    assert simulation[1].advance(0.1) == pytest.approx(0.1)
    simulation[1].factoryReset()
    assert {server.simulation.scene.world for server in robots.server.servers} == {"empty"}
    simulation[0].advance(0.1)
    assert len(heard) == 6


def test_a_robot_sees_the_eyes_of_another_turn_red(robots):
    lights = robots.of("ALLeds")[1]
    robots.wake()

    def redness():
        """How much more red than green the top camera of the first sees, for each pixel."""
        device = robots.of("ALVideoDevice")[0]
        name = device.subscribeCamera("test", TOP, VGA, RGB, 30)
        robots.of("NaoSimulation")[0].advance(0.1)
        picture = device.getImageRemote(name)
        device.unsubscribe(name)
        pixels = np.frombuffer(bytes(picture[6]), np.uint8).reshape(picture[1], picture[0], 3)
        return pixels[..., 0].astype(int) - pixels[..., 1]

    seen = []
    for color in ("green", "red"):
        lights.fadeRGB("FaceLeds", color, 0.0)
        seen.append(redness())
    assert np.count_nonzero((seen[0] < -50) & (seen[1] > 50)) > 20


def test_a_robot_understands_what_another_says(robots):
    ears, voice = robots.of("ALSpeechRecognition")[0], robots.of("ALTextToSpeech")[1]
    ears.setVocabulary(["yes", "no", "hello", "goodbye"], False)
    ears.setAudioExpression(False)
    ears.subscribe("test")
    robots.of("NaoSimulation")[0].advance(0.5)
    said = voice.say("goodbye", _async=True)
    memory = robots.of("ALMemory")[0]
    robots.advance_until(lambda: said.isFinished() and memory.getData("LastWordRecognized")[0])
    assert memory.getData("LastWordRecognized")[0] == "goodbye"


def test_a_robot_hears_another_with_its_sonars_and_walks_into_it(made):
    robots = made("0,0,0; 0.42,-0.12,180")
    robots.wake()
    walks, stands = robots.of("NaoSimulation")
    sonar, memory, motion = (robots.of(name)[0] for name in ("ALSonar", "ALMemory", "ALMotion"))
    sonar.subscribe("test")
    walks.advance(0.5)
    assert 0.2 < memory.getData("Device/SubDeviceList/US/Left/Sensor/Value") < 0.45
    sonar.unsubscribe("test")
    pressed, before = [], stands.torsoPose()
    for event in ("LeftBumperPressed", "RightBumperPressed"):  # which may be short
        robots.server.servers[0].memory.listen(event, lambda value: value and pressed.append(value))
    motion.setExternalCollisionProtectionEnabled("All", False)
    motion.moveToward(0.8, 0.0, 0.0)
    robots.advance_until(lambda: pressed and math.dist(stands.torsoPose()[:2], before[:2]) > 0.002)


def test_robots_shut_down_one_by_one_and_stay_limp_in_a_new_world(made):
    robots = made()
    systems, simulation = robots.of("ALSystem"), robots.of("NaoSimulation")[1]
    robots.wake()
    left = threading.Event()
    robots.sessions[0].disconnected.connect(lambda *_: left.set())

    def stiff():
        """Whether each robot has stiff joints."""
        return [any(server.runner.snapshot.stiffnesses) for server in robots.server.servers]

    systems[0].shutdown()
    assert left.wait(PATIENCE) and not robots.server.ended.is_set()
    robots.advance_until(lambda: stiff() == [False, True])
    simulation.factoryReset()
    assert simulation.advance(0.1) == pytest.approx(0.1) and stiff() == [False, False]
    systems[1].shutdown()
    assert robots.server.ended.wait(PATIENCE)


def test_one_robot_is_a_server_of_its_own_where_it_is_put(tmp_path):
    server = open_server(ServerOptions(record_dir=tmp_path, places=parse_places("1,2,90")))
    assert isinstance(server, SimulatorServer) and server.simulation.shared.robots == [server.simulation]
    assert server.simulation.snapshot.torso.position[:2] == pytest.approx((1.0, 2.0), abs=0.02)
    server.simulation.close()


@pytest.mark.parametrize("options, problem", [
    ({"port": 65535}, "at most 65534 for the first robot"),
    ({"sound_card": True}, "more than one robot"),
    ({"places": parse_places("0,0")}, "one for each of the 2 robots"),
    ({"places": parse_places("0,0;0.1,0")}, "0.35 m or more"),
    ({"scene": Scene("lab"), "places": parse_places("0,0,0; 1,0,180")}, "robot 2 would be 0.0.* m inside 'table'"),
])  # fmt: skip
def test_what_several_robots_cannot_have_is_refused(tmp_path, options, problem):
    with pytest.raises((BadValue, NotAllowed), match=problem):
        RobotsServer(ServerOptions(record_dir=tmp_path, robots=2, **options))
