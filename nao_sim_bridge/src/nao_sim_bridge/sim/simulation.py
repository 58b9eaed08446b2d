"""A world with one NAO, advanced tick by tick. No thread and no wall clock: whoever calls `tick` minds both."""

from __future__ import annotations

from dataclasses import replace
from typing import Callable

from nao_sim_bridge.sim.cameras.cameras import Cameras
from nao_sim_bridge.sim.leds_layout import load_leds
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.physics import Physics
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.render.client import Renderer
from nao_sim_bridge.sim.render.scene import RenderState
from nao_sim_bridge.sim.robot import SimulatedRobot
from nao_sim_bridge.sim.scene import Scene
from nao_sim_bridge.sim.settings import Settings, load_settings
from nao_sim_bridge.sim.snapshot import Snapshot
from nao_sim_bridge.sim.sound.sound_world import SoundWorld
from nao_sim_bridge.sim.start_lean import start_pitch
from nao_sim_bridge.sim.tasks import TaskIds
from nao_sim_bridge.sim.things import Things


class Simulation:
    """Owner of the physics and of simulated time.

    Time never goes back: `reset` puts everything to the start but the clock.

    Attributes:
        scene: What it started with.
        robot: The robot; replaced at a reset.
        task_ids: Source of the numbers of all tasks.
        snapshot: What was sensed at the last tick; any thread may read it.
        after_tick: Called with the snapshot at the end of every tick; they stay at a reset.
        sound: What sounds and what is heard; it stays at a reset, which ends everything that plays.
        renderer: What draws what the cameras see, and pictures from outside; any thread may ask.
        cameras: What the robot sees; it stays at a reset.
        things: What is in the world and may come, move and go; a reset puts it to where the world file says.
        holds: As long as one of them answers True, time that runs faster than the wall clock waits: for work in other
            threads without which a fast run would give other results. Asked in the simulation thread.
        wake: To be called, from any thread, when one of `holds` may answer differently; set by who lets time pass.
    """

    def __init__(self, scene: Scene | None = None, settings: Settings | None = None, renderer: str = "auto") -> None:
        self.scene = scene or Scene()
        self.settings = settings or load_settings()
        self.model = load_model(self.scene.version)
        self.led_layout = load_leds(self.scene.version)
        self._world = self.scene.load_world(self.settings.contact.sole_friction)
        self._physics: Physics | None = None
        self._tick = 0
        self.task_ids = TaskIds()
        self.after_tick: list[Callable[[Snapshot], None]] = []
        self.wake: Callable[[], None] = lambda: None
        self.sound = SoundWorld(
            self.model, self.settings.tick_s, self.task_ids, self.scene.seed, released=lambda: self.wake()
        )
        self.renderer = Renderer(self.scene.world, self.scene.version, renderer)
        self.cameras = Cameras(
            self.model,
            self.settings.tick_s,
            self.renderer,
            self.render_state,
            self.scene.seed,
            released=lambda: self.wake(),
        )
        self.holds: list[Callable[[], bool]] = [self.sound.ears.holds, self.cameras.holds]
        self.things = Things(self._world, self.task_ids, lambda: self.time, self._look_again)
        self.robot: SimulatedRobot
        self.snapshot: Snapshot
        self.reset()

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._tick * self.settings.tick_s

    @property
    def ticks(self) -> int:
        """Ticks since the start."""
        return self._tick

    def reset(self) -> None:
        """Put robot and world to where they started; running tasks are killed."""
        if self._physics is not None:
            self.robot.motion.kill_all()
            self.robot.leds.kill_all()
            self.sound.stop_all()
            self._physics.close()
        angles = posture(self.model, self.scene.posture)
        pitch = start_pitch(self.scene.posture)
        self._physics = Physics(self.model, self._world, self.settings, angles, pitch, self.scene.payload)
        self.robot = SimulatedRobot(
            self.model, self.led_layout, self.settings, self._physics, angles, self.scene, self.task_ids
        )
        self.things.begin(self._physics)
        self.snapshot = self.robot.sense(self._tick, self.time)
        self.sound.begin(self.snapshot)
        self.cameras.begin(self.snapshot)

    def tick(self) -> Snapshot:
        """Advance by one tick: things, LEDs, motion, motors, physics, sensors, sound, cameras, in this order."""
        self._tick += 1
        self.things.tick()
        self.robot.act()
        self.snapshot = self.robot.sense(self._tick, self.time)
        self.sound.tick(self.snapshot)
        self.cameras.tick(self.snapshot)
        for look in self.after_tick:
            look(self.snapshot)
        return self.snapshot

    def run(self, seconds: float) -> Snapshot:
        """Advance by `seconds` of simulated time, rounded to ticks."""
        for _ in range(round(seconds / self.settings.tick_s)):
            self.tick()
        return self.snapshot

    def render_state(self, snapshot: Snapshot) -> RenderState:
        """What there is to see at a snapshot, which is the last one. Any thread."""
        return RenderState(
            snapshot.torso.position,
            snapshot.torso.orientation,
            self.robot.true_positions,
            self.robot.leds.values,
            snapshot.objects,
            snapshot.placed,
            snapshot.gone,
        )

    def close(self) -> None:
        """Free the engine."""
        self.sound.close()
        self.cameras.close()
        self.renderer.close()
        self.things.stop()
        if self._physics is not None:
            self.robot.motion.kill_all()
            self.robot.leds.kill_all()
            self._physics.close()
            self._physics = None

    def _look_again(self) -> None:
        """Let the last snapshot have the things that there are now, as time may stand still."""
        bodies = self._physics.bodies
        self.snapshot = replace(self.snapshot, objects=bodies.read(), placed=bodies.placed, gone=bodies.gone)
