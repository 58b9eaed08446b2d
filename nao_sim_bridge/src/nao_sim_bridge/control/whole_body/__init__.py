"""Hands, feet and centre of mass in space: inverse kinematics and whole-body tasks."""
