"""Errors of the driver that its clients act on: by a code, whatever the text says."""

from __future__ import annotations

import pytest
from actionlib_msgs.msg import GoalStatus

from nao_library_modules.core.errors import CodedError, ErrorCode, code_in, with_code
from nao_library_modules.driver.joints.pose_manager import PostureMissed
from nao_library_modules.driver.walk.walk_commands import Stop, Superseded, WalkEnded
from nao_library_modules.ros.nao_robot_driver import arrived, posture_reached
from naoqi.errors import NaoError

ERRORS = {
    ErrorCode.WALK_ENDED: (WalkEnded(Stop(), "someone came"), Superseded(Stop(), "someone came")),
    ErrorCode.POSTURE_MISSED: (PostureMissed("Stand"),),
}


class Reworded(CodedError):
    """Another text with the same code."""

    code = ErrorCode.POSTURE_MISSED


@pytest.mark.parametrize("code", ErrorCode)
def test_a_code_is_found_again_inside_of_what_ros_writes_around_it(code):
    for error in ERRORS[code]:
        assert code_in(f"service [/cmd_pose_srv] responded with an error: b'{with_code(error)}'") is code
        assert code_in(str(error)) is None


def test_an_error_without_a_code_is_told_as_it_is():
    assert with_code(NaoError("the robot [is] busy")) == "the robot [is] busy"
    assert code_in("the robot [is] busy") is None


def test_the_servers_decide_by_the_code_and_not_by_the_words():
    assert arrived("") is None and arrived(with_code(ERRORS[ErrorCode.WALK_ENDED][0])) is False
    with pytest.raises(NaoError, match="ended early"):
        arrived("walking ended early: the words of an error without its code")
    assert posture_reached(GoalStatus.SUCCEEDED, "") is True
    assert posture_reached(GoalStatus.ABORTED, with_code(Reworded("elsewhere"))) is False
    with pytest.raises(NaoError, match="did not reach the posture"):
        posture_reached(GoalStatus.ABORTED, "the robot did not reach the posture Stand")
