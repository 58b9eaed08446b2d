"""The simulator as a server: its command line, its libqi broker, and what only a simulator can be asked for."""
