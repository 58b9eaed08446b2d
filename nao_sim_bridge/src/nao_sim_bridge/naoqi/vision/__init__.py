"""NAOqi's vision modules, thin over the cameras and the detectors."""
