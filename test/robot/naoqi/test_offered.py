"""Which of NAOqi's methods the robot answers: each is called with sensible arguments and with hostile ones."""

import random
import re
import zlib

import pytest
from naoqi_calls import read_calls

from nao_sim_bridge.naoqi.binding.api import COMMON, module_methods
from nao_sim_bridge.naoqi.binding.binding import DEFECT, NATIVE, offered, published_methods
from nao_sim_bridge.naoqi.binding.older import older_methods

LONGEST = 8.0
"""No call takes longer than this, in s of simulated time."""
# Answered, but not with success, or not by a robot that is still needed: tests of their own.
ELSEWHERE = {
    "ALAudioDevice": "sendLocalBufferToOutput",
    "ALAudioPlayer": "playFileInLoop playInLoop playWebStream",
    "ALNavigation": "explore findFreeZone getExplorationPath getFreeZone getMetricalMap getRobotPositionInMap "
    "loadExploration navigateToInMap relocalizeInMap relocalizeInMapWithHint saveExploration setDefaultExploration "
    "startFreeZoneUpdate startLocalization startMapping stopAndComputeFreeZone stopExploration stopLocalization",
    "ALMemory": "getDataOnChange getDataPtr getFloatPtr getIntPtr",
    "ALVisionRecognition": "detectFromFile learnFromFile",
    "ALMovementDetection": "setDepthSensitivity",
    "ALSpeechRecognition": "activateAllRules activateRule addContext addWordListToSlot compile deactivateAllRules "
    "deactivateRule getContextParam getRules loadContextSet loadVocabulary popContexts removeContext "
    "removeWordListFromSlot setContextParam",
    "ALPreferenceManager": "importPrefFile update",
    "ALConnectionManager": "setServiceInput",
    "ALLauncher": "launchExecutable launchPythonModule launchScript",
    "ALLogger": "logInForwarder logInSys",
    "ALStore": "stopUpdate update",
    "ALUserSession": "getCurrentEncounterDate getFirstEncounterDate getLastEncounterDate getSecondsSinceLastEncounter "
    "getUserBinding getUserBindings getUserCreationDate getUserData setUserData",
    "ALUserInfo": "get getType has remove removeUser set",
    "PackageManager": "getPackage getPackageIcon install installCheckMd5 package package2 packageIcon removePkg",
    "ALSystem": "changePassword factoryReset setRobotIcon shutdown upgrade",
    "DCM": "calibration special",
    "ALVideoDevice": "getDirectRawImageLocal getDirectRawImagesLocal getImageLocal getImagesLocal",
    "ALAnimatedSpeech": "declareAnimationsPackage",
    "ALTextToSpeech": "loadVoicePreference",
    "ALBehaviorManager": "installBehavior removeBehavior",
    "ALFrameManager": "completeBehavior createBehavior deleteBehavior exitBehavior getBehaviorPath getMotionLength "
    "isBehaviorRunning newBehaviorFromChoregraphe newBehaviorFromFile playBehavior playTimeline stopTimeline",
}
# What NAOqi has had no use for since 1.14, and what the robot itself calls when its modules are there.
MISSING = {"ALFrameManager": "getTimelineFps gotoAndPlay gotoAndStop setTimelineFps", "ALAutonomousLife": "onReady"}


CALLS = read_calls()


def fits(kind, value):
    """Whether a value is of a type of NAOqi's table."""
    name, _, inner = kind.partition("<")
    if name == "list":
        return isinstance(value, (list, tuple)) and all(fits(inner[:-1], entry) for entry in value)
    simple = {"bool": bool, "int": int, "string": str, "float": (int, float), "map": dict, "tuple": (list, tuple)}
    if name == "void":
        return value is None
    wrong_kind = isinstance(value, bool) and name in ("int", "float")
    return name not in simple or (isinstance(value, simple[name]) and not wrong_kind)


def equal(value, wanted):
    """Whether an answer is what the table says, floats in single precision."""
    if isinstance(wanted, (list, tuple)):
        same = isinstance(value, (list, tuple)) and len(value) == len(wanted)
        return same and all(map(equal, value, wanted))
    if isinstance(wanted, float):
        return value == pytest.approx(wanted, abs=1e-4, rel=1e-3)
    return value == wanted and type(value) is type(wanted)


SET_UP = {
    "*stiff": lambda robot: robot.ALMotion.setStiffnesses("Body", 1.0),
    "*standing": lambda robot: (robot.NaoSimulation.reset(), robot.ALMotion.setStiffnesses("Body", 1.0)),
    "*loop": lambda robot: (robot.post("ALAudioPlayer", "playInLoop", 1), robot.handed_over("ALAudioPlayer")),
}


def called(robot, module, method, arguments):
    """The answer of a call, while time passes as it needs it."""
    future = robot.post(module, method, *arguments)
    robot.handed_over(module)
    robot.advance_until(lambda: not future.isRunning(), LONGEST, 0.1, f"{module}.{method} answers")
    return robot.answer(future)


@pytest.mark.parametrize("module", CALLS)
def test_a_module_answers_all_its_methods_with_values_of_their_types(robot, listener, module):
    count, calls = CALLS[module]
    answered, missing = (
        set(names) - set(module_methods(COMMON)) for names in offered(module, robot.server.modules()[module])
    )
    assert missing == set(MISSING.get(module, "").split()) and count in (None, len(answered))
    apart = {method for method, *_ in calls if method[0] == "*"} | {"advance"} | set(ELSEWHERE.get(module, "").split())
    assert answered == ({method for method, *_ in calls} | apart) - set(SET_UP) - {"advance"}
    wrong = []
    for method, arguments, kind, wanted in calls:
        if method == "advance":
            robot.advance(*arguments)
        elif method in SET_UP:
            SET_UP[method](robot)
            robot.advance(0.2)
        else:
            answer = called(robot, module, method, arguments)
            good = equal(answer, wanted) if kind == "=" else kind is None or len(answer) == wanted
            if not (good and fits(module_methods(module)[method].returns, answer)):
                wrong.append((method, arguments, answer, wanted))
    assert wrong == []


NAN, INF = float("nan"), float("inf")
HOSTILE = [
    *("", "x", "Body", "HeadYaw", "nan", "\n", "../..", "\u00e9\u4e16", "a" * 3000),
    *(None, True, False, NAN, INF, -INF, -1.0, 1e300, 0, 1, -1, 2**31 - 1, -(2**31), 2**63 - 1),
    *([], [[]], [[[[]]]], [""], [None], [True], [NAN], [{}], [1, "a"], ["HeadYaw", 3], ["HeadYaw", None], [1.0] * 7),
    *([[1, 2], [3]], [[["HeadYaw"]]], [["a", {}]], [[0.1, 0.2], ["a", [None]]], ["a", "b", "c"], [0.1, 0.2, 0.3]),
    *({}, {"a": 1}, {"a": {"b": [1]}}, {1: 2}),
]
ENDS = {"exit", "shutdown"}
"""These end what is tested."""
ROUNDS, VALID = 2, 0.3
"""Share of arguments that are right: else nothing behind the first check would be reached."""
SIMULATION = "NaoSimulation"
PYTHON = re.compile(
    r"Traceback|NoneType|object (is not|has no|does not|of type|cannot)|has no attribute|not iterable|unhashable|"
    r"(Key|Type|Value|Index|Attribute|Overflow|Unicode\w*|Recursion)Error|(positional|keyword) argument|"
    r"could not convert|invalid literal|not supported between|unsupported operand|to unpack|out of range|"
    r"must be (real|str|int|a real)|math domain|indices must|not subscriptable|cannot be interpreted|codec can't|"
    r"broadcast|inhomogeneous|\[Errno|" + DEFECT
)


def hostile(chance, depth=0):
    """Something of `HOSTILE`, or a list of such things."""
    if depth < 3 and chance.random() < 0.2:
        return [hostile(chance, depth + 1) for _ in range(chance.randrange(4))]
    return chance.choice(HOSTILE)


def ways_to_call(robot, module):
    """Method, number of parameters and valid arguments, as far as they are known, of each way to call a module."""
    if module == SIMULATION:
        own = {"advance", "setSpeed", "resume", "factoryReset", "reset"}  # time and world are the test's own
        for method in robot.NaoSimulation.metaObject()["methods"].values():
            if method["uid"] >= 100 and method["name"] not in own:
                yield method["name"], len(re.findall(r"\[?[a-z]\]?", method["parametersSignature"])), ()
        return
    known = {method: arguments for method, arguments, *_ in CALLS[module][1]}
    table = published_methods(module)
    for name in [*offered(module, robot.server.modules()[module])[0], *older_methods(module)]:
        if name not in NATIVE | ENDS and (module == "ALTouch" or name not in module_methods(COMMON)):
            for overload in table[name].overloads:
                yield name, len(overload.types), known.get(name, ())


@pytest.mark.parametrize("module", [*(module for module, (_, calls) in CALLS.items() if calls), SIMULATION])
def test_a_module_answers_hostile_arguments_in_words_of_its_own(robot, module):
    chance, calls = random.Random(zlib.crc32(module.encode())), []
    for name, count, valid in list(ways_to_call(robot, module)) * ROUNDS:
        arguments = [valid[i] if i < len(valid) and chance.random() < VALID else hostile(chance) for i in range(count)]
        calls.append((name, arguments, robot.post(module, name, *arguments)))
    robot.NaoSimulation.isPaused() if module == SIMULATION else robot.handed_over(module)
    robot.settled()
    begin = robot.now.time
    robot.advance(0.04)
    unfit = []
    for name, arguments, future in calls:
        if future.isRunning():
            future.cancel()
        elif future.hasError() and PYTHON.search(future.error()):
            unfit.append((name, arguments, future.error()))
    assert calls and unfit == []
    assert getattr(robot, "ALTouch" if module == SIMULATION else module).ping() is True
    assert robot.now.time > begin and robot.server.runner.running
