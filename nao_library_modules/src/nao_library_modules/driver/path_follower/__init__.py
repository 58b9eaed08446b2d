"""Following paths."""
