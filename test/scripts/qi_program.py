"""A program in the idioms of the robot maker's Python SDK: an application, a service, a periodic task.

It serves `Tally`, counts readings of HeadYaw until there are three, says what it knows and ends.
"""

import sys

import qi


@qi.multiThreaded()
class Tally:
    """A service with a method, a signal and a property."""

    def __init__(self, session):
        self.counted = qi.Signal("(i)")
        self.total = qi.Property("i")
        self.total.setValue(0)
        self._motion = session.service("ALMotion")

    @qi.bind(qi.Int32, [])
    def count(self):
        """Look at the head once more; how often that was."""
        self._motion.getAngles("HeadYaw", True)
        self.total.setValue(self.total.value() + 1)
        self.counted(self.total.value())
        return self.total.value()


def main():
    app = qi.Application(sys.argv)
    app.start()
    session = app.session
    tally, task = Tally(session), qi.PeriodicTask()
    names = qi.runAsync(lambda: session.service("ALMotion").getBodyNames("Head")).value()

    def counted(total):
        if total == 3:
            print(total, tally.total.value() >= 3, names, flush=True)
            app.stop()

    tally.counted.connect(counted)
    session.registerService("Tally", tally)
    task.setCallback(tally.count)
    task.setUsPeriod(10000)
    task.start(True)
    app.run()
    task.stop()


if __name__ == "__main__":
    main()
