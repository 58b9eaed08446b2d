"""One NAO in a world, advanced tick by tick. No thread and no wall clock: whoever calls `tick` minds both."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Callable, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.settings import Settings
from nao_sim_bridge.body.physics import Physics
from nao_sim_bridge.body.physics_world import PhysicsWorld
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.hands import Hands
from nao_sim_bridge.core.robot import SimulatedRobot
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.core.shared_world import SharedWorld
from nao_sim_bridge.model.leds_layout import load_leds
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture, start_pitch
from nao_sim_bridge.world.places import RobotPlace, checked_places, on_circle

if TYPE_CHECKING:
    from nao_sim_bridge.cameras.cameras import Cameras
    from nao_sim_bridge.render.client import Renderer
    from nao_sim_bridge.sound.sound_world import Air, SoundWorld
    from nao_sim_bridge.world.render_state import RenderState, RobotLook

SEED_STEP = 7919
"""Between the seeds of two robots of one world, so that no two of them have the same noise."""
MAX_PIXELS = 4096
"""Of a picture from outside, each way."""
PICTURE_TIMEOUT = 30.0
"""s that a picture from outside may take, which somebody waits for."""


class Simulation:
    """A robot and the world around it as this robot knows it. The world and time may be shared with other robots.

    Time never goes back: `reset` puts everything to the start but the clock.

    Attributes:
        scene: What it started with.
        shared: What it shares with other robots, or has for itself.
        robot: The robot; replaced at a reset.
        task_ids: Source of the numbers of all tasks.
        snapshot: What was sensed at the last tick; any thread may read it.
        after_tick: Called with the snapshot at the end of every tick; they stay at a reset.
        after_reset: Called in the simulation thread when the robot is at its start again, with the world or alone.
        things: What is in the world and may come, move and go; a reset puts it to where the world file says.
        holds: As long as one of them answers True, time that runs faster than the wall clock waits: for work in other
            threads without which a fast run would give other results. Asked in the simulation thread.

    Args:
        settings: Of the physics, for a world of its own; None for those of the file.
        renderer: What draws, for a world of its own; see `SharedWorld`.
        shared: A world that others are in, too; None for one of its own.
        place: Where on the floor it starts; None for where the world says, or else the origin.
    """

    def __init__(
        self,
        scene: Scene | None = None,
        settings: Settings | None = None,
        renderer: str | Renderer = "auto",
        shared: SharedWorld | None = None,
        place: RobotPlace | None = None,
    ) -> None:
        self.scene = scene or Scene()
        self.shared = shared or SharedWorld(self.scene, settings, renderer)
        self.settings = self.shared.settings
        self.model = load_model(self.scene.version)
        self.led_layout = load_leds(self.scene.version)
        self._place = place or self.shared.next_place
        self._physics: Physics | None = None
        self.task_ids = self.shared.task_ids
        self.after_tick: list[Callable[[Snapshot], None]] = []
        self.after_reset: list[Callable[[], None]] = []
        self._sound: SoundWorld | None = None
        self._cameras: Cameras | None = None
        self.holds: list[Callable[[], bool]] = []
        self.things = self.shared.things
        self.hands = Hands(self.model, self.task_ids)
        self.robot: SimulatedRobot
        self.snapshot: Snapshot
        self.shared.join(self)

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self.shared.time

    @property
    def ticks(self) -> int:
        return self.shared.ticks

    @property
    def physics(self) -> Physics:
        """Its body in the engine."""
        return self._physics

    @property
    def renderer(self) -> Renderer:
        """What draws what the cameras see, and pictures from outside; any thread may ask."""
        return self.shared.renderer

    @property
    def sound(self) -> SoundWorld:
        """What sounds and what is heard; made when somebody first asks for it.

        It stays at a reset, which ends everything that plays.
        """
        if self._sound is None:
            self.shared.begin_sound()  # of all robots, who hear each other
        return self._sound

    @property
    def cameras(self) -> Cameras:
        """What the robot sees; made when somebody first asks for it. They stay at a reset."""
        if self._cameras is None:
            from nao_sim_bridge.cameras.cameras import Cameras  # who is blind needs nothing of them

            self._cameras = Cameras(
                self.model,
                self.settings.tick_s,
                self.renderer,
                self.render_state,
                released=lambda: self.wake(),
                guard=self.shared.guard,
            )
            self._cameras.begin(self.snapshot, self.scene.seed)
            self.holds.append(self._cameras.holds)
        return self._cameras

    @property
    def wake(self) -> Callable[[], None]:
        """To be called, from any thread, when one of `holds` may answer differently."""
        return self.shared.wake

    def vary(self, **changes: Any) -> None:
        """Change `seed`, `payload`, `sensor_delay` or `sensor_noise` of the scene; they count from the next reset on.

        Raises:
            BadValue: A number is not in its range.
        """
        self.scene = replace(self.scene, **changes)

    def reset(self) -> None:
        """Put all robots and the world to where they started; running tasks are killed."""
        self.shared.reset()

    def reboot(self) -> None:
        """Put this robot alone to where it started; its running tasks are killed.

        Where something is there, it stands beside it. A robot that has the world for itself resets the world.
        """
        if len(self.shared.robots) == 1:
            self.reset()
            return
        self.end_tasks()
        if self._sound is not None:
            self._sound.loudspeakers.stop_all()
        angles = posture(self.model, self.scene.posture)
        self._physics.restart_beside_others(angles, start_pitch(self.scene.posture))
        self._start(angles)

    def tick(self) -> Snapshot:
        """Advance all robots and the world by one tick; see `SharedWorld.tick`."""
        self.shared.tick()
        return self.snapshot

    def run(self, seconds: float) -> Snapshot:
        """Advance by `seconds` of simulated time, rounded to ticks."""
        for _ in range(round(seconds / self.settings.tick_s)):
            self.tick()
        return self.snapshot

    def inside(self) -> dict[str, float]:
        """How deep the robot is in things and in other robots, m, by name; see `Physics.inside`."""
        return self._physics.inside()

    def look(self) -> RobotLook:
        """What the robot looks like at the last tick. Any thread."""
        from nao_sim_bridge.world.render_state import RobotLook  # whom nobody sees needs nothing of it

        torso = self.snapshot.torso
        return RobotLook(torso.position, torso.orientation, self.robot.true_positions, self.robot.leds.values)

    def render_state(self, snapshot: Snapshot | None = None) -> RenderState:
        """What there is to see, with the joints as they truly are. Any thread.

        Args:
            snapshot: The last one, which is taken if nobody gives it.
        """
        from nao_sim_bridge.world.render_state import RenderState  # as for `look`

        now = snapshot or self.snapshot
        return RenderState(
            now.torso.position,
            now.torso.orientation,
            self.robot.true_positions,
            self.robot.leds.values,
            now.objects,
            now.placed,
            now.gone,
            self.shared.looks_beside(self),
        )

    def picture(self, view: str, width: int = 640, height: int = 480) -> np.ndarray:
        """A picture of this robot from a view of `PRESETS`, (height, width, 3) uint8 RGB. Any thread.

        An UnknownName of the view, a BadValue of the size in pixels, or a RenderError where it cannot be drawn.
        """
        from nao_sim_bridge.world.render_state import preset_camera  # as for `look`

        if not all(isinstance(size, int) and 1 <= size <= MAX_PIXELS for size in (width, height)):
            raise BadValue("picture size", (width, height), f"1 to {MAX_PIXELS} pixels each way")
        state = self.render_state()
        return self.renderer.render(state, preset_camera(view, self.model, state, width, height), PICTURE_TIMEOUT)

    def close(self) -> None:
        """Free the engine, for all robots of the world."""
        self.shared.close()

    # --- for the world that it is in, see `WorldRobot` --------------------------------------------------------------

    def begin(self, physics: PhysicsWorld) -> None:
        angles = posture(self.model, self.scene.posture)
        pitch = start_pitch(self.scene.posture)
        self._physics = Physics(self.model, physics, self.settings, angles, pitch, self.scene.payload, self._place)
        self._start(angles)

    def begin_again(self) -> None:
        self._physics.forget(self.scene.payload)
        self._start(posture(self.model, self.scene.posture))

    def begin_sound(self, air: Air) -> None:
        from nao_sim_bridge.sound.sound_world import SoundWorld  # who is deaf and mute needs nothing of it

        self._sound = SoundWorld(self.model, air, self.scene.seed, released=lambda: self.wake())
        self._sound.begin(self.snapshot)
        self.holds.append(self._sound.ears.holds)

    def act(self) -> Sequence[Callable[[], None]]:
        self.shared.guard.call(self.hands.tick)
        self.robot.command()
        pushes, turning = self.robot.take_pushes(), self.robot.turning()
        return [*turning, *self._physics.pushing(pushes)] if pushes else turning

    def sense(self, ticks: int = 1) -> None:
        self.snapshot = self.robot.sense(self.shared.ticks, self.shared.time, ticks=ticks)
        if self._sound is not None:
            self._sound.record(self.snapshot)

    def perceive(self) -> None:
        if self._sound is not None:
            self.shared.guard.call(self._sound.hear)
        if self._cameras is not None:
            self._cameras.tick(self.snapshot)

    def end_tasks(self) -> None:
        self.robot.motion.kill_all()
        self.robot.leds.kill_all()

    def look_again(self) -> None:
        bodies = self._physics.bodies
        self.snapshot = replace(self.snapshot, objects=bodies.read(), placed=bodies.placed, gone=bodies.gone)

    def close_senses(self) -> None:
        if self._sound is not None:
            self._sound.close()
        if self._cameras is not None:
            self._cameras.close()

    def _start(self, angles: Sequence[float]) -> None:
        """A new robot around its body, which is at its start."""
        self.robot = SimulatedRobot(
            self.model,
            self.led_layout,
            self.settings,
            self._physics,
            angles,
            self.scene,
            self.task_ids,
        )
        self.hands.begin(self._physics, self.robot)
        self.snapshot = self.robot.sense(self.shared.ticks, self.time, landed=False)
        if self._sound is not None:
            self._sound.begin(self.snapshot)
        if self._cameras is not None:
            self._cameras.begin(self.snapshot, self.scene.seed)
        for call in self.after_reset:
            self.shared.guard.call(call)


def robots_in(
    shared: SharedWorld, scene: Scene, count: int = 1, places: Sequence[RobotPlace] = ()
) -> tuple[Simulation, ...]:
    """Put robots into a new world, each with a seed of its own.

    Args:
        shared: The world, in which nobody is yet.
        scene: What they start with; the seed is that of the first one.
        count: How many there are.
        places: Where they stand; empty for where the world says, or else a circle.

    Raises:
        BadValue: There are too few places, they are too near to each other, or `count` is out of range.
    """
    there = checked_places(places or shared.world.robots or on_circle(count), count)
    return tuple(
        Simulation(replace(scene, seed=scene.seed + SEED_STEP * number), shared=shared, place=place)
        for number, place in enumerate(there)
    )
