"""ALSystem, and NaoSimulation, the module that a robot has not."""
