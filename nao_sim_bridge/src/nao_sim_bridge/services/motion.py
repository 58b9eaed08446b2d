"""ALMotion of the simulated robot: joints, stiffness, tasks. Only NAOqi methods live here."""

from __future__ import annotations

from typing import Any, Callable, Sequence

from nao_sim_bridge.services.arguments import number, per_item
from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.memory_store import MemoryStore
from nao_sim_bridge.services.motion_arguments import joint_indices, joint_names, key_frames
from nao_sim_bridge.services.motion_summary import summary_table
from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.motion import sequences
from nao_sim_bridge.sim.motion.curves import Ramp, SmoothCurve
from nao_sim_bridge.sim.runner import SimulationRunner
from nao_sim_bridge.sim.simulation import Simulation
from nao_sim_bridge.sim.tasks import Task

AWAKE = "robotIsWakeUp"
EVENTS = (
    AWAKE,
    "ALMotion/Stiffness/wakeUpStarted",
    "ALMotion/Stiffness/wakeUpFinished",
    "ALMotion/Stiffness/restStarted",
    "ALMotion/Stiffness/restFinished",
)
OPEN, CLOSED = 1.0, 0.0
# Hands open and close at this fraction of their top speed.
HAND_SPEED = 0.3


class ALMotion:
    """ALMotion as the simulated robot offers it.

    Args:
        simulation: Whose joints these are; touched in the simulation thread only.
        runner: That thread.
        memory: Where events go.
    """

    def __init__(self, simulation: Simulation, runner: SimulationRunner, memory: MemoryStore) -> None:
        self._simulation = simulation
        self._runner = runner
        self._model = simulation.model
        self._memory = memory
        for event in EVENTS:
            memory.declare_event(event, "ALMotion")
        memory.raise_event(AWAKE, False)

    # --- what there is --------------------------------------------------------------------------------------------

    def getBodyNames(self, name: str) -> list[str]:
        if name in self._model.chains:
            return list(self._model.chains[name])
        return joint_names(name, self._model)

    def getJointNames(self, name: str) -> list[str]:
        return self.getBodyNames(name)

    def getLimits(self, name: str) -> list[list[float]]:
        joints = [self._model.joint(n) for n in joint_names(name, self._model)]
        return [[j.lower, j.upper, j.max_velocity, j.max_torque] for j in joints]

    def getMotionCycleTime(self) -> int:
        return round(1000.0 * self._simulation.settings.tick_s)

    def getRobotConfig(self) -> list:
        version = {"V6": "VERSION_60", "V5": "VERSION_50"}[self._simulation.scene.version]
        values = {
            "Model Type": "naoH25",
            "Head Version": version,
            "Body Version": version,
            "Laser": False,
            "Extended Arms": True,
            "Number of Legs": 2,
            "Number of Arms": 2,
            "Number of Hands": 2,
        }
        return [list(values), list(values.values())]

    def getSummary(self) -> str:
        return summary_table(self._model, self._runner.snapshot)

    # --- angles ---------------------------------------------------------------------------------------------------

    def getAngles(self, names: Any, use_sensors: bool) -> list[float]:
        indices = [self._model.joint_index[n] for n in joint_names(names, self._model)]
        angles = self._runner.snapshot.positions if use_sensors else self._simulation.robot.joints.commands
        return [angles[i] for i in indices]

    def setAngles(self, names: Any, angles: Any, fraction: Any) -> Task:
        indices = joint_indices(names, self._model)
        targets = dict(zip(indices, per_item(angles, len(indices), "angles")))
        speeds = self._speeds(indices, fraction)
        return self._runner.execute(lambda: self._simulation.robot.motion.set_targets(targets, speeds), "setAngles")

    def changeAngles(self, names: Any, changes: Any, fraction: float) -> Task:
        indices = joint_indices(names, self._model)
        steps = dict(zip(indices, per_item(changes, len(indices), "changes")))
        speeds = self._speeds(indices, fraction)

        def change() -> None:
            motion = self._simulation.robot.motion
            motion.set_targets({i: motion.target_of(i) + step for i, step in steps.items()}, speeds)

        return self._runner.execute(change, "changeAngles")

    def angleInterpolation(self, names: Any, angles: Any, times: Any, is_absolute: bool) -> Task:
        indices = joint_indices(names, self._model)
        frames = key_frames(len(indices), angles, times, "angleLists")

        def curves(commands: Sequence[float]) -> dict[int, SmoothCurve]:
            return {
                i: SmoothCurve((0.0, *at), (commands[i], *(v if is_absolute else commands[i] + v for v in values)))
                for i, (at, values) in zip(indices, frames)
            }

        return self._follow("angleInterpolation", indices, curves)

    def angleInterpolationWithSpeed(self, names: Any, angles: Any, fraction: float) -> Task:
        indices = joint_indices(names, self._model)
        targets = dict(zip(indices, per_item(angles, len(indices), "targetAngles")))
        speeds = self._speeds(indices, fraction)
        joints = self._simulation.robot.joints

        def ramps(commands: Sequence[float]) -> dict[int, Ramp]:
            return {i: Ramp(commands[i], joints.clamp(i, target), speeds[i]) for i, target in targets.items()}

        return self._follow("angleInterpolationWithSpeed", indices, ramps)

    def openHand(self, name: str) -> Task:
        return self._move_hand("openHand", name, OPEN)

    def closeHand(self, name: str) -> Task:
        return self._move_hand("closeHand", name, CLOSED)

    # --- stiffness ------------------------------------------------------------------------------------------------

    def getStiffnesses(self, names: Any) -> list[float]:
        stiffnesses = self._simulation.robot.joints.stiffnesses
        return [stiffnesses[self._model.joint_index[n]] for n in joint_names(names, self._model)]

    def setStiffnesses(self, names: Any, stiffnesses: Any) -> Task:
        indices = joint_indices(names, self._model)
        values = dict(zip(indices, per_item(stiffnesses, len(indices), "stiffnesses", 0.0, 1.0)))

        def stiffen() -> None:
            self._hold_limp(indices)
            self._simulation.robot.motion.set_stiffness_now(values)

        return self._runner.execute(stiffen, "setStiffnesses")

    def stiffnessInterpolation(self, names: Any, stiffnesses: Any, times: Any) -> Task:
        indices = joint_indices(names, self._model)
        frames = key_frames(len(indices), stiffnesses, times, "stiffnessLists")
        for _, values in frames:
            for value in values:
                number(value, "stiffnessLists", 0.0, 1.0)

        def curves(now: Sequence[float]) -> dict[int, SmoothCurve]:
            return {i: SmoothCurve((0.0, *at), (now[i], *values)) for i, (at, values) in zip(indices, frames)}

        def start() -> Task:
            self._hold_limp(indices)
            return self._simulation.robot.motion.stiffen("stiffnessInterpolation", indices, curves)

        return self._runner.execute(start, "stiffnessInterpolation")

    def wakeUp(self) -> Task:
        return self._change_state("wakeUp", sequences.wake_up, awake=True)

    def rest(self, chain: str = "Body") -> Task:
        if chain != "Body":
            indices = joint_indices(chain, self._model)
            return self._runner.execute(
                lambda: sequences.stiffness_task(self._simulation.robot, "rest", indices, 0.0, sequences.STIFFEN_TIME),
                "rest",
            )
        return self._change_state("rest", sequences.rest, awake=False)

    def robotIsWakeUp(self) -> bool:
        return bool(self._memory.get(AWAKE))

    # --- tasks ----------------------------------------------------------------------------------------------------

    def getTaskList(self) -> Task:
        return self._runner.execute(
            lambda: [[task.name, task.task_id] for task in self._simulation.robot.motion.tasks()], "getTaskList"
        )

    def areResourcesAvailable(self, names: list[str]) -> Task:
        indices = joint_indices(names, self._model)
        return self._runner.execute(lambda: not self._simulation.robot.motion.busy(indices), "areResourcesAvailable")

    def killTask(self, task_id: int) -> Task:
        def kill() -> bool:
            for task in self._simulation.robot.motion.tasks():
                if task.task_id == task_id:
                    return task.kill()
            return False

        return self._runner.execute(kill, "killTask")

    def killTasksUsingResources(self, names: list[str]) -> Task:
        indices = joint_indices(names, self._model)
        return self._runner.execute(lambda: self._simulation.robot.motion.kill_using(indices), "kill")

    def killAll(self) -> Task:
        return self._runner.execute(lambda: self._simulation.robot.motion.kill_all(), "killAll")

    # --- inside ---------------------------------------------------------------------------------------------------

    def _speeds(self, indices: Sequence[int], fraction: Any) -> dict[int, float]:
        fractions = per_item(fraction, len(indices), "fractionMaxSpeed", 0.0, 1.0)
        if 0.0 in fractions:
            raise NaoqiError("fractionMaxSpeed is 0, allowed is above 0 to 1")
        return {i: share * self._model.joints[i].max_velocity for i, share in zip(indices, fractions)}

    def _follow(self, name: str, indices: Sequence[int], curves: Callable[[Sequence[float]], dict]) -> Task:
        return self._runner.execute(lambda: self._simulation.robot.motion.follow(name, indices, curves), name)

    def _move_hand(self, call: str, name: str, value: float) -> Task:
        if name not in ("LHand", "RHand"):
            raise UnknownName("hand", name, ["LHand", "RHand"])
        index = self._model.joint_index[name]
        speed = HAND_SPEED * self._model.joints[index].max_velocity
        return self._follow(call, [index], lambda commands: {index: Ramp(commands[index], value, speed)})

    def _hold_limp(self, indices: Sequence[int]) -> None:
        """Take the measured angles of limp joints as commands: stiffening them must not make them jump."""
        joints = self._simulation.robot.joints
        limp = [i for i in indices if joints.stiffnesses[i] == 0.0 and not self._simulation.robot.motion.busy([i])]
        joints.hold(self._runner.snapshot.positions, limp)

    def _change_state(self, name: str, sequence: Callable[..., Task], awake: bool) -> Task:
        def end() -> None:
            self._memory.raise_event(f"ALMotion/Stiffness/{name}Finished", True)
            if not awake:
                self._set_awake(False)

        def start() -> Task:
            self._memory.raise_event(f"ALMotion/Stiffness/{name}Started", True)
            if awake:
                self._set_awake(True)
            return sequence(self._simulation.robot, lambda: self._runner.snapshot, end)

        return self._runner.execute(start, name)

    def _set_awake(self, awake: bool) -> None:
        if self._memory.get(AWAKE) != awake:
            self._memory.raise_event(AWAKE, awake)
