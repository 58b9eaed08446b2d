"""NAOqi's modules that play behaviours and animations."""
