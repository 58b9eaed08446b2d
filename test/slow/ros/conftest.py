"""What takes long on the running stack."""

from stack_fixtures import intact, running

__all__ = ["intact", "running"]
