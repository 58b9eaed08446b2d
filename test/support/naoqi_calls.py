"""Calls of NAOqi's methods and of the simulator's own with sensible arguments; `naoqi_calls.txt` lists most of them."""

import re
from pathlib import Path

TIMELINE = """<Timeline enable="1" fps="10"><ActuatorList><ActuatorCurve actuator="HeadYaw" mute="0" unit="0">
<Key frame="5" value="20" /></ActuatorCurve></ActuatorList></Timeline>"""
NAMES = {
    "HEAD": ["HeadYaw", "HeadPitch"],
    "HAND": [0.12, 0.12, 0.0, 0.0, 0.0, 0.0],  # the left one, in the frame of the torso
    "PLACE": [1.0, 0.0, 0.0, 0.12, 0.0, 1.0, 0.0, 0.12, 0.0, 0.0, 1.0, 0.0],
    "UNMOVED": [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    "CURVES": [[[0.1, [1, 0.0, 0.0], [1, 0.0, 0.0]]]] * 2,
    "EYES": [f"Face/Led/Red/{side}/0Deg/Actuator/Value" for side in ("Left", "Right")],
    "BIP": "nao_library/bip.ogg",
    "HEY": "animations/Stand/Gestures/Hey_1",
    "BREATHE": "nao_library/breathe",
    "TIMELINE": TIMELINE,
    "PROJECT": f'<ChoregrapheProject><Box name="a" id="1">{TIMELINE}</Box></ChoregrapheProject>',
}
CALL = re.compile(r"(\*?\w+)(?:\((.*)\)(?: ([=#]) (.*))?)?")


def read_calls():
    """Module -> number of its methods, and its calls: method, arguments, and how to compare with which value."""
    found = {}
    for line in Path(__file__).with_name("naoqi_calls.txt").read_text().splitlines():
        if not line.startswith((" ", "#")):
            module, *count = line.split()
            found[module] = (int(count[0]) if count else None, [])
        elif line.startswith(" "):
            for method, arguments, kind, value in (
                CALL.fullmatch(call).groups() for call in line.strip(" ;").split(" ; ")
            ):
                if method == "*Extractor":
                    found[module][1].extend(found["Extractor"][1])
                    continue
                arguments = eval(f"({arguments},)" if arguments else "()", dict(NAMES))
                found[module][1].append((method, arguments, kind, eval(value, dict(NAMES)) if value else None))
    del found["Extractor"]
    return found


ENDS = {"exit", "shutdown", "reboot", "factoryReset"}
"""These end what is tested, or begin it anew."""
SIMULATION = "NaoSimulation"
CHAIR = {"name": "chair", "box": [0.1, 0.1, 0.1], "position": [1.0, 1.0, 0.1]}
SHAPE = {"position": [1.0, 1.0, 0.5], "mass": 0.1, "friction": 0.8, "color": [1.0, 0.0, 0.0], "heading": 1.0}
OWN = [
    ("setSpeed", (1.0,)),
    ("advance", (0.1,)),
    ("push", ([1.0, 0.0, 0.0], 0.1, "torso")),
    ("touch", ("Head/Touch/Front", 0.1)),
    ("stroke", (["Head/Touch/Front", "Head/Touch/Rear"], 0.5)),
    ("picture", ("front", 64, 48)),
    ("setBatteryCharge", (0.5,)),
    ("setTemperature", ("Head", 40.0)),
    ("startFilm", ("film.mp4", "front", 160, 160, 20.0)),
    ("placeObject", ({"box": [0.1, 0.1, 0.1], **SHAPE},)),
    ("placeObject", ({"ball": 0.03, "position": [1.0, 1.0, 0.5]},)),
    ("placeObject", ({"cylinder": [0.02, 0.1], "rpy": [0.0, 0.0, 1.0], "position": [1.0, 1.0, 0.5]},)),
    ("placeObject", ({"face": "anna", "size": 0.2, "position": [1.0, 1.0, 0.5]},)),
    ("moveObject", ("chair", [1.0, 1.0, 0.1], [0.0, 0.0, 0.1], 0.1)),
    ("addSound", ("tone", "tone:440", [1.0, 0.0, 0.0], 60.0, False)),
    ("moveSound", ("tone", [1.0, 0.0, 0.0])),
    ("personSays", ("hello", [1.0, 0.0, 0.5], "", 60.0)),
]
"""Calls of the simulator's own service; descriptions are JSON there."""
BIP = "nao_library/bip.ogg"
MORE = {
    "ALLandMarkDetection": [("setParameter", ("pause", 1.0))],
    "ALMemory": [("getData", ("Test/Key", 0)), ("getDataOnChange", ("Test/Key", 0)), ("getListData", ([1.0],))],
    "ALVideoDevice": [
        *((method, (0,)) for method in ("getColorSpace", "getFrameRate", "getResolution")),
        ("onClientDisconnected", ("ClientDisconnected", 1.0, "")),
    ],
    "ALAudioDevice": [("sendLocalBufferToOutput", (1, 0))],
    "ALAudioPlayer": [
        *((method, (BIP, 0.5, 0.0)) for method in ("playFile", "playFileInLoop")),
        *((method, (1, 0.5, 0.0)) for method in ("play", "playInLoop")),
        ("playFileFromPosition", (BIP, 0.1, 0.5, 0.0)),
        ("playSoundSetFile", ("nao_library", "bip", 0.1, 0.5, 0.0, False)),
        ("playWebStream", ("http://127.0.0.1:9/x.wav", 0.5, 0.0)),
    ],
    "ALMotion": [
        ("setMotionConfig", ([["ENABLE_STIFFNESS_PROTECTION", 1.0]],)),
        ("getAngles", ([1.0], True)),
        ("getStiffnesses", ([1.0],)),
    ],
    "ALSpeechRecognition": [("setContextParam", ("context", "Sensitivity", 0.5))],
    "DCM": [("calibration", ([1.0],)), ("createAlias", (["TestEyes", [1.0]],))],
    "ALMovementDetection": [("setDepthSensitivity", (0.3,))],
    "ALAnimatedSpeech": [
        ("say", ("One.", {"bodyLanguageMode": 1.0})),
        ("addTagsToWords", ({"hello": [1.0]},)),
        ("declareTagForAnimations", ({"ahoy": [1.0]},)),
    ],
}
"""Calls with numbers that `naoqi_calls.txt` has without any."""
TASKS = [("isRunning", (1,)), ("wait", (1, 1)), ("stop", (1,))]
"""Calls of every module."""
PLAIN = {"b": True, "s": "HeadYaw", "r": b"piece", "m": [0.5], "o": None}
PLAIN |= dict.fromkeys("fd", 0.5) | dict.fromkeys("iIlL", 1)
"""A value of each of libqi's letters."""


def example(signature):
    """Arguments for the parameters of a method, "(sf)", as nobody has written down better ones."""
    stack = [[]]
    for letter in re.sub("<[^>]*>", "", signature):
        if letter in "([{":
            stack.append([])
        elif letter in ")]}":
            items = stack.pop()
            stack[-1].append(dict([items]) if letter == "}" else items)
        else:
            stack[-1].append(PLAIN[letter])
    return stack[0][0]


def calls_of(module):
    """Method and arguments of the calls that are known of a module."""
    if module == SIMULATION:
        return OWN
    known = [(method, arguments) for method, arguments, *_ in read_calls()[module][1]]
    return [*known, *MORE.get(module, ()), *TASKS]
