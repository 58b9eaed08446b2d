"""The robots of a console, and what it wants of them."""
