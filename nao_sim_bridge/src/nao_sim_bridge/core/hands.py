"""Simulated hands that touch a robot: small bodies that come, press lightly on a sensor, and go.

A hand is as light as a finger and held by a weak force, so that it yields before the robot does. It goes with the part
of the robot that it touches, passes through everything else, and is seen in pictures.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Dict, Sequence

from nao_sim_bridge.base.errors import BadValue, NotAllowed, SimulationError, check_finite
from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.tasks import Task, TaskIds
from nao_sim_bridge.body.hand import AWAY, DEPTH, TIP_RADIUS, HandPath, make_hand
from nao_sim_bridge.model.robot_model import RobotModel

if TYPE_CHECKING:
    from nao_sim_bridge.body.physics import Physics
    from nao_sim_bridge.core.robot import SimulatedRobot

MOST_HANDS = 8
FORCE = 1.0
"""What moves a hand and presses it on, N at most."""
INERTIA = 1e-5
"""Of a hand about each axis, kg m2: that of its tip alone would make it tremble."""
COME_TIME, LEAVE_TIME = 0.25, 0.15
PRESSED = TIP_RADIUS - DEPTH
"""Where the middle of the tip aims while it presses, m off the surface."""
PATIENCE = 1.5
"""How long a hand tries to be felt, s."""
LONGEST_TOUCH = 600.0
STROKE_BEGIN, STROKE_SHARE = 0.15, 0.55
"""A stroke moves in the middle of its time, as shares of it: the hand is a little late, and must arrive."""
FIRST_BIT = 1 << 8
"""From here on the engine's groups are free; a link is in one more for each hand that touches it."""
UNTURNED = (0.0, 0.0, 0.0, 1.0)
COMING, TOUCHING, LEAVING = "coming", "touching", "leaving"


@dataclass
class _Hand:
    """One hand.

    Attributes:
        path: What it touches.
        duration: How long it touches once it is felt, s; 0 until it is released.
        task: Ends when it is over or, without a duration, when it is felt.
        name: Of the thing that it is.
        constraint: What holds it.
        state: What it does.
        since: Since when it does it, s.
        contact: Simulated time at which it was felt first, s; None before that.
    """

    path: HandPath
    duration: float
    task: Task
    name: str
    constraint: int
    state: str
    since: float
    contact: float | None = None


class Hands:
    """All hands that touch one robot. Simulation thread only."""

    def __init__(self, model: RobotModel, task_ids: TaskIds) -> None:
        self._model = model
        self._ids = task_ids
        self._physics: Physics | None = None
        self._robot: SimulatedRobot | None = None
        self._hands: Dict[str, _Hand] = {}

    def begin(self, physics: Physics, robot: SimulatedRobot) -> None:
        """Start all over with a robot: no hand is there any more."""
        if self._physics is not None and self._physics.shared is physics.shared:
            for hand in list(self._hands.values()):
                self._remove(hand)
        ended, self._hands = self._hands, {}
        self._physics, self._robot = physics, robot
        for hand in ended.values():
            hand.task.kill()

    def end(self) -> None:
        """End all touches; the world ends with them."""
        hands, self._hands = self._hands, {}
        for hand in hands.values():
            hand.task.kill()

    def touch(self, sensors: Sequence[str], duration: float) -> Task:
        """Let a hand come and touch a sensor, or stroke over several in turn.

        Args:
            sensors: Names of sensors, or of their events.
            duration: How long it touches, or takes for the stroke, s from when it is felt; 0: until it is released.

        Returns:
            A task that ends when the hand has gone or, without a duration, when it is felt; its result is the simulated
            time, s, of the first contact, None if the hand was sent away before. It fails when nothing is felt. When it
            is killed, the hand goes.

        Raises:
            UnknownName: There is no such sensor.
            BadValue: The duration or the number of hands is out of range, or the sensors do not go together.
            NotAllowed: A hand is there already.
        """
        path = HandPath(self._model, sensors)
        if not 0.0 <= duration <= LONGEST_TOUCH:
            raise BadValue("duration", duration, f"0 to {LONGEST_TOUCH:g} s")
        if duration == 0.0 and len(path.sensors) > 1:
            raise BadValue("duration", duration, "above 0 for a stroke")
        for hand in self._hands.values():
            both = set(hand.path.sensors) & set(path.sensors)
            if both and hand.state != LEAVING:
                raise NotAllowed(f"a hand touches {min(both)} already: release it first")
        if len(self._hands) >= MOST_HANDS:
            raise BadValue("number of hands", len(self._hands) + 1, f"{MOST_HANDS} at most")
        name = self._free_name()
        task = self._ids.make("touch", on_kill=lambda _: self._send_away(name))
        self._hands[name] = _Hand(path, duration, task, name, self._bring(name, path), COMING, self._robot.time)
        return task

    def release(self, sensors: Sequence[str] = ()) -> None:
        """Let hands go: those on these sensors or, if none is named, all."""
        wanted = set(HandPath(self._model, sensors).sensors) if sensors else None
        for hand in self._hands.values():
            if wanted is None or wanted.intersection(hand.path.sensors):
                self._leave(hand)

    def tick(self) -> None:
        """Move all hands; before each step of physics."""
        for hand in list(self._hands.values()):
            if hand.name not in self._physics.bodies.ids:  # somebody has removed it like any thing
                self._let_touch(hand.path.link, self._bit(hand.name), False)
                del self._hands[hand.name]
                hand.task.kill()
                continue
            self._decide(hand)
            if hand.name in self._hands:
                self._move(hand)

    def _decide(self, hand: _Hand) -> None:
        """Go on with the next part of a touch when it is time."""
        elapsed = self._robot.time - hand.since
        if hand.state == COMING and self._felt(hand):
            hand.state, hand.since, hand.contact = TOUCHING, self._robot.time, self._robot.snapshot.time
            if hand.duration == 0.0:
                hand.task.finish(hand.contact)
        elif hand.state == COMING and elapsed > COME_TIME + PATIENCE:
            self._leave(hand)
            hand.task.finish(error=SimulationError(f"the hand is not felt at {hand.path.sensors[0]}"))
        elif hand.state == TOUCHING and hand.duration and elapsed >= hand.duration - 1e-9:
            self._leave(hand)
        elif hand.state == LEAVING and elapsed >= LEAVE_TIME - 1e-9:
            self._remove(hand)
            del self._hands[hand.name]
            hand.task.finish(hand.contact)

    def _felt(self, hand: _Hand) -> bool:
        sensed = self._robot.snapshot
        return sensed is not None and hand.path.sensors[0] in sensed.touched

    def _leave(self, hand: _Hand) -> None:
        if hand.state != LEAVING:
            hand.state, hand.since = LEAVING, self._robot.time

    def _send_away(self, name: str) -> None:
        if name in self._hands:
            self._leave(self._hands[name])

    def _move(self, hand: _Hand) -> None:
        """Pull a hand to where it is to be at the end of this tick."""
        pose = self._aim(hand.path, *self._where(hand))
        check_finite(hand.name, (*pose.position, *pose.orientation))
        self._physics.engine.changeConstraint(
            hand.constraint, jointChildPivot=pose.position, jointChildFrameOrientation=pose.orientation, maxForce=FORCE
        )

    def _where(self, hand: _Hand) -> tuple[float, float]:
        """How far along its sensors a hand is, 0..1, and how far off them, m."""
        elapsed = self._robot.time - hand.since
        if hand.state == COMING:
            return 0.0, AWAY - (AWAY - PRESSED) * min(elapsed / COME_TIME, 1.0)
        if hand.state == TOUCHING:
            return (elapsed / hand.duration - STROKE_BEGIN) / STROKE_SHARE if hand.duration else 0.0, PRESSED
        return 1.0, PRESSED + (AWAY - PRESSED) * min(elapsed / LEAVE_TIME, 1.0)

    def _aim(self, path: HandPath, share: float, off: float) -> Pose:
        """In world."""
        link = self._physics.pose_of(self._model.link(path.link).alt_name)
        position, turn = path.at(share, off)
        return Pose(*self._physics.engine.multiplyTransforms(link.position, link.orientation, position, turn))

    # --- bodies ---------------------------------------------------------------------------------------------------

    def _bring(self, name: str, path: HandPath) -> int:
        """Make a hand that collides with one part of the robot only; the constraint that holds it."""
        bodies, engine = self._physics.bodies, self._physics.engine
        bodies.add(make_hand(name))
        path.lifts = [self._lift(path, number) for number in range(len(path.sensors))]
        start = self._aim(path, 0.0, AWAY)
        bodies.put(name, start)
        body = bodies.ids[name]
        engine.changeDynamics(
            body,
            -1,
            localInertiaDiagonal=(INERTIA, INERTIA, INERTIA),
            activationState=self._physics.engine.ACTIVATION_STATE_DISABLE_SLEEPING,
        )
        bit = self._bit(name)
        engine.setCollisionFilterGroupMask(body, -1, bit, bit)
        self._let_touch(path.link, bit, True)
        return engine.createConstraint(
            body,
            -1,
            -1,
            -1,
            self._physics.engine.JOINT_FIXED,
            (0.0, 0.0, 0.0),
            (0.0, 0.0, 0.0),
            start.position,
            UNTURNED,
            start.orientation,
        )

    def _lift(self, path: HandPath, number: int) -> float:
        """How far the surface is over a sensor, m: on the way of the hand, if nothing hides it."""
        link = self._physics.pose_of(self._model.link(path.link).alt_name)
        position, normal = path.sensor(number)
        ends = [
            self._physics.engine.multiplyTransforms(
                link.position, link.orientation, [p + off * n for p, n in zip(position, normal)], UNTURNED
            )[0]
            for off in (AWAY, -AWAY)
        ]
        body, index, share = self._physics.engine.rayTest(*ends)[0][:3]
        if (body, index) != (self._physics.robot, self._index(path.link)):
            return 0.0
        return AWAY - share * 2.0 * AWAY

    def _let_touch(self, link: str, bit: int, touch: bool) -> None:
        """Let the hand of a bit touch a link, or pass through it as through everything else.

        By groups, not by pairs: those belong to the number of a body, which the engine gives to others afterwards.
        """
        index, physics = self._index(link), self._physics
        groups = physics.shared.groups(physics.robot, index)
        physics.shared.let_meet(physics.robot, index, groups | bit if touch else groups & ~bit)

    def _index(self, link: str) -> int:
        return self._physics.links.get(self._model.link(link).alt_name, -1)

    def _bit(self, name: str) -> int:
        return FIRST_BIT << (int(name.partition("_")[2] or 1) - 1)

    def _remove(self, hand: _Hand) -> None:
        self._let_touch(hand.path.link, self._bit(hand.name), False)
        if hand.name in self._physics.bodies.ids:
            self._physics.engine.removeConstraint(hand.constraint)
            self._physics.bodies.remove(hand.name)

    def _free_name(self) -> str:
        names = ["hand", *(f"hand_{number}" for number in range(2, MOST_HANDS + 1))]
        taken = {*self._physics.bodies.ids, *self._hands}
        for name in names:
            if name not in taken:
                return name
        raise NotAllowed("there are things called hand, hand_2, ... already: remove them")
