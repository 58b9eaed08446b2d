"""The NAOqi modules the simulated robot serves, one file each: translate names, units and shapes, then delegate."""
