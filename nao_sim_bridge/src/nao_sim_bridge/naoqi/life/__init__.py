"""Autonomous life: what the simulated robot does by itself when it is allowed to."""
