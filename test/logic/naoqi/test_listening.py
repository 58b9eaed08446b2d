"""Where a program listens for the robot to call it: libqi knows no passwords."""

from __future__ import annotations

import pytest

from naoqi.broker import listening_address
from naoqi.errors import RobotUnreachable

HERE, ALL, NOBODYS = "127.0.0.1", "0.0.0.0", "192.0.2.255"


@pytest.mark.parametrize(
    "wanted, host, address",
    [
        ("", "localhost", HERE),
        ("", ALL, HERE),  # which is this computer, for who connects
        (ALL, "localhost", HERE),
        (NOBODYS, "localhost", NOBODYS),
    ],
)
def test_it_listens_where_the_robot_sees_it_and_not_in_all_networks(wanted, host, address):
    assert listening_address(wanted, host, 9559) == address


def test_a_robot_without_a_way_to_it_is_not_reached():
    with pytest.raises(RobotUnreachable, match="no way leads there"):
        listening_address("", "no robot.invalid", 9559)
