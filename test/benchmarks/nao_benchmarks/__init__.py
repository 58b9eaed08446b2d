"""Benchmarks of the stack: what it costs on top of what it is made of, measured side by side in one run."""
