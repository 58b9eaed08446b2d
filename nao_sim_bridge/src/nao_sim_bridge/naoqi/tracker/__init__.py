"""ALTracker of the simulated robot."""
