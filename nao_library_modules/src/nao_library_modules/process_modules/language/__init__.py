"""The plan language: fluents, tasks, control structures, failures, goals, and traces of what ran."""
