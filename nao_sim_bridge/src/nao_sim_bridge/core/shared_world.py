"""What robots share: the world with its physics and its things, time, sound in the air, and what draws.

No thread and no wall clock: whoever calls `tick` minds both.
"""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Callable, Iterable, Protocol, Sequence

from nao_sim_bridge.base.errors import NotFinite
from nao_sim_bridge.base.renderers import require_renderer
from nao_sim_bridge.base.settings import Settings, load_settings
from nao_sim_bridge.base.tasks import TaskIds
from nao_sim_bridge.body.physics_world import PhysicsWorld
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.hands import Hands
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.core.things import Things
from nao_sim_bridge.world.places import ORIGIN, RobotPlace

if TYPE_CHECKING:
    from nao_sim_bridge.render.client import Renderer
    from nao_sim_bridge.sound.sound_world import Air
    from nao_sim_bridge.world.render_state import RobotLook


class WorldRobot(Protocol):
    """What the world asks of a robot that is in it."""

    snapshot: Snapshot
    hands: Hands
    holds: Iterable[Callable[[], bool]]
    after_tick: Iterable[Callable[[Snapshot], None]]

    def begin(self, physics: PhysicsWorld) -> None:
        """Be put into a world that has just been made."""

    def begin_again(self) -> None:
        """Be at the start again: the physics has put the body back."""

    def begin_sound(self, air: Air) -> None:
        """There is sound from now on: have a voice and ears."""

    def act(self) -> Sequence[Callable[[], None]]:
        """First part of a tick, up to the step of physics; what is to be called before each step of the engine."""

    def sense(self, ticks: int = 1) -> None:
        """Second part of a tick: read every sensor; `ticks` have passed since the last time."""

    def perceive(self) -> None:
        """Third part of a tick: hear and see."""

    def look(self) -> RobotLook:
        """What the robot looks like at the last tick. Any thread."""

    def look_again(self) -> None:
        """Let the last snapshot have the things that there are now."""

    def end_tasks(self) -> None:
        """Kill what moves and lights up."""

    def close_senses(self) -> None:
        """Hear and see nothing any more."""


class SharedWorld:
    """One world for one robot or more. Each of them is a `Simulation`, and joins when it is made.

    Attributes:
        scene: What it started with.
        settings: Of the physics.
        world: Floor, things, sounds.
        robots: Those that are in it, in the order of their numbers.
        physics: The engine; replaced at a reset.
        task_ids: Source of the numbers of all tasks.
        guard: Calls what belongs to a tick besides physics and sensors, and knows what of it has failed.
        things: What is in the world and may come, move and go; a reset puts it to where the world file says.
        ticks: Since the start; it never goes back.
        after_reset: Called at the end of each reset: world and robots are at the start again.
        late: Whether the last tick came later than the asked speed wants it; set by who lets time pass.
        wake: To be called, from any thread, when time need not wait any more for what a robot holds it for; set by
            who lets time pass.

    Args:
        settings: None for those of the file.
        renderer: What draws: "auto", "opengl" or "builtin", see `Renderer`; or one that has drawn this world before.
    """

    def __init__(self, scene: Scene, settings: Settings | None = None, renderer: str | Renderer = "auto") -> None:
        self.scene = scene
        self.settings = settings or load_settings()
        self.world = scene.load_world(self.settings.contact.sole_friction)
        self.robots: list[WorldRobot] = []
        self.physics: PhysicsWorld | None = None
        self.ticks = 0
        self.after_reset: list[Callable[[], None]] = []
        self.task_ids = TaskIds()
        self.guard = self.task_ids.guard
        self.late = False
        self.wake: Callable[[], None] = lambda: None
        self._air: Air | None = None
        if isinstance(renderer, str):
            require_renderer(renderer)
        self._renderer, self._making = renderer, threading.Lock()
        self.things = Things(self.world, self.task_ids, lambda: self.time, self.settings.tick_s, self._look_again)

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self.ticks * self.settings.tick_s

    @property
    def renderer(self) -> Renderer:
        """What draws, for all robots; made when somebody first asks for it. Any thread."""
        if isinstance(self._renderer, str):
            from nao_sim_bridge.render.client import Renderer  # who is blind needs nothing of it

            with self._making:
                if isinstance(self._renderer, str):
                    self._renderer = Renderer(self.scene.world, self.scene.version, self._renderer)
        return self._renderer

    @property
    def next_place(self) -> RobotPlace:
        """Where the world has the next robot that joins: at the origin when it does not say."""
        places = self.world.robots[len(self.robots) :]
        return places[0] if places else ORIGIN

    def holds(self) -> bool:
        """Whether time that runs faster than the wall clock should wait for one of the robots."""
        for robot in self.robots:
            for waits in robot.holds:
                try:
                    if waits():
                        return True
                except Exception as error:
                    self.guard.caught(waits, error)
        return False

    def join(self, robot: WorldRobot) -> None:
        """Take a robot in, before time passes, and let it begin."""
        self.robots.append(robot)
        if self.physics is None:
            self.physics = PhysicsWorld(self.world, self.settings)
            self.things.begin(self.physics)
        robot.begin(self.physics)
        if self._air is not None:
            robot.begin_sound(self._air)

    def begin_sound(self) -> None:
        """From now on there is sound, and all robots have voices and ears; it stays at a reset."""
        if self._air is not None:
            return
        from nao_sim_bridge.sound.sound_world import Air  # a world without sound needs nothing of it

        self._air = Air(self.task_ids, self.settings.tick_s)
        if self.ticks:
            self._air.tick(self.ticks)
        for robot in self.robots:
            robot.begin_sound(self._air)

    def reset(self) -> None:
        """Put all robots and the world to where they started; running tasks are killed, time goes on.

        The world is built once more at the first reset, and where things can move, come or go; else all bodies go back.
        """
        for robot in self.robots:
            robot.end_tasks()
        if self._air is not None:
            self._air.stop_all()
        if self.physics.restore():
            self.things.begin(self.physics)
            for robot in self.robots:
                robot.begin_again()
        else:
            self._build_again()
        for call in self.after_reset:
            self.guard.call(call)

    def _build_again(self) -> None:
        self.physics = PhysicsWorld(self.world, self.settings, self.physics.clear())
        self.things.begin(self.physics)
        for robot in self.robots:
            robot.begin(self.physics)
        self.physics.keep()

    def tick(self) -> None:
        """Advance by one tick: things, LEDs, motion, motors, physics, sensors, sound, cameras, in this order.

        Each of them for all robots: none is a tick ahead of what it sees, hears and touches of another. What raises of
        it fails alone, see `guard`, but for the engine: without it nothing can go on. Where that has lost a body, whose
        place is no number any more, world and robots are put to their start, and `guard` tells why.
        """
        self._move()
        self._sense(1)
        self._finish()

    def leap(self, ticks: int) -> None:
        """Advance by some ticks with one look of the sensors at their end: for robots that are driven directly.

        What listens, looks and watches has its turn once, at the end.
        """
        for _ in range(ticks):
            self._move()
        self._sense(ticks)
        self._finish()

    def _move(self) -> None:
        """Things, LEDs, motion, motors, physics."""
        self.ticks += 1
        call = self.guard.call
        call(self.things.tick)
        pushes: list[Callable[[], None]] = []
        for robot in self.robots:
            pushes += call(robot.act) or ()
        self.physics.step(pushes)
        call(self.things.arrive)

    def _finish(self) -> None:
        """Sound, cameras, watchers."""
        call, robots = self.guard.call, self.robots
        if self._air is not None:
            call(self._air.tick, self.ticks)
        for robot in robots:
            call(robot.perceive)
        for robot in robots:
            snapshot = robot.snapshot
            for look in robot.after_tick:
                try:  # not by `call`: this is for each of many at every tick
                    look(snapshot)
                except Exception as error:
                    self.guard.caught(look, error)

    def _sense(self, ticks: int) -> None:
        lost: NotFinite | None = None
        for robot in self.robots:
            try:
                robot.sense(ticks)
            except NotFinite as error:
                lost = error
            except Exception as error:
                self.guard.caught(robot.sense, error)
        if lost is not None:
            self.guard.caught("physics, which begins anew,", lost)
            self.physics.lose()
            self.reset()

    def looks_beside(self, robot: WorldRobot) -> tuple[RobotLook, ...]:
        """What all robots but one look like at the last tick. Any thread."""
        return tuple(other.look() for other in self.robots if other is not robot)

    def close(self, keep_renderer: bool = False) -> None:
        """Free the engine; nothing sounds or is heard or seen any more. `keep_renderer`: leave it to another world."""
        if self._air is not None:
            self._air.stop_all()
        for robot in self.robots:
            robot.close_senses()
        if not (keep_renderer or isinstance(self._renderer, str)):
            self._renderer.close()
        self.things.stop()
        if self.physics is not None:
            for robot in self.robots:
                robot.end_tasks()
                robot.hands.end()
            self.physics.close()
            self.physics = None

    def _look_again(self) -> None:
        """Let the last snapshots have the things that there are now, as time may stand still."""
        for robot in self.robots:
            robot.look_again()
