"""Pages of studies: a trial that runs, what was measured, and trials seen again."""
