"""Behaviours that are installed on the robot: what they are made of, where they come from, and how they are played."""
