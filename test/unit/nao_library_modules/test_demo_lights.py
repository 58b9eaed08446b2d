"""What the demonstration asks of the lights."""

from __future__ import annotations

from nao_library_modules.demo_lights import eye_devices, steps


def test_every_function_is_one_of_the_lights(lights):
    assert {fields["function"] for step in steps() for fields in step.functions} <= set(lights.function_table)


def test_each_eye_has_eight_devices_of_each_colour():
    green = eye_devices(0.0, 1.0, 0.0)
    assert len(green) == 2 * 8 * 3
    assert {name.split("/")[2] for name, value in green.items() if value} == {"Green"}
