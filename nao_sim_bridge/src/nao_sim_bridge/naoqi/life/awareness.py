"""Basic awareness: the robot looks where something happens, and follows a person's face. Simulation thread only."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import Any, Callable, Sequence

from nao_sim_bridge.base.errors import MoveRefused
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.model.frames import ROBOT
from nao_sim_bridge.naoqi.binding.arguments import known, number
from nao_sim_bridge.naoqi.binding.background import ModuleCalls
from nao_sim_bridge.naoqi.life.stimuli import MOVEMENT, NAME, PEOPLE, Stimuli
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.tracker.targets import Sighting
from nao_sim_bridge.tracking import geometry
from nao_sim_bridge.tracking.follower import Follower, Mode
from nao_sim_bridge.tracking.geometry import Point
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FeetGait

STIMULUS, TRACKED, LOST = (f"{NAME}/{event}" for event in ("StimulusDetected", "HumanTracked", "HumanLost"))
UNENGAGED, SEMI, FULLY = ENGAGEMENTS = ("Unengaged", "SemiEngaged", "FullyEngaged")
HEAD, ROTATION, WHOLE_BODY, CONTEXTUAL = TRACKINGS = ("Head", "BodyRotation", "WholeBody", "MoveContextually")
# Somebody who is not seen for so long is lost, s.
LOST_AFTER = 2.0
# Full speed of looking, rad/s.
TOP_SPEED = 4.0
NOBODY = -1


@dataclass(frozen=True)
class Settings:
    """Parameters under NAOqi's names."""

    LookStimulusSpeed: float = 0.5  # how fast it looks where something happens, share of the top speed
    LookBackSpeed: float = 0.3  # how fast it looks back, share of the top speed
    NobodyFoundTimeOut: float = 2.0  # how long it looks for somebody where something happened, s
    MinTimeTracking: float = 2.0  # how long it follows somebody at least before something else may interest it, s
    TimeOutResetHead: float = 10.0  # after so long without anything it looks ahead again, s
    AmplitudeYawTracking: float = 90.0  # how far the head turns to follow, deg to both sides together
    BodyRotationThresholdNao: float = 30.0  # from which HeadYaw on the body turns, too, deg


RANGES = {
    "LookStimulusSpeed": (0.01, 1.0),
    "LookBackSpeed": (0.01, 1.0),
    "NobodyFoundTimeOut": (0.3, 600.0),
    "MinTimeTracking": (0.5, 600.0),
    "TimeOutResetHead": (0.0, 600.0),
    "AmplitudeYawTracking": (10.0, 230.0),
    "BodyRotationThresholdNao": (5.0, 115.0),
}
PARAMETERS = tuple(field.name for field in fields(Settings))


class Awareness:
    """Looks at people, and where something happens, unless somebody else has the head: `busy` tells.

    Attributes:
        engagement: How easily it turns away from a person: one of `ENGAGEMENTS`.
        tracking: What moves: one of `TRACKINGS`.
    """

    def __init__(self, runner: RobotRunner, memory: MemoryStore, calls: ModuleCalls, busy: Callable[[], bool]) -> None:
        self.enabled = self.paused = False
        self.engagement, self.tracking = UNENGAGED, HEAD
        self.stimuli = Stimuli(runner, memory, calls, self._react)
        self.settings = Settings()
        self._simulation = runner.simulation
        self._memory = memory
        self._busy = busy
        self._follower = Follower(runner.simulation)
        self.human = NOBODY  # the number of the face that is followed
        self._engaged = NOBODY
        self._since = self._seen = self._until = self._last = 0.0
        self._looks = False
        self._triggered = 0
        for event in (STIMULUS, TRACKED, LOST):
            memory.declare_event(event, NAME)
        runner.simulation.after_tick.append(self._tick)
        runner.simulation.after_reset.append(self._after_reset)

    @property
    def running(self) -> bool:
        return self.enabled and not self.paused

    def update(self) -> None:
        """Begin or end as `enabled`, `paused`, `stimuli` and `tracking` say."""
        self.stimuli.listen(self.running)
        self._follower.mode = Mode.WHOLE_BODY if self.tracking == WHOLE_BODY else Mode.HEAD
        if not self.running:
            self._leave()

    def set_parameter(self, name: str, value: Any) -> None:
        """Change a parameter.

        An UnknownName when there is no such parameter, a BadValue when it is out of its range.
        """
        limits = RANGES[known(name, "parameter", PARAMETERS)]
        self.settings = replace(self.settings, **{name: number(value, name, *limits)})

    def trigger(self, place: Point) -> int:
        """Something happens at a place of the world, m; returns the number of this stimulus."""
        self._triggered += 1
        self._look(place)
        return self._triggered

    def engage(self, person: int) -> bool:
        """Follow one person from now on; False when nobody of this number is followed now, who has to be in view."""
        if person != self.human:
            return False
        self._engaged = person
        return True

    def _react(self, stimulus: str, sightings: Sequence[Sighting]) -> None:
        if self._busy():
            return
        if stimulus == PEOPLE:
            self._follow(sightings)
            return
        now = self._simulation.time
        if self.human != NOBODY and (self.engagement == FULLY or now - self._since < self.settings.MinTimeTracking):
            return
        if self.human != NOBODY and self.engagement == SEMI and stimulus == MOVEMENT:
            return
        if self._looks and now < self._until:
            return  # it looks at something already
        self._memory.raise_event(STIMULUS, stimulus)
        self._look(self._in_world(sightings[0].place))

    # --- looking --------------------------------------------------------------------------------------------------

    def _follow(self, faces: Sequence[Sighting]) -> None:
        """A picture shows faces: follow the same as before, or else the nearest."""
        wanted = self._engaged if self._engaged != NOBODY else self.human
        face = next((face for face in faces if face.number == wanted), None)
        if face is None:
            if self.human != NOBODY and self._simulation.time - self._seen < LOST_AFTER:
                return
            face = faces[0]
        now = self._simulation.time
        if face.number != self.human:
            if self.human == NOBODY:
                self._memory.raise_event(STIMULUS, PEOPLE)
            self.human, self._since = face.number, now
            self._memory.raise_event(TRACKED, face.number)
        self._seen = self._last = now
        self._looks = False
        self._aim(self._in_world(face.place), self.settings.LookStimulusSpeed)

    def _look(self, place: Point) -> None:
        """Look where something happens, for somebody who may be there."""
        now = self._simulation.time
        self._looks, self._last = True, now
        self._until = now + self.settings.NobodyFoundTimeOut
        self._aim(place, self.settings.LookStimulusSpeed)

    def _aim(self, place: Point, share: float) -> None:
        self._follower.velocity = share * TOP_SPEED
        limit = math.radians(self.settings.AmplitudeYawTracking) / 2.0
        model, placed = self._simulation.model, self._placed()
        x, y, z = geometry.in_frame(model, placed, place, ROBOT)
        bearing = math.atan2(y, x)
        if self.tracking in (ROTATION, CONTEXTUAL):
            self._turn(bearing)
        elif abs(bearing) > limit and self.tracking == HEAD and self.human != NOBODY:
            bearing, distance = math.copysign(limit, bearing), math.hypot(x, y)
            place = self._in_world((distance * math.cos(bearing), distance * math.sin(bearing), z))
        self._follower.follow(place)

    def _turn(self, bearing: float) -> None:
        """Turn the body to what is too far aside for the head."""
        locomotion = self._simulation.robot.locomotion
        if abs(bearing) < math.radians(self.settings.BodyRotationThresholdNao) or locomotion.active:
            return
        try:
            locomotion.move_to([FootPose(0.0, 0.0, bearing)], FeetGait())
        except MoveRefused:
            pass  # it does not stand: the head alone follows

    def _tick(self, now: Any) -> None:
        if not self.running:
            return
        if self._busy():
            self._follower.lose()
            return
        if self.human != NOBODY and now.time - self._seen > LOST_AFTER:
            self._lose()
        if self._looks and now.time > self._until and self.human == NOBODY:
            self._looks = False
            self._look_ahead(self.settings.LookBackSpeed)
        elif self._last and now.time - self._last > self.settings.TimeOutResetHead and self.human == NOBODY:
            self._last = 0.0
            self._look_ahead(self.settings.LookBackSpeed)

    def _lose(self) -> None:
        self.human = self._engaged = NOBODY
        self._memory.raise_event(LOST, None)
        self._memory.raise_event(TRACKED, NOBODY)
        self._follower.lose()

    def _look_ahead(self, share: float) -> None:
        self._follower.velocity = share * TOP_SPEED
        self._follower.follow(self._in_world((2.0, 0.0, 0.6)))

    def _leave(self) -> None:
        if self.human != NOBODY:
            self._lose()
        self._looks, self._last = False, 0.0
        self._follower.stop()

    def _placed(self) -> Any:
        return geometry.placement(self._simulation.model, self._simulation.snapshot)

    def _in_world(self, place: Point) -> Point:
        return geometry.in_world(self._simulation.model, self._placed(), place)

    def _after_reset(self) -> None:
        self.human = self._engaged = NOBODY
        self._looks, self._last = False, 0.0
        if self.enabled or self.paused:
            self.enabled = self.paused = False
            self.update()
