"""What only ROS can show, on one running stack."""

from stack_fixtures import intact, running

__all__ = ["intact", "running"]
