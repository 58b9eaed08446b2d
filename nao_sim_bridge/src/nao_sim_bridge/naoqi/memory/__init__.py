"""ALMemory: its store, live keys, and the events that extractors write."""
