"""Motion functions that record what joints do, replay it, and keep it under names."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from nao_library_msgs.msg import FunctionResult

from ..base.answers import values_of
from ..base.errors import BadGoal
from ..base.whole_file import written
from ..functions.chain import checked_by
from .base import DEFAULT_SPEED, MotionBase
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

# The way to the first pose of a motion takes that long at least, s.
APPROACH = 0.5


def check_recording(
    self: MotionRecording, str_param: str, names: Sequence[str], duration: float, overwrite: bool
) -> None:
    """A name for the motion, free or to be overwritten, known joints."""
    if not overwrite:
        self.require_free(str_param, "str_param")
    joints = self.plan.facts.joints(names or [BODY])
    self.plan.touch(joints)
    self.plan.forget(joints)
    self.plan.takes(duration)
    self.recording_names.add(str_param)


def check_replay(self: MotionRecording, str_param: str, speed: float, mirror: bool, stiffness: float) -> None:
    """A recorded motion that the joints can follow at that speed."""
    if str_param in self.recording_names:
        return  # recorded by an earlier function of this chain: nothing is known of it yet
    motion = self.replay(str_param, speed, mirror)
    self.plan.facts.joints(motion.joints, f"str_param ({str_param})")
    self.plan.require_stiff(motion.joints, stiffness)
    self.plan.move_with_speed(dict(motion.start), dict.fromkeys(motion.joints, DEFAULT_SPEED))
    if len(motion.times) > 1:
        values = {joint: [row[i] for row in motion.angles[1:]] for i, joint in enumerate(motion.joints)}
        self.plan.follow(values, motion.times[1:], False, f"str_param ({str_param})")


def check_rename(self: MotionRecording, str_param: str, texts: Sequence[str]) -> None:
    """A recorded motion, a new name that is free."""
    check_deletion(self, str_param)
    self.require_free(texts[0], "texts")
    self.recording_names.add(texts[0])


def check_deletion(self: MotionRecording, str_param: str) -> None:
    """A recorded motion, or one that the chain records."""
    if str_param in self.recording_names:
        self.recording_names.remove(str_param)
    else:
        self.store.require(str_param)


class MotionRecording(MotionBase):
    """Recorded motions. Parameters are fields of MotionFunction.

    Attributes:
        store: Recorded motions by name.
        recording_names: Motions that the chain records or gives these names.
        cut_short: What recordings that were interrupted have left, for the result of the chain.
    """

    store: MotionStore
    recording_names: set[str]
    cut_short: list[FunctionResult]
    remark: Callable[[str], None]  # of NaoBasic
    clock: Any  # of NaoBasic
    wait: Callable[[float], None]  # of NaoBasic: a wait that preemption ends
    after_wait: Callable[[Callable[[], None]], None]  # of NaoBasic

    @checked_by(check_recording)
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
        joints = self.joints(names or [BODY])
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
        self.remark(told)
        return answer

    @checked_by(check_replay)
    def play_motion(self, str_param: Motion, speed: ReplaySpeed, mirror: Mirror, stiffness: Stiffness) -> float:
        """Replay a recorded motion, from wherever the joints are; answers how long it took, s."""
        motion = self.replay(str_param, speed, mirror)
        joints = list(motion.joints)
        self.stiffen(joints, stiffness)
        began = self.clock.now()
        self._approach(motion)
        if len(motion.times) > 1:
            paths = [[row[i] for row in motion.angles[1:]] for i in range(len(joints))]
            self.motion("angleInterpolation", joints, paths, [list(motion.times[1:])] * len(joints), True)
        self.require_reached(dict(zip(joints, motion.angles[-1])))
        return self.clock.now() - began

    def require_free(self, name: str, field: str) -> None:
        """See that a motion can get this name.

        Raises:
            BadGoal: It will not do, or there is one, or will be one by then.
        """
        if name in self.recording_names:
            raise BadGoal(field, name, "a name that is free", problem=f"the chain makes a motion {name!r} before")
        self.store.require_free(name, field)

    def list_motions(self) -> list[str]:
        """Names of the recorded motions."""
        return self.store.names()

    @checked_by(check_rename)
    def rename_motion(self, str_param: Motion, texts: NewName) -> None:
        """Give a recorded motion the name in `texts`."""
        self.remark(f"written: {self.store.rename(str_param, texts[0])}")

    @checked_by(check_deletion)
    def delete_motion(self, str_param: Motion) -> None:
        """Delete a recorded motion."""
        self.store.delete(str_param)

    def replay(self, name: str, speed: float, mirror: bool) -> RecordedMotion:
        """A recorded motion as a message wants it, thinned out to key frames, measured angles put within limits."""
        motion = self.store.load(name).key_frames().faster(speed or 1.0)
        limits = {joint: (each.lower, each.upper) for joint, each in self.access.facts.limits.items()}
        return (motion.mirrored() if mirror else motion).within(limits)

    def _let_go(self, joints: list[str]) -> None:
        before = self.motion("getStiffnesses", joints)

        def stiffen() -> None:
            proxy = self.robot.proxy("ALMotion")
            # Where the hand left them: stiffened joints must not jump back.
            self.call_now(proxy, "setAngles", joints, self.call_now(proxy, "getAngles", joints, True), 1.0)
            self.call_now(proxy, "setStiffnesses", joints, list(before))

        self.after_wait(stiffen)
        self.motion("setStiffnesses", joints, [0.0] * len(joints))

    def _sample(
        self, joints: list[str], duration: float, period: float, samples: list[tuple[float, list[float]]]
    ) -> None:
        began = self.clock.now()
        while True:
            now = self.clock.now() - began
            samples.append((now, list(self.motion("getAngles", joints, True))))
            if now >= duration:
                return
            # Counted from the start, so that the samples do not drift.
            due = (math.floor(now / period + 0.5) + 1) * period
            self.wait(max(0.0, min(due, duration) - (self.clock.now() - began)))

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
        limits = self.access.facts.limits
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
