"""Simulated robots for programs that time ticks."""

from __future__ import annotations

from nao_sim_bridge.sim.simulation import Scene, Simulation

SETTLE_S = 1.0


def awake() -> Simulation:
    """A robot that stands stiff and still."""
    simulation = Simulation(Scene(posture="Stand"))
    simulation.robot.motion.set_stiffness_now(dict.fromkeys(range(len(simulation.model.joints)), 1.0))
    simulation.run(SETTLE_S)
    return simulation
