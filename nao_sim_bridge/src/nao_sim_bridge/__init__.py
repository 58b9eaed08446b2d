"""A simulated NAO that speaks NAOqi over libqi."""
