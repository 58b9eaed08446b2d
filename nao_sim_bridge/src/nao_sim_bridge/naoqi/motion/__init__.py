"""ALMotion of the simulated robot, in parts of one subject each; `parts` puts them together."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.cartesian import Cartesian, Mass
from nao_sim_bridge.naoqi.motion.joints import Body, Joints, TaskList
from nao_sim_bridge.naoqi.motion.reflexes import Collisions, Idling, Switches
from nao_sim_bridge.naoqi.motion.wake import Wake
from nao_sim_bridge.naoqi.motion.walking import Moves, Walking
from nao_sim_bridge.naoqi.motion.whole_body import WholeBody


def parts(runner: RobotRunner, memory: MemoryStore, moves: Moves) -> list[Any]:
    """Objects that together have the methods of ALMotion."""
    return [
        *(part(runner) for part in (Body, Joints, TaskList, Cartesian, Mass, WholeBody)),
        Wake(runner, memory),
        Walking(runner, moves),
        *(part(runner) for part in (Collisions, Idling, Switches)),
    ]
