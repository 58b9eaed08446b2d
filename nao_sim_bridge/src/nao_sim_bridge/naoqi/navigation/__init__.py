"""ALNavigation: moves that end before obstacles, and ways around them."""
