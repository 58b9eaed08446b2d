"""NAOqi's modules of the body: LEDs, DCM, sensors, battery, posture, touch, sonar."""
