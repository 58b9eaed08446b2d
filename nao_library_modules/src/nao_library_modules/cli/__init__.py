"""The command `nao`: everything that the servers do, from a shell.

What it can be asked stands in `app`, one file a subject of commands beside it. Nothing that takes time to load is
imported before a command needs it: `nao --help` and completion answer at once.
"""
