"""One simulator server a worker, in this process, put into the state of a fresh one before each case."""

from robot_fixtures import bench, goals_to, lights, robot, shared_robot, stiff_robot, told, world_file
from waits import eventually

__all__ = ["bench", "eventually", "goals_to", "lights", "robot", "shared_robot", "stiff_robot", "told", "world_file"]
