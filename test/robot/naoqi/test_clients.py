"""Programs of clients that are killed: what they subscribed under the name of their module ends, and nothing else."""

import subprocess
import sys
import time

import pytest
from simulator import PATIENCE

PROGRAM = """
import sys, time
import qi

class Module:
    def __init__(self):
        self.touched = qi.Signal("(m)")
    def onEvent(self, name, value, message):
        pass
    def processRemote(self, channels, frames, stamp, sound):
        pass

session = qi.Session()
session.connect("tcp://127.0.0.1:" + sys.argv[1])
session.listen("tcp://127.0.0.1:0")
module = Module()
session.registerService("Mortal", module)
memory = session.service("ALMemory")
for name in ("Mortal", "Staying"):
    memory.subscribeToEvent("Test/Event", name, "onEvent")
    for extractor in ("ALSonar", "ALSoundDetection", "ALFaceDetection"):
        session.service(extractor).call("subscribe", name, _async=True)
    session.service("ALVideoDevice").subscribeCamera(name, 0, 1, 13, 5)
memory.addMapping("Mortal", "touched", "Test/Touched")
memory.addMapping("Mortal", "touched", "Test/Touched")
session.service("ALAudioDevice").subscribe("Mortal")
print("ready", flush=True)
time.sleep(1000)
"""


@pytest.fixture
def mortal(robot):
    """A program whose module "Mortal" is subscribed everywhere, as "Staying" is."""
    command = [sys.executable, "-c", PROGRAM, str(robot.port)]
    program = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert any(line.strip() == "ready" for line in program.stdout)
    robot.advance(0.2)  # with the first shot of the sonars they are subscribed
    yield program
    program.kill()
    program.communicate()


def subscribed(robot):
    """Who is subscribed to what."""
    names = {
        "ALMemory": robot.ALMemory.getSubscribers("Test/Event"),
        "ALVideoDevice": robot.ALVideoDevice.getSubscribers(),
    }
    for extractor in ("ALSonar", "ALSoundDetection", "ALFaceDetection"):
        names[extractor] = [name for name, *_ in getattr(robot, extractor).getSubscribersInfo()]
    names["ALAudioDevice"] = robot.server._robot._audio.clients.names()
    return {module: sorted(known) for module, known in names.items()}


def mappings(robot):
    return robot.server.modules()["ALMemory"][0]._mappings


def test_of_a_program_that_is_killed_everything_ends_that_was_subscribed_for_its_module(robot, mortal):
    both = dict.fromkeys(("ALMemory", "ALSonar", "ALSoundDetection", "ALFaceDetection"), ["Mortal", "Staying"])
    assert subscribed(robot) == {**both, "ALVideoDevice": ["Mortal_0", "Staying_0"], "ALAudioDevice": ["Mortal"]}
    assert len(mappings(robot)) == 1
    mortal.kill()
    left = {**dict.fromkeys(both, ["Staying"]), "ALVideoDevice": ["Staying_0"], "ALAudioDevice": []}
    deadline = time.monotonic() + PATIENCE
    while (subscribed(robot) != left or mappings(robot)) and time.monotonic() < deadline:
        robot.ALMemory.ping()
    assert subscribed(robot) == left and not mappings(robot)
