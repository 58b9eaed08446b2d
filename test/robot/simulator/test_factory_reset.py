"""A factory reset: whatever clients have changed, the server is as one that has just been started."""

import gc
import os
import queue
import re
import shutil
import threading
import weakref

import numpy as np
import pytest
from simulator import PATIENCE, Simulator

import naoqi
from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.naoqi.binding.api import module_methods
from nao_sim_bridge.sound.files import write_sound
from nao_sim_bridge.testing import wait_until

READS = re.compile(
    "get|is|are|has|list|show|locale|timezone|robotName|focusedActivity|robotIsWakeUp|default|behaviors|areNot"
)
OF_THE_COMPUTER = {
    "getGlobalModuleList",
    "getRemainingRam",
    "totalMemory",
    "freeMemory",
    "isStatsEnabled",
    "isTraceEnabled",
}
TAKE_TIME = {"isItDark"}
MINE = "behaviors:\n  mine/look:\n    do: [{frames: [{time: 0.4, angles: {HeadYaw: 0.4}}]}]\n"
RED_LED = "Device/SubDeviceList/Face/Led/Red/Left/0Deg/Actuator/Value"
TEMPERATURE, ARMS = "Device/SubDeviceList/HeadYaw/Temperature/Sensor/Value", "Arms"
PROTECTED = "ALMotion.getExternalCollisionProtectionEnabled(ARMS)"

# What a client changes; and what shows it, where no getter without arguments does.
CHANGES = [
    ("ALMemory.insertData('Test/Own', 5)", "ALMemory.getData('Test/Own')"),
    ("ALMemory.declareEvent('Test/Event', 'Tester')", "ALMemory.getExtractorEvent('Tester')"),
    ("ALMemory.raiseMicroEvent('Test/Micro', 1)", ""),
    ("ALMemory.setDescription('footContact', 'changed')", "ALMemory.getDescriptionList(['footContact'])"),
    ("ALMemory.subscribeToEvent('UserTouched', 'Tester', 'on')", "ALMemory.getSubscribers('UserTouched')"),
    ("ALLeds.createGroup('Mine', ['FaceLeds'])", ""),
    ("ALLeds.setIntensity('FaceLeds', 0.25)", "ALMemory.getData(RED_LED)"),
    ("ALMotion.wakeUp()", ""),
    ("ALMotion.setAngles('HeadYaw', 0.3, 0.5)", "ALMotion.getAngles('HeadYaw', False)"),
    ("ALMotion.setOrthogonalSecurityDistance(0.1)", ""),
    ("ALMotion.setExternalCollisionProtectionEnabled(ARMS, False)", PROTECTED),
    ("ALMotion.setCollisionProtectionEnabled('LArm', False)", "ALMotion.getCollisionProtectionEnabled('LArm')"),
    ("ALMotion.setMoveArmsEnabled(False, True)", ""),
    ("ALMotion.setSmartStiffnessEnabled(False)", ""),
    ("ALMotion.setBreathConfig([['Bpm', 12.0]])", ""),
    ("ALTextToSpeech.setVolume(0.5)", ""),
    ("ALTextToSpeech.setParameter('pitchShift', 1.5)", "ALTextToSpeech.getParameter('pitchShift')"),
    ("ALTextToSpeech.addToDictionary('nao', 'now')", ""),
    ("ALAnimatedSpeech.setBodyLanguageMode(0)", ""),
    ("ALBackgroundMovement.setEnabled(True)", ""),
    ("ALSpeakingMovement.setMode('random')", ""),
    ("ALAudioDevice.setOutputVolume(31)", ""),
    ("ALAudioDevice.muteAudioOut(True)", ""),
    ("ALAudioDevice.closeAudioInputs()", ""),
    ("ALAudioPlayer.loadFile('tone.wav')", ""),
    ("ALAudioPlayer.setMasterVolume(0.4)", ""),
    ("ALAudioRecorder.startMicrophonesRecording('heard.wav', 'wav', 16000, [0, 0, 1, 0])", ""),
    ("ALSpeechRecognition.setAudioExpression(False)", ""),
    ("ALSpeechRecognition.setVocabulary(['yes', 'no'], False)", ""),
    ("ALSpeechRecognition.setParameter('Sensitivity', 0.7)", "ALSpeechRecognition.getParameter('Sensitivity')"),
    ("ALSpeechRecognition.subscribe('Tester')", ""),
    ("ALSoundDetection.subscribe('Tester')", ""),
    ("ALSoundLocalization.pause(True)", ""),
    ("ALFaceDetection.setRecognitionConfidenceThreshold(0.9)", ""),
    ("ALFaceDetection.setTrackingEnabled(False)", ""),
    ("ALFaceDetection.subscribe('Tester', 500, 0.0)", "ALFaceDetection.getMyPeriod('Tester')"),
    ("ALLandMarkDetection.setResolution(2)", ""),
    ("ALBarcodeReader.pause(True)", ""),
    ("ALMovementDetection.setColorSensitivity(0.4)", ""),
    ("ALVideoDevice.subscribeCamera('Tester', 0, 1, 13, 5)", ""),
    ("ALVideoDevice.setActiveCamera(1)", ""),
    ("ALVideoDevice.setParameter(0, 0, 90)", "ALVideoDevice.getParameter(0, 0)"),
    ("ALPhotoCapture.setPictureFormat('png')", ""),
    ("ALVideoRecorder.setFrameRate(7.0)", ""),
    ("ALVideoRecorder.startRecording('.', 'film')", ""),
    ("ALSonar.subscribe('Tester')", ""),
    ("ALBodyTemperature.setEnableNotifications(False)", ""),
    ("ALDiagnosis.setEnableNotification(False)", ""),
    ("ALTactileGesture.createGesture(['000', '110', '000'])", ""),
    ("ALBasicAwareness.setTrackingMode('MoveContextually')", ""),
    ("ALBasicAwareness.setEngagementMode('FullyEngaged')", ""),
    ("ALBasicAwareness.setParameter('LookStimulusSpeed', 0.9)", "ALBasicAwareness.getParameter('LookStimulusSpeed')"),
    ("ALAutonomousMoves.setBackgroundStrategy('none')", ""),
    ("ALAutonomousLife.setState('solitary')", ""),
    ("ALAutonomousLife.setRobotOffsetFromFloor(0.5)", ""),
    ("ALTracker.registerTarget('RedBall', 0.06)", ""),
    ("ALTracker.setMode('WholeBody')", ""),
    ("ALTracker.setTimeOut(999)", ""),
    ("ALBehaviorManager.installBehavior('mine.yaml')", ""),
    ("ALBehaviorManager.addDefaultBehavior('mine/look')", ""),
    ("ALSystem.setRobotName('other')", ""),
    ("ALSystem.setTimezone('Asia/Tokyo')", ""),
    ("ALPreferenceManager.setValue('chess', 'level', 'hard')", ""),
    ("ALKnowledge.add('things', 'sky', 'colour', 'blue')", "ALKnowledge.query('things', 'sky', 'colour', '?')"),
    ("ALLogger.setVerbosity('debug')", "ALLogger.verbosity()"),
    ("ALResourceManager.acquireResource('Head', 'Tester', '', 0)", "ALResourceManager.ownersGet()"),
    ("ALNotificationManager.add({'message': 'hello'})", "ALNotificationManager.notifications()"),
    ("ALConnectionManager.setCountry('DE')", "ALConnectionManager.country()"),
    ("NaoSimulation.placeObject('{name: mark, landmark: 64, position: [1, 0, 0.4]}')", "NaoSimulation.objects()"),
    ("NaoSimulation.addSound('hum', 'tone:440', [1, 0, 1], 60.0, True)", "NaoSimulation.sounds()"),
    ("NaoSimulation.breakDevice('HeadPitch')", ""),
    ("NaoSimulation.setBatteryCharge(0.2)", ""),
    ("NaoSimulation.setTemperature('HeadYaw', 50.0)", "ALMemory.getData(TEMPERATURE)"),
]  # fmt: skip
OBSERVED = [shown for _, shown in CHANGES if shown] + ["NaoSimulation.torsoPose()", "NaoSimulation.time()"]


def done(robot, call):
    """What a call answers, or the error as text without what it would have wanted."""
    try:
        return eval(f"robot.{call}", globals(), {"robot": robot})
    except RuntimeError as error:
        return f"error: {str(error)[:60]}"


def posted(robot, call):
    """The future of a call."""
    module, method, arguments = re.fullmatch(r"(\w+)\.(\w+)\((.*)\)", call).groups()
    return robot.post(module, method, *eval(f"({arguments},)" if arguments else "()"))


def everything(robot):
    """All that can be read: every getter without arguments, all keys with their values, and what `CHANGES` shows."""
    state = {call: done(robot, call) for call in OBSERVED}
    for module in robot.server.modules():
        for name, method in module_methods(module).items():
            bare = any(not overload.types for overload in method.overloads)
            if bare and READS.match(name) and name not in OF_THE_COMPUTER | TAKE_TIME:
                state[f"{module}.{name}()"] = done(robot, f"{module}.{name}()")
    keys = robot.ALMemory.getDataListName()
    state["keys"] = robot.ALMemory.getDescriptionList(keys)
    state.update((f"key {key}", value) for key, value in zip(keys, robot.ALMemory.getListData(keys)))
    return {name: str(value).replace(str(robot.server.files.folder), "FOLDER") for name, value in state.items()}


@pytest.fixture
def changed(robot):
    """A robot of which nothing is as it was."""
    folder = robot.server.files.folder
    write_sound(folder / "tone.wav", Sound(np.zeros((RATE, 1), np.float32), RATE))
    (folder / "mine.yaml").write_text(MINE)
    before = everything(robot)
    calls = {change: posted(robot, change) for change, _ in CHANGES}
    robot.advance(0.5)
    assert {change: call.error() for change, call in calls.items() if not call.isRunning() and call.hasError()} == {}
    after = everything(robot)
    assert not [shown for _, shown in CHANGES if shown and before[shown] == after[shown]]
    return robot


def test_nothing_is_left_of_what_was_changed(changed, tmp_path):
    calls = [
        changed.post("ALTextToSpeech", "say", "a text that is not over"),
        changed.post("ALMemory", "getDataOnChange", "Test/Own", 0),
    ]
    changed.handed_over("ALTextToSpeech")
    changed.server.factory_reset()
    for call in calls:
        changed.answer(call)  # pending calls end, as if they were killed
    new = Simulator(tmp_path, speed=float("inf"))
    try:
        for simulator in (new, changed):
            simulator.ALMemory.subscriber("ALMemory/KeyAdded")  # who has ever listened is told after a reset as well
        for seconds in (0.0, 1.0):
            new.advance(seconds)
            changed.advance(seconds)
            was, wanted = everything(changed), everything(new)
            for state in (was, wanted):
                state.pop("key ALMemory/KeyAdded", None)  # tells which module was quicker
            assert {name: value for name, value in was.items() if value != wanted.get(name)} == {}
            assert was.keys() == wanted.keys()
    finally:
        new.close()
    assert sorted(path.name for path in changed.server.files.folder.iterdir()) == ["mine.yaml", "tone.wav"]


def test_links_of_clients_go_on_and_subscriptions_by_name_do_not(robot):
    heard, gestures = robot.heard("FrontTactilTouched"), robot.heard("ALTactileGesture/Gesture")
    signal, named = [], robot.heard("Test/Event")
    robot.ALTactileGesture.onGesture.connect(signal.append)
    robot.ALMemory.subscribeToEvent("FrontTactilTouched", "Nobody", "on")
    for _ in range(2):
        store = robot.server.memory
        robot.server.factory_reset()
        store.raise_event("FrontTactilTouched", 7.0)  # what still ran for the former robot is not heard
        assert robot.ALMemory.getSubscribers("FrontTactilTouched") == []
        assert "Test/Event" not in robot.ALMemory.getEventList()
        robot.NaoSimulation.press(["Head/Touch/Front"])
        robot.advance(0.1)
        robot.NaoSimulation.press([])
        robot.advance(1.5)
        assert [heard.get(timeout=PATIENCE), heard.get(timeout=PATIENCE)] == [1.0, 0.0]
        assert gestures.get(timeout=PATIENCE) == "SingleFront"
        robot.ALMemory.raiseEvent("Test/Event", "again")
        assert named.get(timeout=PATIENCE) == "again"
    assert heard.empty() and signal == ["SingleFront", "SingleFront"]


def test_a_client_learns_that_the_robot_has_started_again(robot):
    connection, states = naoqi.connection(*robot.address), queue.Queue()
    connection.add_listener(states.put)
    motion = robot.proxy("ALMotion")
    motion.setStiffnesses("Head", 1.0)
    ready = robot.heard("NAOqiReady")
    robot.server.factory_reset()
    assert [str(states.get(timeout=PATIENCE)) for _ in range(2)] == ["lost", "connected"]
    assert connection.generation == 2 and "started again" in connection.last_error
    assert motion.getStiffnesses("Head") == [0.0, 0.0]
    ready.get(timeout=PATIENCE)
    robot.server.reset()  # another matter
    assert ready.empty() and states.empty()


def test_a_session_that_is_over_is_forgotten(robot):
    connection, states = naoqi.connection(*robot.address), queue.Queue()
    robot.proxy("ALMotion").robotIsWakeUp()
    old = weakref.ref(connection.live)
    connection.add_listener(states.put)
    robot.server.factory_reset()
    assert [str(states.get(timeout=PATIENCE)) for _ in range(2)] == ["lost", "connected"]
    wait_until(lambda: gc.collect() >= 0 and old() is None, PATIENCE, "the session that nobody needs any more")


def test_equal_runs_are_equal_to_the_last_bit(robot):
    def run():
        robot.fresh()
        robot.post("ALMotion", "wakeUp")
        robot.post("ALAnimatedSpeech", "say", "^start(animations/Stand/Gestures/Hey_1) hello")
        robot.post("ALLeds", "randomEyes", 5.0)
        for module in ("ALMotion", "ALAnimatedSpeech", "ALLeds"):
            robot.handed_over(module)
        camera = robot.ALVideoDevice.subscribeCamera("Test", 0, 1, 11, 10)
        robot.ALAudioDevice.startMicrophonesRecording("heard.wav")
        robot.advance(2.0)
        task = robot.ALMotion.pCall("openHand", "LHand")
        robot.ALAudioDevice.stopMicrophonesRecording()
        picture = robot.post("ALVideoDevice", "getImageRemote", camera)
        robot.handed_over("ALVideoDevice")
        robot.advance(0.2)
        heard = (robot.server.files.folder / "heard.wav").read_bytes()
        lit = [robot.ALLeds.getIntensity(led) for led in robot.ALLeds.listLEDs()]
        return robot.now, heard, robot.answer(picture)[6], robot.ALMotion.getTaskList(), task, lit

    now, *rest = run()
    again, *rest_again = run()
    assert (again.tick, again.positions, again.torso, again.imu) == (now.tick, now.positions, now.torso, now.imu)
    assert now.time == pytest.approx(2.2)
    assert rest_again == rest


def test_a_reset_to_a_world_is_a_factory_reset_there(robot):
    simulation = robot.NaoSimulation
    robot.ALMemory.insertData("Test/Own", 5)
    robot.advance(0.5)
    simulation.reset("lab")
    assert "table" in simulation.objects() and simulation.time() == 0.0
    assert "Test/Own" not in robot.ALMemory.getDataListName()
    simulation.moveObject("ball", [1.0, 1.0, 0.5], [], 0.0)
    simulation.reset()  # in the world that it is in
    assert simulation.objects()["ball"] != [1.0, 1.0, 0.5, 0.0, 0.0, 0.0]
    with pytest.raises(RuntimeError, match="no world 'nowhere'.*lab"):
        simulation.reset("nowhere")
    assert "table" in simulation.objects()
    simulation.reset("")
    assert simulation.objects() == {}


def test_a_world_of_a_file_is_read_anew(robot, world_file):
    file = robot.server.files.folder / "crate.yaml"
    shutil.move(world_file("{name: crate, box: [0.2, 0.2, 0.2], position: [1, 0, 0.1]}"), file)
    robot.NaoSimulation.reset("crate.yaml")
    assert list(robot.NaoSimulation.objects()) == ["crate"]
    before = robot.NaoSimulation.picture("far", 64, 48)
    shutil.move(world_file("{name: crate, box: [0.2, 0.2, 1.2], position: [1, 0, 0.6]}"), file)
    robot.NaoSimulation.reset(str(file))
    assert robot.NaoSimulation.objects()["crate"][2] == pytest.approx(0.6)
    assert robot.NaoSimulation.picture("far", 64, 48) != before
    with pytest.raises(RuntimeError, match="no world file '/etc/secret.yaml' in .*"):
        robot.NaoSimulation.reset("/etc/secret.yaml")
    file.unlink()


def test_pending_calls_and_posted_calls_end(robot):
    robot.ALMotion.setStiffnesses("Head", 1.0)
    calls = [
        robot.post("ALMotion", "angleInterpolation", "HeadYaw", 0.5, 5.0, True),
        robot.post("ALTextToSpeech", "say", "a text that is not over"),
        robot.post("ALMemory", "getDataOnChange", "footContactChanged", 0),
        robot.post("ALPhotoCapture", "takePictures", 5, "", "photo"),
        robot.post("NaoSimulation", "touch", "Head/Touch/Front", 5.0),
    ]
    for module in ("ALMotion", "ALTextToSpeech", "ALMemory", "ALPhotoCapture"):
        robot.handed_over(module)
    robot.advance(0.1)
    advance = robot.post("NaoSimulation", "advance", 5000.0)
    robot.server.factory_reset()
    assert [call.wait(int(1000 * PATIENCE)) for call in calls] != [1] * len(calls)
    assert not any(call.isRunning() for call in calls)
    with pytest.raises(RuntimeError, match="NaoSimulation::advance was ended by a reset after"):
        robot.answer(advance)
    assert robot.ALMotion.getTaskList() == []
    assert robot.ALMotion.getAngles("HeadYaw", True) == pytest.approx([0.0], abs=0.01)


def test_speed_and_pause_are_of_whoever_runs_it_and_his_time_goes_on(robot):
    robot.advance(1.0)
    began, speed = robot.server.now[1], robot.NaoSimulation.speed()
    robot.server.factory_reset()
    assert robot.now.time == 0.0 and robot.server.now[1] == pytest.approx(began)
    assert robot.NaoSimulation.isPaused() and robot.NaoSimulation.speed() == speed
    robot.advance(0.5)
    assert robot.server.now[1] == pytest.approx(began + 0.5)


def test_a_film_is_completed_and_stays_what_modules_wrote_goes(robot):
    folder = robot.server.files.folder
    (folder / "mine.txt").write_text("kept")
    robot.NaoSimulation.startFilm("film.mp4", "", 64, 48, 5.0)
    robot.ALAudioDevice.startMicrophonesRecording("sub/heard.wav")
    robot.ALTextToSpeech.sayToFile("hello", "said.wav")
    robot.finish("ALPhotoCapture", "takePicture", "shots", "photo", after=0.3)
    robot.advance(0.5)
    assert {"said.wav", "shots", "sub"} <= {path.name for path in folder.iterdir()}
    robot.server.factory_reset()
    assert sorted(path.name for path in folder.iterdir()) == ["film.mp4", "mine.txt"]
    assert (folder / "film.mp4").stat().st_size > 1000


def test_many_resets_leave_nothing_behind(robot):
    def use():
        robot.post("ALMotion", "wakeUp")
        robot.post("ALTextToSpeech", "say", "hello")
        robot.ALSonar.subscribe("Test")
        robot.ALAudioDevice.startMicrophonesRecording("heard.wav")
        robot.ALVideoDevice.subscribeCamera("Test", 0, 1, 11, 10)
        robot.heard("FrontTactilTouched")
        robot.advance(0.05)
        robot.server.factory_reset()

    def left():
        return threading.active_count(), len(os.listdir("/proc/self/fd"))

    use(), use()
    first = left()
    for _ in range(17):
        use()
    wait_until(lambda: all(now <= then for now, then in zip(left(), first)), 60.0, "the end of what resets left")
