"""Joint angles over time: curves, the engine that plays them, collisions with the own body."""
