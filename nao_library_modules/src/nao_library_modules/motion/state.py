"""Motion functions that tell about the robot's motion, and those that end tasks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..base.errors import BadGoal
from ..base.field_checks import require_whole
from ..functions.chain import checked_by
from .base import MotionBase
from .facts import BODY

MOST_TASKS = 2**31 - 1


def check_task(_self: object, values: Sequence[float]) -> None:
    """The number of a task."""
    if len(values) != 1:
        raise BadGoal("values", list(values), "the number of one task")
    require_whole("values", values[0], 0, MOST_TASKS)


def check_kill_all(self: MotionBase) -> None:
    """Nothing can be wrong; a walk ends with it."""
    self.plan.walk.stands()


def check_some_joints(self: MotionBase, names: Sequence[str]) -> None:
    """Known joints, or nothing for the whole body."""
    self.plan.facts.joints(names or [BODY])


class MotionState(MotionBase):
    """Functions of ALMotion for facts and tasks. Parameters are fields of MotionFunction."""

    def state_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {
            "getBodyNames": self.get_body_names,
            "getLimits": self.get_limits,
            "getMass": self.get_mass,
            "getRobotConfig": self.get_robot_config,
            "getSensorNames": self.get_sensor_names,
            "getMotionCycleTime": self.get_motion_cycle_time,
            "getSummary": self.get_summary,
            "getTaskList": self.get_task_list,
            "areResourcesAvailable": self.are_resources_available,
            "killTask": self.kill_task,
            "killTasksUsingResources": self.kill_tasks_using_resources,
            "killAll": self.kill_all,
        }

    @checked_by(check_some_joints)
    def get_body_names(self, names: Sequence[str]) -> list[str]:
        """Joints behind chains, of the whole body if none is named."""
        return self.joints(names or [BODY])

    @checked_by(check_some_joints)
    def get_limits(self, names: Sequence[str]) -> list[list[float]]:
        """Of each joint: lower and upper limit (rad), top speed (rad/s) and torque (N m)."""
        rows = dict(zip(self.joints([BODY]), self.motion("getLimits", BODY)))
        return [list(rows[joint]) for joint in self.joints(names or [BODY])]

    def get_mass(self, names: Sequence[str]) -> list[float]:
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

    @checked_by(check_some_joints)
    def are_resources_available(self, names: Sequence[str]) -> bool:
        """Whether no task holds the joints."""
        return bool(self.motion("areResourcesAvailable", self.joints(names or [BODY])))

    @checked_by(check_task)
    def kill_task(self, values: Sequence[float]) -> bool:
        """End a task by its number; tells whether there was one."""
        return bool(self.motion("killTask", int(values[0])))

    @checked_by(check_some_joints)
    def kill_tasks_using_resources(self, names: Sequence[str]) -> None:
        """End all tasks that hold the joints."""
        self.motion("killTasksUsingResources", self.joints(names or [BODY]))

    @checked_by(check_kill_all)
    def kill_all(self) -> None:
        """End all motion tasks."""
        self.motion("killAll")
