"""Calls to the robot's NAOqi, its clock and its events."""
