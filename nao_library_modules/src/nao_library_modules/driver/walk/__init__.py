"""Walking by velocities, targets and footsteps."""
