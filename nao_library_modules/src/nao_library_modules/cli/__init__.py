"""The command `nao`: everything that the servers do, from a shell.

`app` lists the commands; beside it each subject has a file. Slow imports wait until a command needs them, so that
`nao --help` and completion answer at once.
"""
