"""A small robot for the tests of the proxy layer: a libqi server in a process of its own.

Run as a program with a port (0 takes a free one); it prints `ready PORT`. It speaks
libqi as a robot does, so that the tests meet libqi's real texts, threads and losses.
"""

from __future__ import annotations

import os
import socket
import struct
import sys
import threading

import qi


class Memory:
    """The part of ALMemory that events need: both ways of subscribing."""

    def __init__(self, session):
        self._session = session
        self._subscribers = {}

    def subscribeToEvent(self, *arguments):
        event, module, method = arguments[0], arguments[1], arguments[-1]
        self._subscribers[event, module] = (method, arguments[2] if len(arguments) == 4 else "")

    def unsubscribeToEvent(self, event, module):
        del self._subscribers[event, module]

    def getSubscribers(self, event):
        return sorted(module for name, module in list(self._subscribers) if name == event)

    def raiseEvent(self, event, value):
        """Call everybody; returns a future of their answers, so that no thread of the server is held."""
        calls = []
        for (name, module), (method, message) in list(self._subscribers.items()):
            if name == event:
                calls.append(self._session.service(module).call(method, event, value, message, _async=True))
        promise = qi.Promise()
        waiting = threading.Thread(target=lambda: promise.setValue([answer_of(call) for call in calls]))
        waiting.start()
        return promise.future()


def answer_of(call):
    try:
        return call.value()
    except RuntimeError as error:
        return f"error: {error}"


class Module:
    """What a module may do, good and bad."""

    def __init__(self):
        self._begun = []
        self._cancelled = 0

    def add(self, first, second):
        """Add two numbers."""
        return first + second

    @qi.bind("m", ["m"])
    def echo(self, value):
        return value

    @qi.bind("v", ["s", "f"], "setIntensity")
    def setIntensity(self, name, value):
        pass

    @qi.bind("v", ["s", "f", "f", "f"], "setColor")
    def setColor3(self, name, red, green, blue):
        pass

    @qi.bind("v", ["s", "s"], "setColor")
    def setColorName(self, name, colour):
        pass

    @qi.bind("i", ["r"])
    def sizeOfRaw(self, raw):
        return len(raw)

    @qi.bind("r")
    def raw(self):
        return bytes(range(256))

    @qi.bind("(iii(s)r[f])")
    def image(self):
        return (2, 1, 3, ("bgr",), b"\xff\x00\x80\x01\x02\x03", [0.5])

    def fails(self):
        raise ValueError("too hot: 81 degrees")

    def begin(self):
        """Runs until `finish`, or until it is cancelled."""

        def cancel(cancelled):
            self._cancelled += 1
            self._begun.remove(entry)
            cancelled.setCanceled()

        entry = [qi.Promise(cancel)]
        self._begun.append(entry)
        return entry[0].future()

    def finish(self, value):
        self._begun.pop(0)[0].setValue(value)

    def breakDown(self, text):
        self._begun.pop(0)[0].setError(text)

    def begun(self):
        return len(self._begun)

    def forget(self):
        """As if `begin` had never been called."""
        self._begun.clear()

    def cancellations(self):
        return self._cancelled


class Switch:
    """Makes modules come and go."""

    def __init__(self, session):
        self._session = session  # qi publishes callables only
        self._ids = {}

    def arrive(self, name):
        self._ids[name] = self._session.registerService(name, Module())

    def leave(self, name):
        self._session.unregisterService(self._ids.pop(name))


def free_the_port_at_death():
    """Have the listening socket, and those it accepts, vanish with the process.

    Otherwise a killed server leaves its port busy for a minute, because libqi does not set SO_REUSEADDR.
    """
    for number in os.listdir("/proc/self/fd"):
        try:
            duplicate = socket.socket(fileno=os.dup(int(number)))
        except OSError:
            continue  # no socket
        with duplicate:
            try:
                if duplicate.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN):
                    duplicate.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            except OSError:
                continue


def main():
    qi.logging.setLevel(qi.logging.FATAL)
    session = qi.Session()
    session.listenStandalone(f"tcp://127.0.0.1:{sys.argv[1]}")
    free_the_port_at_death()
    memory = qi.multiThreaded()(Memory)(session)
    session.registerService("ALMemory", memory)
    session.registerService("ALTest", Module())
    session.registerService("Switch", Switch(session))
    print("ready", session.endpoints()[0].rsplit(":", 1)[1], flush=True)
    sys.stdin.read()  # until the tests close it, or die


if __name__ == "__main__":
    main()
