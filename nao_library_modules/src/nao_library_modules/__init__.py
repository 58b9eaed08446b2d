"""Action servers that play chains of NAOqi functions: NaoBasic and the modules that inherit it."""
