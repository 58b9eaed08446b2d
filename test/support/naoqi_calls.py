"""A call of each of NAOqi's methods with sensible arguments, as `naoqi_calls.txt` lists them."""

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
