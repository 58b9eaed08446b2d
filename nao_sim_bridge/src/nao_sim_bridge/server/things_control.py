"""Things of the world that come, move and go while the simulation runs, for clients. For any thread."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import yaml

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.base.yaml_values import load_yaml
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import number, numbers
from nao_sim_bridge.world.objects import read_object

LONGEST_DESCRIPTION = 20000
WHERE = "object"
"""What error texts call the entry of a thing that was described."""


class ThingsControl:
    """Places, moves and removes things; their pictures may be files of clients."""

    def __init__(self, runner: RobotRunner, files: ClientFiles) -> None:
        self._simulation = runner.simulation
        self._runner = runner
        self._files = files

    def place_described(self, description: str) -> Task:
        """Place what a text describes: an entry of a world file in YAML or JSON; see `place`.

        A BadValue when the text is neither.
        """
        if not isinstance(description, str) or len(description) > LONGEST_DESCRIPTION:
            raise BadValue("description", str(description)[:40], f"{LONGEST_DESCRIPTION} characters at most")
        try:
            entry = load_yaml(description)
        except yaml.YAMLError as error:
            raise BadValue("description", description[:80], f"an entry of a world file: {error}") from error
        return self.place(entry)

    def place(self, entry: Mapping[str, Any]) -> Task:
        """Place a thing as in a world file, its `image` a file of the client; the task ends when it is there.

        A WorldError when the entry is wrong, a ValueError when the client may not have that file.
        """
        # Outside the simulation thread: figures take a while.
        thing = read_object(entry, WHERE, lambda name: self._files.to_read(name))
        return self._runner.execute(lambda: self._simulation.things.place(thing), "placeObject")

    def move(
        self, name: str, position: Sequence[float], rpy: Sequence[float], duration: float, wait: bool = True
    ) -> Task:
        """Put a thing to another place, [x, y, z] in m over the floor; see `Things.move`.

        `rpy` is [roll, pitch, yaw] in rad, or [] to keep it; it is `duration` s of simulated time on its way. The task
        ends on arrival; without `wait`, when it begins to move.
        """
        place, lasting = numbers(position, "position"), number(duration, "duration", 0.0)
        turn = numbers(rpy, "rpy") or None

        def move() -> Task | None:
            task = self._simulation.things.move(name, place, turn, lasting)
            return task if wait else None

        return self._runner.execute(move, "moveObject")

    def remove(self, name: str) -> Task:
        """Take a thing away; the task ends when it is gone."""
        return self._runner.execute(lambda: self._simulation.things.remove(name), "removeObject")

    def places(self) -> Task:
        """A task that ends with where everything is: [x, y, z, roll, pitch, yaw] by name."""
        listed = lambda: {name: list(place) for name, place in self._simulation.things.places().items()}  # noqa: E731
        return self._runner.execute(listed, "objects")
