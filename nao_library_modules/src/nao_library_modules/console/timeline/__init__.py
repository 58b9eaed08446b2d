"""Behaviours on a timeline: their YAML as boxes with times, and edits that leave the rest of the text as it is."""
