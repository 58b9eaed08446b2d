"""What everything here stands on and what knows nothing of the robot: errors, limits, places, cancellation, files."""
