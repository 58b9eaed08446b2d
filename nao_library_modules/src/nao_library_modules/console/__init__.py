"""The console: a page in a browser for the person who runs a study."""
