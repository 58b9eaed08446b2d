"""Sound in simulated time: what plays, what the microphones hear, and who listens."""
