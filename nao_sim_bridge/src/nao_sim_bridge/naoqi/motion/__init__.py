"""ALMotion of the simulated robot, in parts of one subject each; `parts` puts them together."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.cartesian import Cartesian, Mass
from nao_sim_bridge.naoqi.motion.footsteps import Footsteps
from nao_sim_bridge.naoqi.motion.joints import Angles, Bezier, Body, Stiffness, TaskList
from nao_sim_bridge.naoqi.motion.reflexes import Collisions, Falls, Idling, Switches
from nao_sim_bridge.naoqi.motion.wake import Wake
from nao_sim_bridge.naoqi.motion.walking import MoveFailures, Walking, WalkPosition
from nao_sim_bridge.naoqi.motion.whole_body import WholeBody


def parts(simulation: Simulation, runner: SimulationRunner, memory: MemoryStore) -> list[Any]:
    """Objects that together have the methods of ALMotion."""
    failures = MoveFailures(memory)
    return [
        Body(simulation, runner),
        Angles(simulation, runner),
        Bezier(simulation, runner),
        Stiffness(simulation, runner),
        Wake(simulation, runner, memory),
        TaskList(simulation, runner),
        Cartesian(simulation, runner),
        Mass(simulation, runner),
        WholeBody(simulation, runner),
        Walking(simulation, runner, failures),
        Footsteps(simulation, runner, failures),
        WalkPosition(simulation, runner),
        Falls(simulation, runner),
        Collisions(simulation, runner),
        Idling(simulation, runner),
        Switches(simulation, runner),
    ]
