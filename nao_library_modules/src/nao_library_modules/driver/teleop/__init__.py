"""Driving by keyboard and joystick."""
