"""Motion functions that record what joints do, replay it, and keep it under names."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from nao_library_msgs.msg import FunctionResult

from ..base.answers import values_of
from ..base.errors import BadGoal
from ..base.whole_file import written
from ..functions.chain import checked_by
from .body import DEFAULT_SPEED, BodyPart, RobotBody
from .facts import BODY
from .fields import (
    RATE,
    Limp,
    Mirror,
    Motion,
    NewMotion,
    NewName,
    Overwrite,
    RecordingTime,
    ReplaySpeed,
    SampleRate,
    SomeJoints,
    Stiffness,
)
from .recorded_motion import RecordedMotion, recorded
from .store import MotionStore

if TYPE_CHECKING:
    from ..server.nao_basic import NaoBasic

# The way to the first pose of a motion takes that long at least, s.
APPROACH = 0.5


class MotionRecording(BodyPart):
    """Recorded motions.

    `store`: recorded motions by name. `cut_short`: what recordings that were interrupted have left, for the result of
    the chain.
    """

    left_by_goals = frozenset({"store"})

    def __init__(self, module: NaoBasic, body: RobotBody, store: MotionStore) -> None:
        super().__init__(body)
        self._module = module
        self.store = store
        self.begin_chain()

    def begin_chain(self) -> None:
        self._new_names: set[str] = set()  # of motions that the chain records or renames
        self.cut_short: list[FunctionResult] = []

    prepare_for_checks = begin_chain

    def _check_recording(self, str_param: str, names: Sequence[str], duration: float, overwrite: bool) -> None:
        if not overwrite:
            self._require_free(str_param, "str_param")
        self.body.plan.leave_to_robot(self.body.joints(names or [BODY]), duration)
        self._new_names.add(str_param)

    @checked_by(_check_recording)
    def record_motion(
        self,
        str_param: NewMotion,
        names: SomeJoints,
        duration: RecordingTime,
        rate: SampleRate,
        limp: Limp,
        overwrite: Overwrite,
    ) -> dict[str, Any]:
        """Record joints for a time, or until the goal is cancelled; with `limp` they can be moved by hand."""
        joints = self.body.joints(names or [BODY])
        if limp:
            self._let_go(joints)
        samples: list[tuple[float, list[float]]] = []
        try:
            self._sample(joints, duration, 1.0 / (rate or RATE), samples)
        except BaseException:
            # Whoever teaches by hand does not know beforehand how long it takes, and cancels at the end. What came
            # until then is kept in any case; why it ends is what the goal tells.
            if samples:
                answer, told = self._save(str_param, joints, samples, overwrite)
                self.cut_short.append(FunctionResult(function="recordMotion", values=[*values_of(answer), told]))
            raise
        answer, told = self._save(str_param, joints, samples, overwrite)
        self._module.remark(told)
        return answer

    def _check_replay(self, str_param: str, speed: float, mirror: bool, stiffness: float) -> None:
        if str_param in self._new_names:
            return  # recorded by an earlier function of this chain: nothing is known of it yet
        plan = self.body.plan
        motion = self.replay(str_param, speed, mirror)
        where = f"str_param ({str_param})"
        self.body.joints(motion.joints, where)
        plan.require_stiff(motion.joints, stiffness)
        plan.move_with_speed(dict(motion.start), dict.fromkeys(motion.joints, DEFAULT_SPEED))
        if len(motion.times) > 1:
            values = {joint: [row[i] for row in motion.angles[1:]] for i, joint in enumerate(motion.joints)}
            plan.follow(values, motion.times[1:], False, where)

    @checked_by(_check_replay)
    def play_motion(self, str_param: Motion, speed: ReplaySpeed, mirror: Mirror, stiffness: Stiffness) -> float:
        """Replay a recorded motion, from wherever the joints are; answers how long it took, s."""
        motion = self.replay(str_param, speed, mirror)
        joints = list(motion.joints)
        self.body.stiffen(joints, stiffness)
        began = self._module.clock.now()
        self._approach(motion)
        if len(motion.times) > 1:
            paths = [[row[i] for row in motion.angles[1:]] for i in range(len(joints))]
            self.motion("angleInterpolation", joints, paths, [list(motion.times[1:])] * len(joints), True)
        self.body.require_reached(dict(zip(joints, motion.angles[-1])))
        return self._module.clock.now() - began

    def list_motions(self) -> list[str]:
        """Names of the recorded motions."""
        return self.store.names()

    def _check_deletion(self, str_param: str) -> None:
        if str_param in self._new_names:
            self._new_names.remove(str_param)
        else:
            self.store.require(str_param)

    def _check_rename(self, str_param: str, texts: Sequence[str]) -> None:
        self._check_deletion(str_param)
        self._require_free(texts[0], "texts")
        self._new_names.add(texts[0])

    def _require_free(self, name: str, field: str) -> None:
        if name in self._new_names:
            raise BadGoal(field, name, "a name that is free", problem=f"the chain makes a motion {name!r} before")
        self.store.require_free(name, field)

    @checked_by(_check_rename)
    def rename_motion(self, str_param: Motion, texts: NewName) -> None:
        """Give a recorded motion the name in `texts`."""
        self._module.remark(f"written: {self.store.rename(str_param, texts[0])}")

    @checked_by(_check_deletion)
    def delete_motion(self, str_param: Motion) -> None:
        """Delete a recorded motion."""
        self.store.delete(str_param)

    def replay(self, name: str, speed: float, mirror: bool) -> RecordedMotion:
        """A recorded motion as a message wants it, thinned out to key frames, measured angles put within limits."""
        motion = self.store.load(name).key_frames().faster(speed or 1.0)
        limits = {joint: (each.lower, each.upper) for joint, each in self.body.facts.limits.items()}
        return (motion.mirrored() if mirror else motion).within(limits)

    def _let_go(self, joints: list[str]) -> None:
        before = self.motion("getStiffnesses", joints)

        def stiffen() -> None:
            # Where the hand left them: stiffened joints must not jump back.
            self.body.motion_now("setAngles", joints, self.body.motion_now("getAngles", joints, True), 1.0)
            self.body.motion_now("setStiffnesses", joints, list(before))

        self._module.after_wait(stiffen)
        self.motion("setStiffnesses", joints, [0.0] * len(joints))

    def _sample(
        self, joints: list[str], duration: float, period: float, samples: list[tuple[float, list[float]]]
    ) -> None:
        began = self._module.clock.now()
        while True:
            now = self._module.clock.now() - began
            samples.append((now, list(self.motion("getAngles", joints, True))))
            if now >= duration:
                return
            # Counted from the start, so that the samples do not drift.
            due = (math.floor(now / period + 0.5) + 1) * period
            self._module.wait(max(0.0, min(due, duration) - (self._module.clock.now() - began)))

    def _save(
        self, name: str, joints: list[str], samples: list[tuple[float, list[float]]], overwrite: bool
    ) -> tuple[dict[str, Any], str]:
        """Keep a motion; what the function answers, and where the motion is."""
        rising = [row for i, row in enumerate(samples) if i == 0 or row[0] > samples[i - 1][0]]
        motion = recorded(joints, rising)
        path = self.store.save(name, motion, numbered=not overwrite)
        answer = {"motion": path.stem, "samples": len(motion.times), "duration": round(motion.duration, 3)}
        return answer, written(path, self.store.path(name))

    def _approach(self, motion: RecordedMotion) -> None:
        now = self.motion("getAngles", list(motion.joints), False)
        limits = self.body.facts.limits
        slowest = max(
            abs(angle - before) / (DEFAULT_SPEED * limits[joint].max_speed)
            for (joint, angle), before in zip(motion.start.items(), now)
        )
        time = max(APPROACH, slowest)
        angles = [[angle] for angle in motion.start.values()]
        self.motion("angleInterpolation", list(motion.joints), angles, [[time]] * len(angles), True)

    functions = {
        "recordMotion": record_motion,
        "playMotion": play_motion,
        "listMotions": list_motions,
        "renameMotion": rename_motion,
        "deleteMotion": delete_motion,
    }
