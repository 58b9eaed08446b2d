"""What takes long, on the same simulator server a worker as the level robot."""

from robot_fixtures import bench, goals_to, lights, robot, shared_robot, stiff_robot, told, world_file

__all__ = ["bench", "goals_to", "lights", "robot", "shared_robot", "stiff_robot", "told", "world_file"]
