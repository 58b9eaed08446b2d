"""The commands of `nao`."""
