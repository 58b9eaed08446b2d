"""How a Python class becomes a NAOqi service: the table of methods, types, arguments, errors, clients."""
