"""Touch, sonars, feet, diagnostics and what the robot sees."""
