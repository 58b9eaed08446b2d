"""How the body is kept up and moved, below walking."""
