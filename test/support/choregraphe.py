"""Projects of Choregraphe as text, as small as they can be."""

from __future__ import annotations

HEADER = '<?xml version="1.0" encoding="UTF-8" ?>'
SPACE = "http://www.aldebaran-robotics.com/schema/choregraphe/project.xsd"
SAYS = "self.tts = self.session().service('ALTextToSpeech')"
GOES = "result = self.postureService.goToPosture(self.getParameter('Name')) # ALRobotPosture\nALRobotPosture"
WAITS = "self.waiting = qi.async(self.timerOutput, delay=int(self.getParameter('Timeout (s)')))"
OWN = "print('something of my own')"
# Ids of inputs and outputs of all boxes here.
LOAD, START, STOP, TOUCHED, EVENT = 1, 2, 3, 6, 7
DONE, FAILED = 4, 5


def project(boxes: str, links: str = "", inputs: str = "") -> bytes:
    root = box(-1, "root", diagram(boxes, links), inputs=inputs)
    return f'{HEADER}<ChoregrapheProject xmlns="{SPACE}" xar_version="3">{root}</ChoregrapheProject>'.encode()


def diagram(boxes: str, links: str = "") -> str:
    return f"""<Timeline enable="0"><BehaviorLayer name="l"><BehaviorKeyframe name="k" index="1"><Diagram>{boxes}{links}
    </Diagram></BehaviorKeyframe></BehaviorLayer></Timeline>"""


def box(
    number: int,
    name: str,
    inside: str = "",
    script: str = "",
    text_input: bool = False,
    inputs: str = "",
    failed="onError",
) -> str:
    """A box; its outputs are onStopped, which ends it, and another one for what failed, which does not."""
    kind = 3 if text_input else 1
    return f"""<Box name="{name}" id="{number}"><script language="4"><content><![CDATA[{script}]]></content></script>
    <Input name="onLoad" type="1" nature="0" id="1"/><Input name="onStart" type="{kind}" nature="2" id="2"/>
    <Input name="onStop" type="1" nature="3" id="3"/>{inputs}<Output name="onStopped" nature="1" id="4"/>
    <Output name="{failed}" nature="2" id="5"/>{inside}</Box>"""


def link(source: int, target: int, entry: int = START, end: int | None = None) -> str:
    """From an output of one box to an input of another; box 0 is the diagram, from whose onStart links begin."""
    end = end or (DONE if source else START)
    return f'<Link inputowner="{target}" indexofinput="{entry}" outputowner="{source}" indexofoutput="{end}"/>'


def to_end(source: int, port: int = DONE, end: int = DONE) -> str:
    """From an output of a box to one of the diagram."""
    return link(source, 0, port, end)


def memory(key: str) -> str:
    """An input that an event of ALMemory comes to; its id is TOUCHED."""
    return f'<Input name="{key}" type="0" nature="4" stm_value_name="{key}" id="{TOUCHED}"/>'


def parameters(**values: object) -> str:
    return "".join(
        f'<Parameter name="{name}" inherits_from_parent="0" value="{value}"/>' for name, value in values.items()
    )


def says(number: int, text: str) -> str:
    return box(number, f"Say {text}", parameters(Text=text), SAYS)


def waits(number: int, seconds: float, on_cancel: int = 0) -> str:
    given = {"Timeout (s)": seconds, "Trigger timerOutput if cancelled": on_cancel}
    return box(number, "Wait", parameters(**given), WAITS)


def goes(number: int, name: str) -> str:
    given = {"Name": name, "Speed (%)": 50}
    return box(number, "Goto Posture", parameters(**given), GOES, failed="failure")


def text_edit(number: int, text: str) -> str:
    return box(number, "Text Edit", f"<pluginContent><text>{text}</text></pluginContent>", f'self.onStopped("{text}")')


def curve(joint: str, *keys: tuple, unit: int = 0) -> str:
    listed = "".join(f'<Key frame="{frame}" value="{value}">{"".join(rest)}</Key>' for frame, value, *rest in keys)
    return f'<ActuatorCurve name="value" actuator="{joint}" mute="0" unit="{unit}">{listed}</ActuatorCurve>'


def timeline(*curves: str, diagrams: dict[int, str] | None = None, end: int = -1) -> str:
    """Ten frames a second; diagrams by the frame at which they are loaded, all on one layer."""
    frames = "".join(
        f'<BehaviorKeyframe index="{index}"><Diagram>{inside}</Diagram></BehaviorKeyframe>'
        for index, inside in (diagrams or {}).items()
    )
    layer = f"<BehaviorLayer>{frames}</BehaviorLayer>" if frames else ""
    return f"""<Timeline enable="1" fps="10" start_frame="1" end_frame="{end}">{layer}
    <ActuatorList>{"".join(curves)}</ActuatorList></Timeline>"""


NOD = timeline(curve("HeadPitch", (5, 10.0), (10, 0.0)), curve("LHand", (10, 0.5), unit=1))
