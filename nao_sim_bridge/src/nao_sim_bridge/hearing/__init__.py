"""What the robot makes of what its microphones hear: sounds, directions, words. No clock, no network."""
