"""Drawings and records of what robots did, and what the demonstration shows."""
