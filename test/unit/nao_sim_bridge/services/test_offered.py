"""Which of NAOqi's methods the simulated robot answers: every one is called once with valid arguments."""

from __future__ import annotations

import pytest
from naoqi_calls import (
    BEFORE,
    CALLS,
    COMMON_CALLS,
    ELSEWHERE,
    EVENT,
    KEY,
    LOADED,
    POSTED,
    SOUND,
    WALKS,
)
from naoqi_calls_life import MISSING_IN_FRAMES, MISSING_IN_LIFE

from nao_sim_bridge.services.api import COMMON, module_methods
from nao_sim_bridge.services.binding import offered

LONGEST = 8.0
"""No call takes longer than this, in s of simulated time."""


@pytest.fixture
def answers(shared_robot):
    """Names of the methods that a module answers and those it does not, without the common ones."""
    common = set(module_methods(COMMON))

    def of(module):
        return [set(names) - common for names in offered(module, shared_robot.server.modules()[module])]

    return of


COMPLETE = [
    ("ALMemory", 32),
    ("ALLeds", 17),
    ("ALMotion", 104),
    ("ALRobotPosture", 8),
    ("ALAudioPlayer", 33),
    ("ALAudioDevice", 36),
    ("ALAudioRecorder", 2),
    ("ALTextToSpeech", 26),
    ("ALAnimatedSpeech", 12),
    ("ALAudioSourceLocalization", 16),
    ("ALSoundDetection", 16),
    ("ALSoundLocalization", 16),
    ("ALSpeechRecognition", 43),
    ("ALVideoDevice", 95),
    ("ALPhotoCapture", 16),
    ("ALVideoRecorder", 13),
    ("ALFaceDetection", 36),
    ("ALMovementDetection", 26),
    ("ALRedBallDetection", 12),
    ("ALLandMarkDetection", 22),
    ("ALBarcodeReader", 21),
    ("ALBehaviorManager", 26),
    ("ALAnimationPlayer", 5),
    ("ALAutonomousMoves", 6),
    ("ALBasicAwareness", 19),
    ("ALTracker", 51),
    ("ALTouch", 2),
    ("ALTactileGesture", 7),
    ("ALChestButton", 0),
    ("ALFsr", 0),
    ("ALSensors", 13),
    ("ALSonar", 13),
    ("ALBattery", 2),
    ("ALRobotModel", 1),
    ("ALRobotPose", 2),
    ("ALSystem", 18),
    ("DCM", 8),
    ("ALBodyTemperature", 3),
    ("ALDiagnosis", 5),
]


@pytest.mark.parametrize("module, count", COMPLETE)
def test_these_modules_answer_all_their_methods(answers, module, count):
    answered, missing = answers(module)
    assert missing == set()
    assert len(answered) == count


def test_life_and_frames_answer_all_but_what_nobody_calls(answers):
    assert answers("ALAutonomousLife")[1] == MISSING_IN_LIFE
    assert answers("ALFrameManager")[1] == MISSING_IN_FRAMES


@pytest.mark.parametrize("module", CALLS)
def test_every_method_that_is_answered_is_called_below(answers, module):
    assert answers(module)[0] == set(CALLS[module]) | ELSEWHERE.get(module, set())


def test_the_common_methods_are_called_below():
    assert set(module_methods(COMMON)) == set(COMMON_CALLS) | ELSEWHERE[COMMON]


@pytest.fixture
def prepared(shared_robot, shared_listener):
    """Keys, events, subscriptions and a posted call, which the calls are about."""
    memory = shared_robot.ALMemory
    memory.insertData(KEY, 0)
    memory.raiseEvent(EVENT, 0)
    memory.raiseMicroEvent("Test/Micro", 0)
    memory.subscribeToEvent(EVENT, "Listener", "onEvent")
    memory.subscribeToMicroEvent("Test/Micro", "Listener", "message", "onEvent")
    shared_robot.posted = {module: getattr(shared_robot, module).pCall("ping") for module in CALLS}
    shared_robot.loaded = shared_robot.ALAudioPlayer.loadFile(SOUND)
    shared_robot.ALAudioPlayer.pCall("playInLoop", shared_robot.loaded)
    video = shared_robot.ALVideoDevice
    video.subscribeCamera("Looker", 0, 1, 9, 15)
    video.subscribeCameras("Lookers", [0, 1], [1, 1], [9, 9], 15)
    yield shared_robot
    shared_robot.ALAudioPlayer.unloadAllFiles()
    for handle in video.getSubscribers():
        video.unsubscribe(handle)


@pytest.mark.parametrize("module, method", [(module, method) for module, calls in CALLS.items() for method in calls])
def test_a_method_answers(prepared, module, method):
    if method in WALKS:
        prepared.NaoSimulation.reset()
        prepared.ALMotion.setStiffnesses("Body", 1.0)
        prepared.advance(0.1)
    begun = prepared.now.time
    if (module, method) in BEFORE:
        prepared.advance(0.25)  # what the method before has begun is over
        getattr(prepared, module).call(*BEFORE[module, method])
        prepared.advance(0.25)  # and what this begins has begun: a film has a picture
    future = prepared.post(module, method, *(prepared.loaded if a is LOADED else a for a in CALLS[module][method]))
    prepared.handed_over(module)
    while future.isRunning() and prepared.now.time < begun + LONGEST:
        prepared.advance(0.25)
    prepared.answer(future)


@pytest.mark.parametrize("module", CALLS)
@pytest.mark.parametrize("method", COMMON_CALLS)
def test_a_common_method_answers_in_every_module(prepared, module, method):
    posted = prepared.posted[module]
    getattr(prepared, module).call(method, *(posted if a is POSTED else a for a in COMMON_CALLS[method]))
