"""Motion of joints: pure curves, tasks that follow them, and the engine that advances all tasks each tick."""
