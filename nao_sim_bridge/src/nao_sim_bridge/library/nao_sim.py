"""A simulated NAO as a library: no ROS and no network, as fast as this computer goes.

    from nao_sim_bridge import NaoSim

    with NaoSim(posture="Stand", seed=1) as nao:
        nao.walk_to(0.5, 0.0, 0.3)
        print(nao.angles["HeadYaw"], nao.pose_torso_in_world, nao.imu.angles, nao.feet.center_of_pressure)

Time passes in `step`, and in the calls that wait for what they have begun. Units are SI (m, rad, s, N, kg), hands are 0
(closed) to 1 (open), frames those of REP 103: x ahead, y to the left, z up. Arrays of joints are in ALMotion's order
of the body, which is that of `joint_names`. Nothing is built before it is asked for: a simulation in which nobody looks
or listens has no cameras, no sound and no process beside it.
"""

from __future__ import annotations

import math
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Callable, Mapping, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue, NotAllowed
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.core.shared_world import SharedWorld
from nao_sim_bridge.core.simulation import SEED_STEP, robots_in
from nao_sim_bridge.library.nao import LONGEST, Motion, Nao, finite_numbers, whole_number
from nao_sim_bridge.library.session import ENDLESS, Session
from nao_sim_bridge.world.places import RobotPlace

if TYPE_CHECKING:
    from nao_sim_bridge.core.saved_state import SavedState


class NaoSim(Nao):
    """A world with one NAO or more, in which time passes when it is told to. It is also its first robot.

    Attributes:
        robots: All robots, itself first.

    Args:
        posture: In which the robots start, awake and stiff; None for limp ones that crouch, as after boot.
        seed: Of all random numbers: equal seeds and equal calls give equal runs, to the last bit.
        world: Name of a world that comes along, or path of a world file; see docs/worlds.md.
        robots: How many there are.
        places: Where they stand, (x, y, yaw) each in m and rad, or (x, y, yaw, z) on something z m over the floor;
            those of the world, or a circle, if nobody says.
        version: Of the robots, "V6" or "V5".
        noise: Scale of the sensors' errors: 0 none, 1 those of a real robot.
        delay: How late joint angles, inertial unit and foot forces arrive, s.
        friction: Coefficient between soles and floor; None for what the world says.
        payload: Mass that the torso carries besides its own, kg.
        gui: Show it in a window; time then passes no faster than the clock on the wall.

    Raises:
        SimulationError: World, posture or places cannot be used.
    """

    def __init__(
        self,
        posture: str | None = "Stand",
        seed: int = 0,
        world: str | Path = "empty",
        robots: int = 1,
        places: Sequence[Sequence[float]] = (),
        version: str = "V6",
        noise: float = 0.0,
        delay: float = 0.0,
        friction: float | None = None,
        payload: float = 0.0,
        gui: bool = False,
    ) -> None:
        start = "Crouch" if posture is None else posture
        scene = Scene(str(world), version, start, whole_number("seed", seed), friction, payload, noise, delay)
        if len(places) not in (0, robots):
            raise BadValue("places", places, f"one for each of the {robots} robots, or none")
        self._places = tuple(RobotPlace(*finite_numbers("place", place, 3, 4)) for place in places)
        session = Session(robots_in(SharedWorld(scene), scene, robots, self._places), gui)
        super().__init__(session, 0)
        self.robots = (self, *(Nao(session, number) for number in range(1, robots)))
        self._awake = posture is not None
        self._wake()

    def __enter__(self) -> NaoSim:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Free the engine, and end the network and the programs that work for it."""
        self._session.close()

    # --- time ---------------------------------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self._simulation.time

    @property
    def tick_s(self) -> float:
        """Length of a tick, s: sensors are read and motors are told once in it."""
        return self._session.tick_s

    def step(self, seconds: float | None = None) -> None:
        """Let time pass.

        Args:
            seconds: Simulated, rounded to ticks of 1/120 s: 0.01 s are one tick, 0.00833 s; None for one tick.

        Raises:
            BadValue: It is negative, not finite, or above 0 and less than half a tick.
        """
        seconds = self.tick_s if seconds is None else seconds
        if not 0.0 <= seconds < ENDLESS:
            raise BadValue("seconds", seconds, "0 or more, finite")
        ticks = round(seconds / self.tick_s)
        if ticks == 0 and seconds > 0.0:
            raise BadValue("seconds", seconds, f"0, or a tick of {self.tick_s:.5f} s or more")
        self._session.advance(ticks)

    def reset(self, seed: int | None = None, payload: float | None = None, delay: float | None = None) -> None:
        """Put robots and world to their start; what they do ends. What is None stays as it was.

        Args:
            seed: Of what is random from now on.
            payload: As for the constructor.
            delay: As for the constructor.

        Raises:
            BadValue: A number is not in its range.
        """
        changes = {"payload": payload, "sensor_delay": delay}
        changes = {name: value for name, value in changes.items() if value is not None}

        def start_again() -> None:
            for number, simulation in enumerate(self._session.simulations):
                if seed is not None:
                    changes["seed"] = whole_number("seed", seed) + SEED_STEP * number
                simulation.vary(**changes)
            self._session.shared.reset()
            self._wake()

        self._session.do(start_again)

    def save_state(self) -> SavedState:
        """The state of robots and world, for `restore_state` of this object; a quarter of a megabyte while it is held.

        Raises:
            NotAllowed: A motion or a walk is under way, or the robot is served.
        """
        if self._session.served:
            raise NotAllowed("the state of a robot that is served cannot be saved")
        for robot in (simulation.robot for simulation in self._session.simulations):
            if robot.walking or robot.motion.tasks():
                raise NotAllowed("a state can be saved while no motion and no walk is under way")
        from nao_sim_bridge.core.saved_state import SavedState  # who never saves needs nothing of it

        return SavedState(self._session.shared, self._session.simulations)

    def restore_state(self, state: SavedState) -> None:
        """Let everything be as it was when a state was saved, as often as one likes; time as well.

        Raises:
            BadValue: The state is of another simulation, was dropped, or things have come or gone since.
        """
        self._session.do(lambda: state.restore(self._session.shared))

    # --- the world --------------------------------------------------------------------------------------------------

    def place(self, thing: str | Mapping[str, Any], at: Sequence[float] | None = None, **more: Any) -> str:
        """Put a thing into the world; or move and turn the one of its name that is there already, at once.

        Args:
            thing: "ball" (a red one of 6 cm), "box", "cylinder", "person" or another kind of a world file, which then
                is its name, too; the name of a thing that is there; or a whole entry of a world file. See
                docs/worlds.md.
            at: [x, y, z], m, of what `position` of its entry means, mostly its centre; None for the `position` of the
                entry.
            more: Further fields of the entry: `name`, `rpy` or `heading` in rad, `color`, `mass`, `ball=0.05` for the
                radius... A thing that is there keeps its orientation if nobody says `rpy` or `heading`, and what it is.

        Returns:
            Its name.

        Raises:
            SimulationError: There is no such kind or field, what is there is another thing, or a robot is where it
                should be.
        """
        from nao_sim_bridge.library.placing import check_same, entry_of, turn_of
        from nao_sim_bridge.world.objects import read_object  # a world without things needs nothing of it

        def put() -> str:
            things = self._session.shared.things
            entry = entry_of(thing, at, more, things.things)
            there = things.things.get(entry.get("name"))
            if there is None:
                things.place(read_object(entry, "thing", Path))
            else:
                check_same(entry, there)
                things.move(there.name, finite_numbers("at", entry["position"], 3), turn_of(entry))
            return entry["name"]

        return self._session.do(put)

    def move(
        self,
        name: str,
        at: Sequence[float] | None = None,
        rpy: Sequence[float] | None = None,
        duration: float = 0.0,
        wait: bool = True,
    ) -> Motion:
        """Move and turn a thing, straight and at constant speed; also one that the physics cannot move.

        On its way it is a body with a velocity: what stands on it is carried along or falls, what it meets is pushed.

        Args:
            name: Of the thing.
            at: [x, y, z], m, as for `place`; None to stay.
            rpy: Roll, pitch and yaw, rad; None to keep them.
            duration: s; 0: it is there at once, as lifted by a hand, and carries nothing along.
            wait: Let time pass until it is there. A later move of the thing, its removal and `reset` end it.

        Raises:
            UnknownName: There is no such thing.
            BadValue: Numbers do not fit.
            NotAllowed: It would be at once where a robot is.
        """
        goal = None if at is None else finite_numbers("at", at, 3)
        turn = None if rpy is None else finite_numbers("rpy", rpy, 3)

        def start() -> Task:
            things = self._session.shared.things
            return things.move(name, things.place_of(name)[:3] if goal is None else goal, turn, duration)

        motion = Motion(self._session, self._session.do(start))
        if wait:
            motion.wait(max(LONGEST, 2.0 * duration))
        return motion

    def move_along(self, name: str, path: Callable[[float], Sequence[float]], duration: float | None = None) -> Motion:
        """Move and turn a thing along a path while time passes; as `move`, it carries and pushes what it meets.

            plate = nao.things["plate"]
            nao.move_along("plate", lambda t: (*plate[:3], 0.1 * math.sin(2.0 * t), 0.0, 0.0))

        Args:
            name: Of the thing, also one that the physics cannot move. It is put to where the path begins at once.
            path: Tells from s since its begin x, y, z in m, roll, pitch, yaw in rad, as `things` has them. Equal runs
                need a path without chance; `save_state` keeps it.
            duration: s; None: until another move of the thing, its removal, `reset` or `cancel()` of the motion.

        Returns:
            The motion: `wait()` lets time pass until its end, and raises what `path` has raised.

        Raises:
            UnknownName: There is no such thing.
            BadValue: What `path` tells of its begin is no place, or the duration is not above 0.
            NotAllowed: A robot is where it begins.
        """
        lasting = math.inf if duration is None else duration
        return Motion(
            self._session, self._session.do(lambda: self._session.shared.things.move_along(name, path, lasting))
        )

    def remove(self, name: str) -> None:
        """Take a thing out of the world.

        Raises:
            UnknownName: There is none of this name.
        """
        self._session.do(lambda: self._session.shared.things.remove(name))

    @property
    def things(self) -> dict[str, tuple[float, ...]]:
        """Where everything is that can move: x, y, z in m, roll, pitch, yaw in rad, by name."""
        return self._session.do(lambda: self._session.shared.things.places())

    def picture(self, view: str = "three_quarter", width: int = 640, height: int = 480) -> np.ndarray:
        """A picture from outside, (height, width, 3) uint8 RGB.

        Args:
            view: "front", "three_quarter", "side", "back", "far", "face", "room", "robots", "stage".
            width: Pixels.
            height: Pixels.

        Raises:
            UnknownName: There is no such view.
            BadValue: The size is out of range.
            RenderError: It cannot be drawn.
        """
        return self._simulation.picture(view, width, height)

    def save_picture(self, path: str | Path, view: str = "three_quarter", width: int = 640, height: int = 480) -> None:
        """As `picture`, written to a PNG file.

        Raises:
            BadValue: The name of the file ends like that of another kind of picture; else as `picture`.
        """
        if Path(path).suffix.lower() not in ("", ".png"):
            raise BadValue("path", str(path), "the name of a PNG file")
        from nao_sim_bridge.render.png import write_png

        write_png(Path(path), self.picture(view, width, height))

    # --- NAOqi ------------------------------------------------------------------------------------------------------

    def serve(self, port: int = 9559, address: str = "127.0.0.1", speed: float | None = None) -> str:
        """Let programs for NAOqi work with the first robot, while this object looks on and into the world.

        Args:
            port: To listen on; 0 takes a free one.
            address: To listen on; "0.0.0.0" for the whole network.
            speed: Simulated seconds a second in which time passes by itself; None: time passes in `step` only.

        Returns:
            What a program connects to, "tcp://127.0.0.1:9559".

        Raises:
            NotAllowed: It is served already, or there is more than one robot.
            RuntimeError: The address cannot be had.
        """
        return self._session.serve(port, address, speed, self._places)

    # --- inside -------------------------------------------------------------------------------------------------------

    def _wake(self) -> None:
        """Begin: the robots are stiff, and time passes until their feet have felt the floor."""
        simulations = self._session.simulations
        if self._awake:
            for simulation in simulations:
                everything = range(len(simulation.model.joints))
                simulation.robot.motion.set_stiffness_now(dict.fromkeys(everything, 1.0))
        latest = max(simulation.scene.sensor_delay for simulation in simulations)
        for _ in range(1 + round(latest / self.tick_s)):
            self._session.shared.tick()
