"""Whole body control: every joint motion is changed at each tick so that feet stay and the robot keeps its balance.

Tasks and targets say what the joints should do; they are the lowest of the wishes of `whole_body_step`. Only the
simulation thread calls anything here.
"""

from __future__ import annotations

from typing import AbstractSet, Iterable, Mapping, Sequence, Union

import numpy as np

from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.control.joints.engine import MotionEngine
from nao_sim_bridge.control.whole_body.aims import PathAim, TargetAim
from nao_sim_bridge.control.whole_body.body_kinematics import body_kinematics
from nao_sim_bridge.control.whole_body.cartesian_move import moving_joints
from nao_sim_bridge.control.whole_body.com_path import ComPath, plan_com_path
from nao_sim_bridge.control.whole_body.footholds import Footholds, FootState
from nao_sim_bridge.control.whole_body.grounded_pose import GroundedPose
from nao_sim_bridge.control.whole_body.inverse_kinematics import ALL_AXES, Goal, soft_knees
from nao_sim_bridge.control.whole_body.step import Demands, Freedom, joint_freedom, whole_body_step
from nao_sim_bridge.model.frames import FEET, frame_of
from nao_sim_bridge.model.robot_model import RobotModel

Aim = Union[PathAim, TargetAim]
# How readily joints help: the legs; chains of effectors that are led; other arms and the head.
LEGS_HELP, EFFECTORS_HELP, OTHERS_HELP = 0.3, 1.0, 0.02
# The centre of mass counts as in its place when it is this close, m.
BALANCED = 0.008
# A step smaller than this, rad, is none.
STILL = 1e-7
# Somebody else has changed a command by more than this, rad.
CHANGED = 1e-3


class WholeBody:
    """Keeps feet and balance while joints move.

    Attributes:
        model: The robot.
        enabled: Whether somebody has switched it on.
        controlled: Effectors that it is switched on for by themselves.
        suspended: True while the robot is not on its feet: motion passes unchanged.
    """

    def __init__(self, model: RobotModel, joints: JointCommands, motion: MotionEngine) -> None:
        self.model = model
        self._body = body_kinematics(model)
        self._joints = joints
        self._motion = motion
        self._legs = moving_joints(model, FEET)
        self._chains = {foot: [model.joint_index[name] for name in model.chains[foot]] for foot in FEET}
        self._hands = frozenset(i for i, joint in enumerate(model.joints) if joint.is_hand)
        self._moved = [i for i in range(len(model.joints)) if i not in self._hands]
        self.enabled = False
        self.controlled: set[str] = set()
        self.suspended = False
        self._reset()

    def _reset(self) -> None:
        self._feet = Footholds(self._body)
        self._support: tuple[str, ...] = FEET
        self._aims: dict[str, Aim] = {}
        self._held: dict[object, frozenset[int]] = {}
        self._com: ComPath | None = None
        self._anchor: np.ndarray | None = None
        self._seen: Sequence[float] | None = None
        self._angles = self._posture = np.zeros(0)
        self._torso = np.eye(3)
        self._legs_moved = False
        self._quiet = False

    # --- switching ------------------------------------------------------------------------------------------------

    @property
    def active(self) -> bool:
        """Whether it changes motion now."""
        return self._motion.corrector is not None

    def enable(self, on: bool) -> None:
        """Switch it on, both feet fixed and balance kept over them, or off; the joints stay where they are."""
        self.enabled = on
        if not on:
            self.controlled.clear()
        self._switch()

    def enable_effector(self, name: str, on: bool) -> None:
        """Switch it on for one effector, or off again."""
        if on:
            self.controlled.add(name)
        else:
            self.controlled.discard(name)
            self.release(name)
        self._switch()

    def _switch(self) -> None:
        wanted = self.enabled or bool(self.controlled)
        if wanted and not self.active:
            self._reset()
            self._motion.corrector = self
        elif not wanted:
            self._motion.corrector = None

    # --- what must hold -------------------------------------------------------------------------------------------

    def set_foot_states(self, feet: Iterable[str], state: FootState) -> None:
        """Say what feet may do from now on; a fixed foot stays where it is now."""
        now = self._now()
        for foot in feet:
            self.release(foot)
            self._feet.set_state(foot, state, now)
        self._center()

    def set_balance(self, feet: Sequence[str]) -> None:
        """Keep the centre of mass over those of `feet` that carry; none: let it be anywhere."""
        self._support = tuple(feet)
        self._center()

    def go_to_balance(self, feet: Sequence[str], duration: float) -> ComPath | None:
        """Bring the centre of mass over feet within `duration` s, later when that would tip the robot over.

        Returns:
            Its way; None when one of the feet is in the air, or the place over them out of reach.
        """
        now = self._now()
        if not feet or len(self._feet.on_ground(now, feet)) < len(feet):
            return None
        self.set_foot_states(feet, FootState.FIXED)
        target = self._feet.region(now, feet).center
        self._com = plan_com_path(self._body, self._now(), self._feet, target, duration)
        return self._com

    def end_way(self, way: ComPath) -> bool:
        """End a way of the centre of mass: the legs stay as they are now. Returns whether it is where it should be."""
        if self._com is not way:
            return False
        self._com = None
        self._center()
        self._stay(self._legs)
        return bool(np.linalg.norm(self._now().center_of_mass()[:2] - way.target) < BALANCED)

    def way_to(self, feet: Sequence[str]) -> float:
        """How far in m the centre of mass is from its place over feet."""
        now = self._now()
        return float(np.linalg.norm(now.center_of_mass()[:2] - self._feet.region(now, feet).center))

    # --- effectors ------------------------------------------------------------------------------------------------

    def torso_in_ground(self) -> np.ndarray:
        """(4, 4) pose of the torso in the frame that goals are in."""
        return self._now().torso

    def goal_here(self, name: str, mask: int = ALL_AXES) -> Goal:
        """A goal that is where an effector is now."""
        frame = frame_of(self.model, name)
        return Goal(frame, self._now().pose(frame), mask)

    def lead(self, name: str, aim: Aim) -> None:
        """Lead an effector from now on, until it is released or somebody else moves its joints."""
        self._aims[name] = aim
        self._quiet = False

    def aim_of(self, name: str) -> Aim | None:
        return self._aims.get(name)

    def release(self, name: str) -> None:
        """Do not lead an effector any more: its joints stay as they are."""
        if self._aims.pop(name, None) is not None and len(self._angles):
            self._stay(moving_joints(self.model, [name]))

    def stop(self, indices: Iterable[int]) -> None:
        """End the way of every effector that moves one of these joints; what helped it stays too."""
        if self._release_moving(set(indices)):
            self._stay(self._legs)
            self._torso = self._now().torso[:3, :3]

    def hold(self, owner: object, indices: Iterable[int]) -> None:
        """Move these joints as goals ask, whatever the task `owner` that has them wants."""
        self._held[owner] = frozenset(indices)

    def let_go(self, owner: object) -> None:
        """End `hold`."""
        self._held.pop(owner, None)

    # --- the tick -------------------------------------------------------------------------------------------------

    def correct(self, wanted: Mapping[int, float], dt: float) -> dict[int, float]:
        """Angles in rad that the joints should have after `dt` s, when tasks and targets want `wanted`."""
        if self.suspended or not all(self._joints.stiffnesses[i] for i in self._legs):
            self._seen = None  # legs that are limp carry nobody, and afterwards they stand elsewhere
            return dict(wanted)
        self._catch_up()
        if self._quiet and not wanted:
            return {}
        moved = self._take_up(wanted)
        for aim in self._aims.values():
            aim.advance(dt)
        com = None
        if self._com is not None:
            com, posture = self._com.advance(dt)
            self._posture[self._legs] = posture[self._legs]
        freedom = self._freedom(moved, dt)
        step = whole_body_step(self._demands(com, moved), freedom, dt)
        self._angles = self._angles + step
        self._angles[self._body.right_hip] = self._angles[self._body.left_hip]
        resting = com is None and all(aim.resting for aim in self._aims.values())
        self._quiet = resting and bool(np.abs(step).max() < STILL)
        hands = {i: angle for i, angle in wanted.items() if i in self._hands}
        return {**{i: float(self._angles[i]) for i in self._moved}, **hands}

    def _catch_up(self) -> None:
        """Take over the commands; where somebody else has changed them, they are the new posture."""
        commands = self._joints.commands
        if commands is self._seen:
            return
        angles = np.array(commands)
        if self._seen is None:
            self._posture = soft_knees(self._body, angles, self._body.movable).copy()
            self._feet.put_down(self._body.at(angles))
            self._aims.clear()
            self._com = self._anchor = None
        else:
            changed = np.abs(angles - self._angles) > CHANGED
            self._posture[changed] = angles[changed]
            self._quiet = self._quiet and not changed.any()
        begins, self._seen, self._angles = self._seen is None, commands, angles
        if begins:
            self._torso = self._now().torso[:3, :3]

    def _now(self) -> GroundedPose:
        self._catch_up()
        return GroundedPose(self._body.at(self._angles), self._feet.footing)

    def _take_up(self, wanted: Mapping[int, float]) -> dict[int, float]:
        """Note where others want joints; effectors whose joints they move are not led any more."""
        held = self._hands.union(*self._held.values())
        moved = {i: angle for i, angle in wanted.items() if i not in held}
        if self._body.right_hip in moved:
            moved.setdefault(self._body.left_hip, moved[self._body.right_hip])
        self._release_moving(moved.keys())
        for index, angle in moved.items():
            self._posture[index] = angle
        return moved

    def _release_moving(self, indices: AbstractSet[int]) -> bool:
        """Release effectors that move one of these joints; returns whether there were any."""
        names = [n for n in self._aims if not indices.isdisjoint(moving_joints(self.model, [n]))]
        for name in names:
            self.release(name)
        return bool(names)

    def _demands(self, com: np.ndarray | None, moved: Mapping[int, float]) -> Demands:
        now = self._now()
        carrying = self._feet.carrying(now, self._support)
        if any(index in moved for foot in self._feet.standing() for index in self._chains[foot]):
            self._legs_moved, self._anchor = True, None
        elif self._legs_moved:
            self._legs_moved, self._torso = False, now.torso[:3, :3]
            self._center()
        return Demands(
            now=now,
            feet=self._feet.kept,
            effectors=[aim.goal for aim in self._aims.values()],
            com=com,
            region=self._feet.region(now, carrying) if carrying else None,
            upright=self._torso,
            lean_axes=self._lean_axes(),
            anchor=self._anchor,
        )

    def _lean_axes(self) -> Sequence[int]:
        """Which way the torso should not lean: arms that reach take it with them, and so does a head that rolls."""
        if self._legs_moved or not self._aims.keys() <= {"Head", *FEET}:
            return ()
        return (1,) if "Head" in self._aims else (0, 1)

    def _freedom(self, moved: Mapping[int, float], dt: float) -> Freedom:
        mobility = np.full(len(self._angles), OTHERS_HELP)
        mobility[self._legs] = LEGS_HELP
        for name in self._aims:
            chain = self._chains.get(name)
            mobility[moving_joints(self.model, [name]) if chain is None else chain] = EFFECTORS_HELP
        return joint_freedom(self._body, self._angles, self._posture, list(moved), mobility, dt)

    def _center(self) -> None:
        """Prefer the centre of mass in the middle of a foot that carries alone: there is little room for errors."""
        now = self._now()
        carrying = self._feet.carrying(now, self._support)
        if len(carrying) == 1:
            region = self._feet.region(now, carrying)
            place = now.center_of_mass()[:2] if self._anchor is None else self._anchor
            self._anchor = region.center if region.excess(place).max() > 0.0 else place
        else:
            self._anchor = None
        self._quiet = False

    def _stay(self, indices: Sequence[int]) -> None:
        self._posture[indices] = self._angles[indices]
        self._quiet = False
