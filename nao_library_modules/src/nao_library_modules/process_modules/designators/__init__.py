"""Designators, the rules that resolve them, and the places that they stand for."""
