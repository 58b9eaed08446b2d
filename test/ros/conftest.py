"""What only ROS can show, on one running stack."""

from stack_fixtures import intact, running, stack

__all__ = ["intact", "running", "stack"]
