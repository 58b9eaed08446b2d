"""Sensors of the robot, each a small object that turns engine readings into what the hardware would report."""
