"""NAOqi's audio modules."""
