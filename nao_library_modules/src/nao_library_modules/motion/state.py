"""Motion functions that tell about the robot's motion, and those that end tasks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..functions.chain import checked_by
from .body import BodyPart
from .facts import BODY
from .fields import SomeJoints, Task


class MotionState(BodyPart):
    def _joints(self, names: Sequence[str]) -> list[str]:
        return self.body.joints(names or [BODY])

    @checked_by(_joints)
    def get_body_names(self, names: SomeJoints) -> list[str]:
        """Joints behind chains, of the whole body if none is named."""
        return self._joints(names)

    @checked_by(_joints)
    def get_limits(self, names: SomeJoints) -> list[list[float]]:
        """Of each joint: lower and upper limit (rad), top speed (rad/s) and torque (N m)."""
        rows = dict(zip(self.body.joints([BODY]), self.motion("getLimits", BODY)))
        return [list(rows[joint]) for joint in self._joints(names)]

    def get_mass(self, names: SomeJoints) -> list[float]:
        """Mass of joints, chains or, if none is named, the body: kg."""
        return [float(self.motion("getMass", name)) for name in names or [BODY]]

    def get_robot_config(self) -> list[list[Any]]:
        """Names and values of the robot's configuration."""
        return [list(row) for row in self.motion("getRobotConfig")]

    def get_sensor_names(self) -> list[str]:
        """Sensors that getPosition knows."""
        return list(self.motion("getSensorNames"))

    def get_motion_cycle_time(self) -> int:
        """Period of ALMotion in ms."""
        return int(self.motion("getMotionCycleTime"))

    def get_summary(self) -> str:
        """A table of all joints: stiffness, command, sensor."""
        return str(self.motion("getSummary"))

    def get_task_list(self) -> list[list[Any]]:
        """Tasks that run: name, number, broker, priority, resources."""
        return [list(task) for task in self.motion("getTaskList")]

    @checked_by(_joints)
    def are_resources_available(self, names: SomeJoints) -> bool:
        """Whether no task holds the joints."""
        return bool(self.motion("areResourcesAvailable", self._joints(names)))

    def kill_task(self, values: Task) -> bool:
        """End a task by its number; tells whether there was one."""
        return bool(self.motion("killTask", int(values[0])))

    @checked_by(_joints)
    def kill_tasks_using_resources(self, names: SomeJoints) -> None:
        """End all tasks that hold the joints."""
        self.motion("killTasksUsingResources", self._joints(names))

    def _check_kill_all(self) -> None:
        self.body.plan.walk.stands()  # a walk ends with all tasks

    @checked_by(_check_kill_all)
    def kill_all(self) -> None:
        """End all motion tasks."""
        self.motion("killAll")

    functions = {
        "getBodyNames": get_body_names,
        "getLimits": get_limits,
        "getMass": get_mass,
        "getRobotConfig": get_robot_config,
        "getSensorNames": get_sensor_names,
        "getMotionCycleTime": get_motion_cycle_time,
        "getSummary": get_summary,
        "getTaskList": get_task_list,
        "areResourcesAvailable": are_resources_available,
        "killTask": kill_task,
        "killTasksUsingResources": kill_tasks_using_resources,
        "killAll": kill_all,
    }
