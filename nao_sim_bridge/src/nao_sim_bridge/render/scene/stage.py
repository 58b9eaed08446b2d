"""What can be seen of a world and its robots as bodies of PyBullet: for the window and for the built-in drawing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Tuple

from nao_sim_bridge.base.engine import Engine
from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.rotations import Quaternion, Vector3
from nao_sim_bridge.model.appearance import load_appearance
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.render.scene.figure import FAR_AWAY, UNTURNED, Figure
from nao_sim_bridge.world.builder import build_object, build_world, place_of
from nao_sim_bridge.world.render_state import RenderState
from nao_sim_bridge.world.world import FLOOR, World, WorldObject

Place = Tuple[Vector3, Quaternion]


@dataclass
class _Seen:
    """A thing, its body, its place in world as the world says, and its place now."""

    thing: WorldObject
    body: int
    home: Place
    place: Place


def _place(pose: Pose | None, home: Place) -> Place:
    return home if pose is None else (pose.position, pose.orientation)


class Stage:
    """The things of a world and the robots, the robot itself first, in one PyBullet world.

    Args:
        floor: Whether the floor is one of the bodies.
        paint_lamps: See `Figure`.
    """

    def __init__(self, world: World, version: str, engine: Engine, floor: bool, paint_lamps: bool) -> None:
        self._world = world
        self._version = version
        self._engine = engine
        self._paint_lamps = paint_lamps
        bodies = build_world(world, engine, visual=True)
        if not floor:
            engine.removeBody(bodies[FLOOR])
        self._things = {thing.name: self._seen(thing, bodies[thing.name]) for thing in world.objects}
        self._placed: dict[str, _Seen] = {}
        self._placed_of: tuple[WorldObject, ...] = ()
        self.figures = [self._new_figure()]

    def show(self, state: RenderState, headless: bool = False) -> None:
        """Put everything where the state says; what has not changed is left alone.

        Args:
            headless: Leave out the head of the robot itself.

        Raises:
            UnknownName: If the state has a pose for something that is not there.
        """
        self._show_placed(state.placed)
        for name in (*state.objects, *state.gone):
            if name not in self._things and name not in self._placed:
                raise UnknownName("object", name, {*self._things, *self._placed})
        for name, seen in self._things.items():
            # The name of what is gone may belong to something that was placed.
            if name in state.gone or name in self._placed:
                self._put(seen, (FAR_AWAY, UNTURNED))
            else:
                self._put(seen, _place(state.objects.get(name), seen.home))
        for name, seen in self._placed.items():
            self._put(seen, _place(state.objects.get(name), seen.home))
        while len(self.figures) <= len(state.others):
            self.figures.append(self._new_figure())
        self.figures[0].show(state, headless)
        for figure, look in zip(self.figures[1:], state.others):
            figure.show(look)
        for figure in self.figures[1 + len(state.others) :]:
            figure.hide()

    def loose(self) -> list[Vector3]:
        """Where the things are that can be moved or were placed, m, in world."""
        movable = [seen for seen in self._things.values() if seen.thing.mass > 0.0]
        return [seen.place[0] for seen in (*movable, *self._placed.values())]

    def _put(self, seen: _Seen, place: Place) -> None:
        if seen.place != place:
            self._engine.resetBasePositionAndOrientation(seen.body, *place)
            seen.place = place

    def _show_placed(self, placed: tuple[WorldObject, ...]) -> None:
        """Build what is new, and free what is not there any more."""
        if placed is self._placed_of:
            return
        wanted = {thing.name: thing for thing in placed}
        for name, seen in list(self._placed.items()):
            if wanted.get(name) != seen.thing:
                self._engine.removeBody(seen.body)
                del self._placed[name]
        for name, thing in wanted.items():
            if name not in self._placed:
                body = build_object(thing, self._world.floor, self._engine, visual=True)
                self._placed[name] = self._seen(thing, body)
        self._placed_of = placed

    def _seen(self, thing: WorldObject, body: int) -> _Seen:
        home = place_of(thing, self._world.floor)
        return _Seen(thing, body, home, home)

    def _new_figure(self) -> Figure:
        return Figure(self._engine, load_model(self._version), load_appearance(self._version), self._paint_lamps)
