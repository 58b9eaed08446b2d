"""A script as users of the robot maker's Python SDK write them: a module with a callback, posted calls, proxies.

Usage: greeter.py IP PORT. Prints what it saw and ends with status 0 when the robot called back.
"""

import sys
import threading

import almath
import motion
from naoqi import ALBroker, ALModule, ALProxy

Greeter = None
memory = None


class GreeterModule(ALModule):
    """Greets when the head is touched."""

    def __init__(self, name):
        ALModule.__init__(self, name)
        self.touched = threading.Event()
        self.seen = []
        global memory
        memory = ALProxy("ALMemory")
        memory.subscribeToEvent("FrontTactilTouched", "Greeter", "onTouched")

    def onTouched(self, event, value, subscriber):
        """Called by the robot when the front of the head is touched."""
        memory.unsubscribeToEvent("FrontTactilTouched", "Greeter")
        self.seen.append((event, value))
        self.touched.set()


def main(ip, port):
    broker = ALBroker("greeterBroker", "0.0.0.0", 0, ip, port)
    global Greeter
    Greeter = GreeterModule("Greeter")
    leds = ALProxy("ALLeds", ip, port)
    task = leds.post.fadeRGB("FaceLeds", 0x00FF00, 20.0)
    print("fading", leds.isRunning(task), leds.wait(task, 200))
    leds.stop(task)
    try:
        print("stopped", not leds.wait(task, 5000))
    except RuntimeError as error:
        print("stopped", "cancel" in str(error).lower())
    body = ALProxy("ALMotion", ip, port)
    body.setStiffnesses("Head", 1.0)
    body.angleInterpolation("HeadYaw", [30.0 * almath.TO_RAD, 0.0], [0.5, 1.0], True)
    print("head", round(abs(body.getAngles("HeadYaw", True)[0]), 1), motion.FRAME_ROBOT)
    try:
        leds.setIntensity("NoSuchLed", 1.0)
    except RuntimeError as error:
        print("refused", "NoSuchLed" in str(error))
    memory.raiseEvent("FrontTactilTouched", 1.0)
    called = Greeter.touched.wait(60.0)
    print("called back", called, Greeter.seen)
    broker.shutdown()
    return 0 if called else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2])))
