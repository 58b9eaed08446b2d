"""All that naoqi_driver and naoqi_driver2 call, answered with the types that their C++ takes them as, on the wire."""

from pathlib import Path

import pytest
import yaml
from raw_calls import Dynamic, RawCalls

CALLS = yaml.safe_load((Path(__file__).parents[2] / "support/naoqi_driver_calls.yaml").read_text())
ANSWERED = [call for call in CALLS if call[3] not in ("absent", "refused")]
INTEGERS, FLOATS = "bcCwWiIlL", "fd"


def converts(signature, value, wanted):
    """Whether libqi makes a value of this type of C++ of what is on the wire."""
    while signature == "m" and isinstance(value, Dynamic):
        signature, value = value
    if wanted == "qi::AnyValue":
        return True
    if wanted in ("bool", "int", "float", "double"):
        return signature in INTEGERS + FLOATS
    if wanted == "void":
        return True
    if wanted in ("std::string", "qi::AnyObject"):
        return signature == {"std::string": "s", "qi::AnyObject": "o"}[wanted]
    kind, _, inner = wanted[:-1].partition("<")
    if kind == "std::vector":
        return signature[0] == "[" and all(converts(signature[1:-1], each, inner) for each in value)
    first, second = inner.split(", ")
    assert kind == "std::map"
    return signature[0] == "{" and all(
        converts(signature[1], key, first) and converts(signature[2:-1], each, second) for key, each in value.items()
    )


def kind_of(element):
    """What the content() of an element is, for libqi; an AssertionError where it has none."""
    assert isinstance(element, Dynamic), f"{element!r} is no any value: content() throws"
    signature, value = element
    if signature == "r":
        return "raw"
    if signature in INTEGERS:
        return "int"
    return {"s": "text"}.get(signature, "float" if signature in FLOATS else signature)


@pytest.fixture
def raw(robot):
    calls = RawCalls(robot.port, robot.session)
    yield calls
    calls.close()


@pytest.fixture
def asked(robot, raw):
    """Asks all of it in the order of the table, on a robot whose time passes as on a real one: calls and answers."""
    runner = robot.server.runner
    robot.ALMotion.setStiffnesses("Body", 1.0)
    robot.NaoSimulation.setSpeed(1.0)
    runner.resume()
    try:
        return [(call, raw.answer(*call[:2], *call[2])) for call in ANSWERED]
    finally:
        runner.pause()
        robot.NaoSimulation.setSpeed(0.0)


def test_every_answer_has_the_type_that_its_program_takes_it_as_and_holds_what_it_makes_of_it(asked):
    for (service, method, arguments, wanted, *elements), (signature, value) in asked:
        where = f"{service}.{method}{tuple(arguments)} -> {signature}"
        assert converts(signature, value, wanted), f"{where} does not become {wanted}"
        if elements == ["numbers"]:
            assert {kind_of(each) for each in value} <= {"int", "float"}, where
        elif elements == ["texts"]:
            assert {kind_of(each) for each in value} == {"text"}, where
        elif elements == ["lists of numbers"]:
            (limits,) = (each[1] if isinstance(each, Dynamic) else each for each in value)
            assert len(limits) == 4 and {kind_of(each) for each in limits} == {"float"}, where
        elif elements:
            assert signature == "[m]" and [kind_of(each) for each in value] == elements[0].split(), where
    answers = {(service, method, str(args)): value for (service, method, args, *_), (_, value) in asked}
    assert len(answers["ALSystem", "systemVersion", "[]"].split(".")) == 4
    config = answers["ALRobotModel", "_getConfigMap", "[]"]
    assert int(config["RobotConfig/Head/Device/Micro/Version"]) == answers["ALRobotModel", "_getMicrophoneConfig", "[]"]
    picture = answers["ALVideoDevice", "getImageRemote", "['front_camera_0']"]
    assert len(picture[6][1]) == 320 * 240 * 3


def test_what_is_not_there_is_told(robot):
    for service, method, arguments, why, *_ in CALLS:
        if why == "absent":
            with pytest.raises(RuntimeError, match=service):
                robot.session.service(service)
        elif why == "refused":
            with pytest.raises(RuntimeError):
                robot.session.service(service).call(method, *arguments)
