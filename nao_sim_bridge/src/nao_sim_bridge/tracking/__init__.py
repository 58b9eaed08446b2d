"""Looking at, pointing at and walking to places: geometry, and what follows a place that moves."""
