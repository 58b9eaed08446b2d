"""What every room needs: errors, bounds, settings, files, rotations, tasks. Knows no robot."""
