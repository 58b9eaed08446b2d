"""Programs that this one starts, watches and ends, and its own end."""
