"""What checks let pass, read from their source."""

from functools import lru_cache

from nao_library_modules.describe_checks import allowed_in
from nao_library_modules.errors import BadGoal
from nao_library_modules.field_checks import require_known, require_number, require_whole

FIELDS = ("count", "speed", "pitch", "name", "text", "values")
COLOURS = ("red", "green")
SPEED = (50.0, 400.0)
# The checks are followed within their own package only: here that is the tests' own.
PACKAGE = "nao_library_modules"


@lru_cache(maxsize=None)
def known_names():
    return ("Anna", "Bert")


def require_share(field, value):
    if not 0.0 <= value <= 1.0:
        raise BadGoal(field, value, "0..1")


class Voices:
    def require_voice(self, field, name):
        require_known(field, name, ("slt", "rms"))


class Module:
    def __init__(self):
        self.voices = Voices()

    @property
    def robot(self):
        raise AssertionError("nothing may ask the robot")

    def names(self):
        raise AssertionError("nothing may run")


def numbers(self, count, speed, pitch):
    require_whole("count", count, 1, 20)
    for field, value, (lowest, highest) in (("speed", speed, SPEED), ("pitch", pitch, (50.0, 200.0))):
        require_number(field, value, lowest, highest, f"{lowest:g}..{highest:g} %, or 0")


def helpers(self, speed, name):
    require_share("speed", speed)
    if name:
        self.voices.require_voice("name", name)


def tables(self, name, text):
    require_known("name", name, known_names())
    known = self.names()
    if text not in known:
        raise BadGoal("text", text, f"one of {', '.join(known)}")


def robots_own(self, text):
    if text not in self.robot.texts:
        raise BadGoal("text", text, "one that is there")


def remedies(self, text, values):
    if not values:
        raise BadGoal("values", [], "load comes first")
    raise BadGoal(f"values[{len(text)}]" if text else "other", values, "numbers")


def again(self, count):
    again(self, count)
    require_whole("count", count, 0, 3)


def told(check, **package):
    for function in (numbers, helpers, tables, robots_own, remedies, again, require_share, Voices.require_voice):
        function.__module__ = f"{PACKAGE}.of_a_test"
    return allowed_in(check, Module(), FIELDS)


def test_numbers_are_told_with_their_limits_also_from_a_loop_over_a_table():
    found = told(numbers)
    assert (found["count"].text, found["count"].minimum, found["count"].maximum) == ("a whole number 1..20", 1.0, 20.0)
    assert (found["speed"].text, found["speed"].minimum) == ("50..400 %, or 0", 0.0)
    assert (found["pitch"].text, found["pitch"].maximum) == ("50..200 %, or 0", 200.0)


def test_helpers_and_methods_of_the_module_are_followed():
    found = told(helpers)
    assert found["speed"].text == "0..1"
    assert found["name"].choices == ("slt", "rms")


def test_tables_are_read_and_what_only_the_robot_knows_is_left_out():
    found = told(tables)
    assert found["name"].choices == ("Anna", "Bert")
    assert "text" not in found


def test_no_property_of_the_module_is_asked():
    assert told(robots_own)["text"].text == "one that is there"


def test_what_to_do_about_it_and_other_names_than_fields_are_left_out():
    assert told(remedies) == {}


def test_a_check_that_calls_itself_ends():
    assert told(again)["count"].maximum == 3.0


def test_a_function_without_a_check_takes_anything():
    assert allowed_in(None, Module(), FIELDS) == {}
