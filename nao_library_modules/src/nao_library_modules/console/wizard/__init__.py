"""The wizard's page without NiceGUI: its file, its keys, the presses of its buttons, the head by the camera picture."""
