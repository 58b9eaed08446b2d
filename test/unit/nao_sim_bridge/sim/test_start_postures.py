"""A simulation that starts in a posture stays in it, also those that are not on the feet."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.posture_recognition import recognise
from nao_sim_bridge.sim.postures import load_postures
from nao_sim_bridge.sim.start_lean import start_pitch

POSTURES = load_postures().by_name
OFF_THE_FEET = ("Sit", "SitRelax", "LyingBelly", "LyingBack")


@pytest.mark.parametrize("name", POSTURES)
def test_a_stiff_robot_stays_in_the_posture_it_starts_in(bench, name):
    one = bench(name)
    one.run(3.0)
    seen = recognise(one.model, one.now)
    assert (seen.posture, seen.family) == (name, POSTURES[name].family)


# A limp Sit slumps on its back: nothing holds a torso that leans back but the hips.
@pytest.mark.parametrize("name", [name for name in OFF_THE_FEET if name != "Sit"])
def test_a_limp_robot_stays_in_the_family_it_starts_in(bench, name):
    one = bench(name, stiffness=0.0)
    one.run(3.0)
    assert recognise(one.model, one.now).family == POSTURES[name].family


@pytest.mark.parametrize("name", OFF_THE_FEET)
def test_it_starts_on_the_floor_neither_above_nor_in_it(bench, name):
    start = bench(name).watch(0.03)
    assert start[-1].contacts
    assert max(tick.linear_velocity[2] for tick in start) < 0.1
    assert all(tick.torso.position[2] == pytest.approx(start[0].torso.position[2], abs=0.01) for tick in start)


@pytest.mark.parametrize("name", POSTURES)
def test_only_postures_off_the_feet_have_a_pitch_to_start_with(name):
    assert (start_pitch(name) is None) == (name not in OFF_THE_FEET)


def test_an_unknown_posture_has_no_start(bench):
    with pytest.raises(UnknownName, match="Sitt"):
        bench("Sitt")
