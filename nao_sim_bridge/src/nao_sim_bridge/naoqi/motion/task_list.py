"""Part of ALMotion: the tasks that run, and their end before time."""

from __future__ import annotations

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.motion.part import MotionPart


class TaskList(MotionPart):
    """Tasks, resources, kill."""

    def getTaskList(self) -> Task:
        return self._runner.execute(
            lambda: [[task.name, task.task_id] for task in self._robot.motion.tasks()], "getTaskList"
        )

    def areResourcesAvailable(self, names: list[str]) -> Task:
        indices = self._indices(names)
        return self._runner.execute(lambda: not self._robot.motion.busy(indices), "areResourcesAvailable")

    def killTask(self, task_id: int) -> Task:
        def kill() -> bool:
            for task in self._robot.motion.tasks():
                if task.task_id == task_id:
                    return task.kill()
            return False

        return self._runner.execute(kill, "killTask")

    def killTasksUsingResources(self, names: list[str]) -> Task:
        indices = self._indices(names)
        return self._runner.execute(lambda: self._robot.motion.kill_using(indices), "kill")

    def killAll(self) -> Task:
        return self._runner.execute(lambda: self._robot.motion.kill_all(), "killAll")
