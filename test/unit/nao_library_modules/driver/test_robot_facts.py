"""What kind of robot it is."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.robot_facts import KEYS, facts_of, info_fields
from nao_library_msgs.msg import RobotInfo

NAO = {KEYS["body type"]: "Nao", KEYS["head version"]: "6.0.0", KEYS["body version"]: 5.0, KEYS["arm version"]: None}


def test_facts_are_texts():
    facts = facts_of(NAO)
    assert facts["body version"] == "5.0" and facts["arm version"] == "" and set(facts) == set(KEYS)


@pytest.mark.parametrize("joints, model, hands", [(26, "nao_h25", 2), (22, "nao_h21", 0)])
def test_a_nao_is_known_by_its_joints(joints, model, hands):
    info = RobotInfo(**info_fields(facts_of(NAO), joints))
    assert (info.type, info.model, info.number_of_hands) == (RobotInfo.NAO, model, hands)
    assert (info.number_of_legs, info.number_of_arms, info.has_laser) == (2, 2, False)


def test_a_pepper_is_known_by_either_name():
    for name in ("Juliette", "Pepper"):
        info = RobotInfo(**info_fields(facts_of({KEYS["body type"]: name, KEYS["laser"]: "1"}), 20))
        assert (info.type, info.has_laser, info.number_of_legs) == (RobotInfo.PEPPER, True, 1)
