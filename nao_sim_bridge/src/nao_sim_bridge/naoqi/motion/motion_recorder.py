"""ALMotionRecorder of the simulated robot: poses that somebody moves it to, kept for ALMotion to play."""

from __future__ import annotations

import logging
from dataclasses import dataclass, field
from typing import Any, Dict, FrozenSet, List, Sequence, Tuple

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.joints.bezier import BezierCurve, KeyPoint
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.model.touch_names import BUMPERS, CHEST_BUTTON
from nao_sim_bridge.naoqi.binding.arguments import number, one_of, whole_number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.motion.arguments import bezier_curve, bezier_key_points
from nao_sim_bridge.naoqi.motion.part import MotionPart

WITH_BUMPERS, WITH_BUTTON = MODES = (1, 2)
LEFT, RIGHT = frozenset(BUMPERS["LFoot"]), frozenset(BUMPERS["RFoot"])
LEAST_STEP, LONGEST_STEP = 0.01, 3600.0
MOST_POSES = 10**9
STIFF, LIMP = 1.0, 0.0
log = logging.getLogger("nao_sim.motion")


@dataclass
class Recording:
    """Poses of some joints, by index.

    Attributes:
        most: It ends by itself with so many poses.
        begin: Simulated time, s.
        step: Time between two poses, s; None where touch says when.
        mode: One of `MODES` where touch says when.
        times: Of the poses, s since the begin.
        poses: Measured angles, rad.
    """

    names: Tuple[str, ...]
    joints: Tuple[int, ...]
    most: int
    begin: float
    step: float | None = None
    mode: int = WITH_BUTTON
    touched: FrozenSet[str] = frozenset()
    runs: bool = True
    times: List[float] = field(default_factory=list)
    poses: List[List[float]] = field(default_factory=list)

    def add(self, now: Snapshot) -> None:
        """Keep the pose of now."""
        self.times.append(now.time - self.begin)
        self.poses.append([now.positions[joint] for joint in self.joints])
        self.runs = len(self.times) < self.most

    def value(self) -> List[Any]:
        """[joints, times of each, angles of each], as ALMotion.angleInterpolation takes them."""
        angles = [[pose[i] for pose in self.poses] for i in range(len(self.joints))]
        return [list(self.names), [list(self.times) for _ in self.joints], angles]


class ALMotionRecorder(MotionPart):
    """Records poses every so often, or when the robot is touched. Only NAOqi methods are public."""

    def __init__(self, runner: RobotRunner) -> None:
        super().__init__(runner)
        self._recording: Recording | None = None
        runner.simulation.after_tick.append(self._tick)
        runner.simulation.after_reset.append(self._forget)

    def startInteractiveRecording(self, joints: List[str], poses: int, more: bool, mode: int) -> Task:
        """Mode 1: the left bumper keeps a pose, the right one holds or releases the joints; 2: the chest button."""
        one_of(mode, "mode", MODES)
        recording = self._of(joints, poses, more)
        recording.mode = mode
        return self._start("startInteractiveRecording", recording, {})

    def startPeriodicRecording(
        self, joints: List[str], poses: int, more: bool, step: float, replayed: List[str], data: Any
    ) -> Task:
        """A pose every `step` s; meanwhile `replayed` joints follow Bezier curves, [times, points] of each."""
        recording = self._of(joints, poses, more)
        recording.step = number(step, "timeStep", LEAST_STEP, LONGEST_STEP)
        curves: Dict[int, Sequence[KeyPoint]] = {}
        if replayed:
            indices = self._indices(replayed)
            times, points = data if isinstance(data, (list, tuple)) and len(data) == 2 else (data, data)
            curves = dict(zip(indices, bezier_key_points(len(indices), times, points)))
        return self._start("startPeriodicRecording", recording, curves)

    def stopAndGetRecording(self) -> Task:
        """[[joint, ...], [[time, ...], ...], [[angle, ...], ...]] in s since the begin and rad, as measured."""

        def stop() -> List[Any]:
            recording, self._recording = self._recording, None
            if recording is None:
                raise NaoqiError("nothing is recorded: startInteractiveRecording or startPeriodicRecording comes first")
            return recording.value()

        return self._runner.execute(stop, "stopAndGetRecording")

    # --- inside ---------------------------------------------------------------------------------------------------

    def _of(self, joints: List[str], poses: int, more: bool) -> Recording:
        indices = self._indices(joints)
        room = max(load_sizes().lists.key_frames // max(len(indices), 1), 1)
        wanted = whole_number(poses, "nbPoses", 1, MOST_POSES)
        names = tuple(self._model.joints[i].name for i in indices)
        return Recording(names, tuple(indices), room if more else min(wanted, room), 0.0)

    def _start(self, call: str, recording: Recording, curves: Dict[int, Sequence[KeyPoint]]) -> Task:
        def start() -> None:
            if self._recording is not None and self._recording.runs:
                raise NaoqiError("a recording goes on; stopAndGetRecording ends it")
            recording.begin, recording.touched = self._runner.snapshot.time, self._runner.snapshot.touched
            self._recording = recording
            if curves:
                self._robot.motion.follow(call, list(curves), lambda now: _replayed(curves, now))

        return self._runner.execute(start, call)

    def _tick(self, now: Snapshot) -> None:
        recording = self._recording
        if recording is None or not recording.runs:
            return
        if recording.step is not None:
            if now.time >= recording.begin + recording.step * (len(recording.times) + 1) - 1e-9:
                recording.add(now)
            return
        pressed, recording.touched = now.touched - recording.touched, now.touched
        keeps = LEFT if recording.mode == WITH_BUMPERS else {CHEST_BUTTON}
        if pressed & keeps:
            recording.add(now)
            log.info("pose %d is kept", len(recording.times))
        if recording.mode == WITH_BUMPERS and pressed & RIGHT:
            self._hold_or_release(recording.joints)

    def _hold_or_release(self, joints: Sequence[int]) -> None:
        stiffnesses = self._robot.joints.stiffnesses
        limp = any(stiffnesses[joint] == LIMP for joint in joints)
        self._hold_limp(joints)
        self._robot.motion.set_stiffness_now(dict.fromkeys(joints, STIFF if limp else LIMP))

    def _forget(self) -> None:
        self._recording = None


def _replayed(curves: Dict[int, Sequence[KeyPoint]], now: Sequence[float]) -> Dict[int, BezierCurve]:
    return {joint: bezier_curve(now[joint], points) for joint, points in curves.items()}
