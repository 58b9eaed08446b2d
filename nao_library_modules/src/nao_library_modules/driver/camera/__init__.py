"""Cameras as topics."""
