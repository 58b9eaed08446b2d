"""Running and recording behaviours."""
