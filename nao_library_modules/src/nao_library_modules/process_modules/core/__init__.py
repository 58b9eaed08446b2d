"""Process modules and their registry, perception, projection."""
