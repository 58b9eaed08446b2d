"""Programs of NAOqi 1.6 to 2.1: what they call is there beside what there is today, and does what it did."""

import logging

import pytest
import qi
from simulator import PATIENCE, connected

from nao_sim_bridge.naoqi.binding.api import older_tables
from nao_sim_bridge.naoqi.binding.older import older_methods

ROBOT = 2


def test_a_program_of_naoqi_1_6_moves_joints(stiff_robot):
    body = stiff_robot.ALMotion
    stiff_robot.finish("ALMotion", "gotoAngle", "HeadYaw", 0.4, 1.0, 1, after=1.1)
    assert body.getAngle("HeadYaw") == pytest.approx(0.4, abs=0.02)
    stiff_robot.finish("ALMotion", "gotoChainAnglesWithSpeed", "Head", [-0.2, 0.1], 50.0, 1, after=1.0)
    assert body.getChainCommandAngles("Head") == pytest.approx([-0.2, 0.1], abs=1e-3)
    stiff_robot.finish("ALMotion", "setBodyStiffness", 0.5, after=0.1)
    assert body.getBodyStiffnesses() == [0.5] * 26 and body.getBodyJointNames() == body.getBodyNames("Body")


def test_a_program_of_naoqi_1_14_swings_no_arms_and_makes_a_step(stiff_robot):
    body = stiff_robot.ALMotion
    stiff_robot.finish("ALMotion", "setWalkArmsEnable", False, True, after=0.1)
    assert body.getWalkArmsEnable() == [False, True] == [body.getMoveArmsEnabled(arm) for arm in ("LArm", "RArm")]
    before = body.getRobotPosition(False)
    assert stiff_robot.finish("ALMotion", "stepTo", "LLeg", 0.04, 0.1, 0.0, after=4.0) is None
    assert body.getRobotPosition(False)[0] - before[0] == pytest.approx(0.02, abs=0.005)


def test_the_log_names_what_to_call_today_once(robot, caplog):
    with caplog.at_level(logging.WARNING):
        for _ in range(2):
            robot.ALMotion.getJointLimits("HeadPitch")
    told = [r.getMessage() for r in caplog.records if "getJointLimits" in r.getMessage()]
    assert told == ["ALMotion.getJointLimits is an older name: of NAOqi 1.6 and before; today it is getLimits"]


def test_older_methods_are_real_ones_with_their_types(robot):
    methods = robot.ALMotion.metaObject()["methods"].values()
    found = {(m["name"], m["parametersSignature"], m["returnSignature"]) for m in methods}
    assert {("stepTo", "(sfff)", "v"), ("setWalkArmsEnable", "(bb)", "v"), ("setWalkArmsEnable", "(b)", "v")} <= found
    assert {name for name, *_ in found} >= set(older_methods("ALMotion"))
    with pytest.raises(RuntimeError, match="angle is 'x', allowed is a number"):
        robot.ALMotion.gotoAngle("HeadYaw", "x", 1.0, 1)


@pytest.mark.parametrize("subscribe, heard", [("subscribeOnData", [1, 1, 2]), ("subscribeOnDataChange", [1, 2])])
def test_values_that_are_written_are_told_each_time_or_when_they_change(robot, listener, subscribe, heard):
    memory = robot.ALMemory
    memory.call(subscribe, "Test/Number", "Listener", "text", "onEvent")
    for value in (1, 1, 2):
        memory.insertData("Test/Number", value)
    assert [listener.next() for _ in heard] == [("Test/Number", value, "text") for value in heard]
    memory.call("un" + subscribe, "Test/Number", "Listener")
    assert memory.getSubscribers("Test/Number") == []


class OldEars:
    """A module of NAOqi 1.10 that is sent sound."""

    def __init__(self):
        self.promise = qi.Promise()

    @qi.bind(qi.Void, [qi.Int32, qi.Int32, "r"])
    def processSoundRemote(self, channels, frames, buffer):
        if self.promise.future().isRunning():
            self.promise.setValue([channels, frames, len(buffer)])


def test_a_module_of_naoqi_1_10_hears(robot):
    ears, session = OldEars(), connected(robot.port)
    session.listen("tcp://127.0.0.1:0")
    session.registerService("OldEars", ears)
    assert robot.ALAudioDevice.subscribeRemoteModule("OldEars") is True
    robot.advance(0.5)
    channels, frames, size = ears.promise.future().value(int(PATIENCE * 1000))
    assert size == 2 * channels * frames > 0
    assert robot.ALAudioDevice.unSubscribeRemoteModule("OldEars") is True
    session.close()


def test_a_red_ball_is_followed_as_before_altracker(stiff_robot):
    ball = stiff_robot.ALRedBallTracker
    stiff_robot.NaoSimulation.placeObject("{name: ball, ball: 0.03, position: [1.0, 0.2, 0.45], mass: 0.0}")
    assert (ball.isActive(), ball.isNewData(), ball.getPosition()) == (False, False, [])
    ball.startTracker()
    stiff_robot.advance(0.6)
    assert ball.isActive() and ball.isNewData() and stiff_robot.ALTracker.getActiveTarget() == "RedBall"
    assert not stiff_robot.ALFaceTracker.isActive()
    assert ball.getPosition() == pytest.approx([1.0, 0.2, 0.45], abs=0.05) and not ball.isNewData()
    ball.setWholeBodyOn(True)
    assert stiff_robot.ALTracker.getMode() == "WholeBody"
    ball.stopTracker()
    stiff_robot.advance(0.1)
    assert not ball.isActive() and not stiff_robot.ALTracker.isActive()


def test_the_chest_button_introduces_the_robot_when_that_is_wanted(robot):
    sentinel = robot.ALSentinel
    said = robot.heard("ALTextToSpeech/CurrentSentence")
    clicked = robot.heard("ALSentinel/SimpleClickOccured")
    assert (sentinel.getBatteryLevel(), sentinel.getBatteryLevelDesc()) == (5, "My battery is at 100 percent")
    for wanted in (False, True):
        sentinel.enableDefaultActionSimpleClick(wanted)
        for sensors in (["ChestBoard/Button"], []):
            robot.NaoSimulation.press(sensors)
            robot.advance(0.2)
        robot.advance(2.0)
    assert [clicked.get(timeout=PATIENCE) for _ in range(2)] == [None, None]
    assert next(filter(None, iter(lambda: said.get(timeout=PATIENCE), ...))) == "Hello, I am nao."
    with pytest.raises(RuntimeError, match="call ALSystem.reboot"):
        sentinel.enableDefaultActionTripleClick(True)


def test_the_toolbox_takes_three_pictures_and_a_video(robot):
    toolbox, folder = robot.ALVisionToolbox, robot.server.files.folder
    robot.finish("ALVisionToolbox", "takePicture", after=1.5)
    assert len(list(folder.rglob("image_*.jpg"))) == 3
    robot.finish("ALVisionToolbox", "startVideoRecord", "old", after=0.2)
    robot.advance(0.5)
    assert toolbox.isVideoRecording()
    frames, path = robot.finish("ALVisionToolbox", "stopVideoRecord", after=0.2)
    assert frames > 3 and path.endswith("old.avi") and not toolbox.isVideoRecording()
    with pytest.raises(RuntimeError, match="stopVideoRecord ends the video"):
        toolbox.startVideoRecord_adv("x", 15.0, "MJPG", 1, 10)


def test_every_older_module_is_there_and_has_all_its_methods(robot):
    for module, entry in older_tables()["modules"].items():
        methods = set(getattr(robot, module).getMethodList())
        assert methods >= {name for name in entry if not name.startswith("_")}, module
