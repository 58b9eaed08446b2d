"""Drawing with OpenGL, on a graphics card or, without one, in software."""
