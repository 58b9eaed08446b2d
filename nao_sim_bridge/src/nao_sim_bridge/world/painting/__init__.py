"""Painters of what is on cards, faces and furniture: pure functions that return (h, w, 3) uint8 pictures."""
