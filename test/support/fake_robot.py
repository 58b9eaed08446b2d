"""A robot as far as modules see it: calls, proxies, LEDs, memory, connection."""

from __future__ import annotations

import threading
from types import SimpleNamespace

from naoqi.errors import CallCanceled, RobotError

PREFIX = "Device/SubDeviceList/"


class FakeCall:
    """A call to the robot that ends when it is told to."""

    def __init__(self, name="Fake.method"):
        self.name = name
        self.canceled = False
        self._ended = threading.Event()
        self._lock = threading.Lock()
        self._callbacks = []
        self._result = None
        self._error = None

    def end(self, result=None, error=None):
        with self._lock:
            if self._ended.is_set():
                return
            self._result, self._error = result, error
            self._ended.set()
            callbacks = self._callbacks
        for callback in callbacks:
            callback(self)

    def add_done_callback(self, callback):
        with self._lock:
            if not self._ended.is_set():
                self._callbacks.append(callback)
                return
        callback(self)

    def done(self):
        return self._ended.is_set()

    def wait(self, timeout=None):
        return self._ended.wait(timeout)

    def result(self, timeout=None):
        assert self._ended.wait(timeout), f"{self.name}: nobody ended this call"
        if self._error is not None:
            raise self._error
        return self._result

    def cancel(self):
        self.canceled = True
        self.end(error=CallCanceled(*self.name.split(".")))


class FakeProxy:
    """Calls methods of `service`; a method that returns a FakeCall is a call that takes its time."""

    def __init__(self, name, service):
        self._name = name
        self._service = service
        self.calls = []

    def call_async(self, method, *args):
        self.calls.append((method, *args))
        call = FakeCall(f"{self._name}.{method}")
        try:
            result = getattr(self._service, method)(*args)
        except RobotError as error:
            call.end(error=error)
            return call
        if isinstance(result, FakeCall):
            return result
        call.end(result)
        return call

    def subscriber(self, name):
        return self._service.subscriber(name)


class FakeLeds:
    """ALLeds with a handful of lights. Fades take their time: the test ends them through `pending`."""

    def __init__(self):
        self.lights = {f"{side}FaceLed{n}": self._rgb(side, n) for side in ("Left", "Right") for n in (1, 2)}
        self.lights.update({f"Brain{n}": [f"Head/Led/Front/{n}/Actuator/Value"] for n in (0, 1)})
        self.lights["LeftEarLed1"] = ["Ears/Led/Left/0Deg/Actuator/Value"]
        for part in ("Red", "Green", "Blue"):
            self.lights[f"ChestLeds{part}"] = [f"ChestBoard/Led/{part}/Actuator/Value"]
        self.groups = {
            "LeftFaceLeds": ["LeftFaceLed1", "LeftFaceLed2"],
            "RightFaceLeds": ["RightFaceLed1", "RightFaceLed2"],
            "FaceLeds": ["LeftFaceLeds", "RightFaceLeds"],
            "LeftFaceLedsRed": [self.lights["LeftFaceLed1"][0], self.lights["LeftFaceLed2"][0]],
            "BrainLeds": ["Brain0", "Brain1"],
            "EarLeds": ["LeftEarLed1"],
            "ChestLeds": ["ChestLedsRed", "ChestLedsGreen", "ChestLedsBlue"],
        }
        self.groups["AllLeds"] = ["FaceLeds", "BrainLeds", "EarLeds", "ChestLeds"]
        self.values = {device: 0.25 for devices in self.lights.values() for device in devices}
        self.pending = []
        self.started = threading.Event()

    @staticmethod
    def _rgb(side, n):
        return [f"Face/Led/{part}/{side}/{45 * (n - 1)}Deg/Actuator/Value" for part in ("Red", "Green", "Blue")]

    def devices(self, name):
        if name in self.groups:
            return [device for member in self.groups[name] for device in self.devices(member)]
        if name in self.lights:
            return self.lights[name]
        if name in self.values:
            return [name]
        raise RobotError("ALLeds", "devices", f"no LED {name}")

    def _slow(self, name):
        call = FakeCall(f"ALLeds.{name}")
        self.pending.append(call)
        self.started.set()
        return call

    def listLEDs(self):
        return list(self.lights)

    def listGroups(self):
        return list(self.groups)

    def listLED(self, name):
        return self.lights[name]

    def listGroup(self, name):
        return self.groups[name]

    def createGroup(self, name, members):
        self.groups[name] = members

    def setIntensity(self, name, value):
        self.values.update((device, value) for device in self.devices(name))

    def on(self, name):
        self.setIntensity(name, 1.0)

    def off(self, name):
        self.setIntensity(name, 0.0)

    def reset(self, name):
        self.setIntensity(name, 0.0)

    def fade(self, name, value, duration):
        self.setIntensity(name, value)
        return self._slow("fade") if duration else None

    def fadeRGB(self, name, red, green, blue, duration):
        for device in self.devices(name):
            for part, value in (("Red", red), ("Green", green), ("Blue", blue)):
                if f"/{part}/" in device:
                    self.values[device] = value
        return self._slow("fadeRGB") if duration else None

    def fadeListRGB(self, name, colours, times):
        return self._slow("fadeListRGB")

    def randomEyes(self, duration):
        self.setIntensity("FaceLeds", 0.75)
        return self._slow("randomEyes")

    def rasta(self, duration):
        return self._slow("rasta")

    def rotateEyes(self, rgb, rotation_time, duration):
        return self._slow("rotateEyes")

    def earLedsSetAngle(self, angle, duration, leave_on):
        self.setIntensity("EarLeds", 0.5)
        return self._slow("earLedsSetAngle")


class FakeSignal:
    """A signal of ALMemory's subscriber."""

    def __init__(self):
        self.links = {}
        self._count = 0

    def __len__(self):
        return len(self.links)

    def connect(self, callback):
        self._count += 1
        self.links[self._count] = callback
        return self._count

    def disconnect(self, link):
        del self.links[link]

    def __call__(self, value):
        for callback in list(self.links.values()):
            callback(value)


class FakeMemory:
    """ALMemory with the LEDs' values and a dict."""

    def __init__(self, leds):
        self._leds = leds
        self.data = {"Name": "nao", "Angles": [0.5, 1.0], "Level": 0.25}
        self.signals = {}

    def getData(self, key):
        if key not in self.data:
            raise RobotError("ALMemory", "getData", f"no data {key}")
        return self.data[key]

    def getListData(self, keys):
        stored = {PREFIX + device: value for device, value in self._leds.values.items()}
        stored.update(self.data)
        return [stored.get(key) for key in keys]

    def getDataList(self, text):
        return [key for key in self.data if text in key]

    def insertData(self, key, value):
        self.data[key] = value

    raiseEvent = insertData

    def removeData(self, key):
        del self.data[key]

    def ping(self):
        return True

    def subscriber(self, name):
        return SimpleNamespace(signal=self.signals.setdefault(name, FakeSignal()))


class FakeConnection:
    """A connection of the proxy layer, in the state that the test says."""

    host, port = "10.0.0.7", 9559

    def __init__(self):
        self.state = "connected"
        self.latency = 0.001
        self.last_error = None
        self.generation = 1
        self.modules = []
        self.listeners = []

    def add_listener(self, listener):
        self.listeners.append(listener)

    def remove_listener(self, listener):
        if listener in self.listeners:
            self.listeners.remove(listener)

    def wait_connected(self, limit):
        return self.state == "connected"

    def module_names(self):
        return self.modules

    def become(self, state, last_error=None):
        self.state = state
        self.last_error = last_error
        self.generation += state == "connected"
        for listener in list(self.listeners):
            listener(state)


class FakeRobot:
    def __init__(self):
        self.address = "10.0.0.7:9559"
        self.connection = FakeConnection()
        self.leds = FakeLeds()
        self.memory = FakeMemory(self.leds)
        self._proxies = {}
        self.add("ALLeds", self.leds)
        self.add("ALMemory", self.memory)

    def add(self, name, service):
        self._proxies[name] = FakeProxy(name, service)

    def proxy(self, name):
        return self._proxies[name]
