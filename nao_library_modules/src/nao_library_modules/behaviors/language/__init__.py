"""The language of behaviour files: model, reader, writer, checks."""
