"""Pictures of the simulation, made in a process of their own so that the physics never waits for them."""
