"""What takes long on the running stack."""

from stack_fixtures import intact, running, stack

__all__ = ["intact", "running", "stack"]
