"""NaoMotion on the simulated robot."""

import math

import pytest

POSITION = "Device/SubDeviceList/{}/Position/Sensor/Value"


@pytest.fixture
def motion(goals_to, tmp_path):
    from nao_library_actions.msg import NaoMotionGoal
    from nao_library_modules.motion.motion_server import NaoMotion

    return goals_to(NaoMotion, NaoMotionGoal, motion_dir=tmp_path)


@pytest.fixture
def angle(robot):
    """What a joint measures, rad."""
    return lambda joint: robot.value(POSITION.format(joint))


@pytest.fixture
def way(robot):
    """Where the torso really is by now, seen from where the test began: x, y in m, heading in rad."""

    def pose():
        position, (x, y, z, w) = robot.now.torso.position, robot.now.torso.orientation
        return position[0], position[1], math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))

    start = pose()

    def way():
        now = pose()
        x, y, c, s = now[0] - start[0], now[1] - start[1], math.cos(start[2]), math.sin(start[2])
        return c * x + s * y, c * y - s * x, math.remainder(now[2] - start[2], 2.0 * math.pi)

    return way
