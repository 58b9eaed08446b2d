"""NAOqi's vision modules, one file each, thin over the cameras and the detectors."""
