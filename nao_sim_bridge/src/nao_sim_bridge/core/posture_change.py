"""Going to a predefined posture along the posture graph, looking after each move where it led.

Only the simulation thread calls anything here.
"""

from __future__ import annotations

import logging
from typing import Callable, Iterator, Sequence

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.posture_recognition import SITTING, UNKNOWN, Recognition, nearest_posture, recognise
from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.core.posture_graph import leaves_feet, path_to
from nao_sim_bridge.core.posture_moves import Ground, Move, direct, load_moves, play
from nao_sim_bridge.core.robot import SimulatedRobot
from nao_sim_bridge.core.sequences import (
    STIFFEN_TIME,
    Step,
    body_is_stiff,
    is_on_feet,
    posture_task,
    run_steps,
    stiffen,
    stiffness_task,
    stop_walk,
)
from nao_sim_bridge.model.postures import load_postures, posture

log = logging.getLogger("nao_sim.posture")

# A robot is at rest when all joints (rad/s) and its torso (rad/s) turn slower than this.
STILL_JOINTS, STILL_TORSO = 0.15, 0.15
# It is looked at this often, s, and what still sways after this time, s, is taken as it is.
LOOK_TIME, LONGEST_SWAY = 0.2, 2.0
# A posture is had exactly when no command is further off than this, rad.
EXACT = 0.005
# Straight to a posture, as fast as the joints can, without a thought about the floor.
STRAIGHT = Ground((), LOOK_TIME)
# In these postures a limp robot stays: the first one from its feet, the second one from its seat. Who lies stays as
# well. The way to the second one goes at a share of the joints' top speeds, and so many of its moves may miss.
CROUCHED, LEANING = "Crouch", "SitRelax"
REST_SPEED, REST_TRIES = 0.6, 2
# Moves on one way at most: the graph has no way longer than this, so more is a robot that goes round in circles.
MOST_MOVES = 12


class PostureChange:
    """One way to one posture.

    Attributes:
        reached: Whether the robot is there.
        failure: Why it gave up; empty as long as it has not.
        misses: Moves that led somewhere else than they should.

    Args:
        fraction: Share of the joints' top speeds, above 0 to 1, for moves that may be slow.
        tries: How many moves may miss before it gives up.
        moves: The moves with key frames that it may take.
    """

    def __init__(
        self,
        robot: SimulatedRobot,
        snapshot: Callable[[], Snapshot],
        goal: str,
        fraction: float,
        tries: int,
        moves: Sequence[Move],
    ) -> None:
        self.reached = False
        self.failure = ""
        self.misses = 0
        self._robot = robot
        self._snapshot = snapshot
        self._goal = goal
        self._fraction = fraction
        self._tries = tries
        self._moves = moves
        self._body = range(len(robot.model.joints))

    def start(self, name: str = "goToPosture") -> Task:
        """Go by the posture graph; the task ends with whether it got there.

        Whatever moves the joints or changes their stiffness ends, a walk on two feet; all joints get stiff.
        """
        return run_steps(self._robot, name, self._steps(name), self._end)

    def start_straight(self, name: str = "applyPosture") -> Task:
        """Take every joint straight to the posture, wherever the robot is; the task ends with whether they did."""

        def move() -> Task:
            robot = self._robot
            way = direct(robot.model, UNKNOWN, self._goal, robot.joints.commands, self._fraction, STRAIGHT)
            return play(robot, name, way)

        def look() -> None:
            family = load_postures().by_name[self._goal].family
            self.reached = nearest_posture(self._robot.model, self._snapshot().positions, family) == self._goal

        return run_steps(
            self._robot, name, [self._stop_walk, self._clear, move, lambda: self._hold(name), look], self._end
        )

    # --- the way --------------------------------------------------------------------------------------------------

    def _steps(self, name: str) -> Iterator[Step]:
        yield self._stop_walk
        self._clear()
        if min(self._robot.joints.stiffnesses) < 1.0:
            yield lambda: stiffen(self._robot, name, self._snapshot())
        yield from self._until_still(name)
        seen = self._look()
        there = self._exact()
        for _ in range(MOST_MOVES):
            if self._robot.walking:  # begun between two moves
                yield self._stop_walk
                seen, there = self._look(), False
            if there and seen.posture == self._goal:
                self.reached = True
                return
            commands = self._robot.joints.commands
            way = path_to(self._goal, seen, commands, self._fraction, self._robot.model, self._moves)
            if way is None:
                self._give_up(f"no way leads there from {_words(seen)}")
                return
            move = way[0]
            log.info("%s %s: %s, %.1f s", name, self._goal, move, move.duration)
            self._robot.getting_up = leaves_feet(seen, move)
            yield lambda move=move: play(self._robot, name, move)  # type: ignore[misc]
            yield from self._until_still(name)
            self._robot.getting_up = False
            seen = self._look()
            there = move.goal == self._goal
            if not _arrived(seen, move):
                self.misses += 1
                log.info("%s %s: %s ended in %s", name, self._goal, move, _words(seen))
                if self.misses >= self._tries:
                    self._give_up(f"{move} ended in {_words(seen)}, miss {self.misses} of {self._tries}")
                    return
        self._give_up(f"not there after {MOST_MOVES} moves, but in {_words(seen)}")

    def _until_still(self, name: str) -> Iterator[Step]:
        for _ in range(round(LONGEST_SWAY / LOOK_TIME)):
            yield lambda: self._hold(name)
            if _still(self._snapshot()):
                return

    def _hold(self, name: str) -> Task:
        """Keep all joints where they are told to be for a moment."""
        return self._robot.motion.follow(
            name, self._body, lambda now: {i: SmoothCurve((0.0, LOOK_TIME), (now[i], now[i])) for i in self._body}
        )

    # --- looking and ending ---------------------------------------------------------------------------------------

    def _look(self) -> Recognition:
        return recognise(self._robot.model, self._snapshot())

    def _exact(self) -> bool:
        aims = posture(self._robot.model, self._goal)
        return all(abs(aim - told) <= EXACT for aim, told in zip(aims, self._robot.joints.commands))

    def _stop_walk(self) -> Task | None:
        return stop_walk(self._robot)

    def _clear(self) -> None:
        """End every motion and every change of stiffness; the joints stay as they are."""
        self._robot.motion.kill_using(self._body)
        self._robot.motion.set_stiffness_now(dict(enumerate(self._robot.joints.stiffnesses)))

    def _give_up(self, reason: str) -> None:
        self.failure = reason
        log.warning("goToPosture %s gives up: %s", self._goal, reason)

    def _end(self) -> bool:
        self._robot.getting_up = False
        return self.reached


def rest(robot: SimulatedRobot, snapshot: Callable[[], Snapshot], on_end: Callable[[], None]) -> Task:
    """Crouch, or lean on the hands when seated, where a stiff robot would fall, then release all motors.

    `on_end` is called after the last step.
    """

    def settle() -> Task | None:
        if not body_is_stiff(robot):
            return None
        if is_on_feet(robot, snapshot()):
            return posture_task(robot, "rest", CROUCHED)
        if recognise(robot.model, snapshot()).family != SITTING:
            return None
        return PostureChange(robot, snapshot, LEANING, REST_SPEED, REST_TRIES, load_moves()).start("rest")

    def release() -> Task:
        return stiffness_task(robot, "rest", range(len(robot.model.joints)), 0.0, STIFFEN_TIME)

    return run_steps(robot, "rest", [lambda: stop_walk(robot), settle, release, on_end])


def _arrived(seen: Recognition, move: Move) -> bool:
    """Whether a move led where it should: a direct one exactly, a dynamic one into the family at least."""
    return seen.posture == move.goal or (move.dynamic and seen.family == move.goal_family)


def _still(snapshot: Snapshot) -> bool:
    turning = max(map(abs, snapshot.angular_velocity))
    return turning < STILL_TORSO and max(map(abs, snapshot.velocities)) < STILL_JOINTS


def _words(seen: Recognition) -> str:
    return seen.family if seen.posture in (UNKNOWN, seen.family) else f"{seen.posture} ({seen.family})"
