"""Behaviours, autonomous life and lights."""
