"""Everything that a program may have under way, or begin, while its robot answers nothing; prints what became of it.

`patient_program.py naoqi|qi PORT`. Says "ready", begins the rest when it reads "silent", and answers "over".
"""

import sys
import threading

import qi

LIMIT = 100.0
KIND, PORT = sys.argv[1], int(sys.argv[2])
URL = f"tcp://127.0.0.1:{PORT}"
heard = {}


class Hearer:
    """A module that the robot calls."""

    def on_event(self, key, value, message):
        note(key, value)


def note(key, value):
    heard.setdefault(key, threading.Event()).set()
    print(f"{key} came: {value}", flush=True)


def expect(*keys):
    for key in keys:
        heard.setdefault(key, threading.Event())


if KIND == "naoqi":
    from naoqi import ALBroker, ALModule, ALProxy

    broker = ALBroker("broker", "127.0.0.1", 0, "127.0.0.1", PORT)

    def service(name):
        return ALProxy(name)

    def register(name):
        return type("Module", (Hearer, ALModule), {})(name)

    def new_connection():
        return ALProxy("ALMemory", "localhost", PORT).getData("RobotConfig/Body/Type")

    def post(*call):
        return motion.wait(getattr(motion.post, call[0])(*call[1:]), 0)
else:
    session = qi.Session()
    session.connect(URL)
    session.listen("tcp://127.0.0.1:0")
    service = session.service

    def register(name):
        hearer = Hearer()
        session.registerService(name, hearer)
        return hearer

    def new_connection():
        other = qi.Session()
        other.connect(URL)
        return other.service("ALMemory").getData("RobotConfig/Body/Type")

    def post(*call):
        return getattr(motion, call[0])(*call[1:], _async=True).value()


motion, memory, video = service("ALMotion"), service("ALMemory"), service("ALVideoDevice")
first, camera = register(f"First{KIND}"), video.subscribeCamera(KIND, 0, 1, 11, 10)
before, during = f"{KIND}/Before", f"{KIND}/During"
expect(before, during, f"{before}/signal")
memory.subscribeToEvent(before, f"First{KIND}", "on_event")
signal = memory.subscriber(before)
signal.signal.connect(lambda value: note(f"{before}/signal", value))
threads = []


def begin(what, work):
    def run():
        try:
            print(f"{what}: {work()}", flush=True)
        except Exception as error:
            print(f"{what} FAILED: {error!r}", flush=True)

    threads.append(threading.Thread(target=run))
    threads[-1].start()


def subscribe_anew():
    global second
    second = register(f"Second{KIND}")
    memory.subscribeToEvent(during, f"Second{KIND}", "on_event")
    memory.raiseEvent(during, 2)


joint = "HeadYaw" if KIND == "qi" else "HeadPitch"
motion.setStiffnesses("Head", 1.0)
begin("blocking call", lambda: motion.angleInterpolation(joint, 0.2, 2.0, True))
begin("posted call", lambda: post("angleInterpolation", "RElbowYaw" if KIND == "qi" else "LElbowYaw", 0.2, 2.0, True))
print("ready", flush=True)
assert sys.stdin.readline() == "silent\n"
begin("question", lambda: memory.getData("RobotConfig/Body/Type"))
begin("picture", lambda: video.getImageRemote(camera)[0])
begin("event", lambda: memory.raiseEvent(before, 1))
begin("new module of the robot", lambda: bool(service("ALLeds").listGroups()))
begin("new connection", new_connection)
begin("new module of the program", subscribe_anew)
for thread in threads:
    thread.join(LIMIT)
for key, came in heard.items():
    if not came.wait(LIMIT):
        print(f"{key} FAILED: it did not come", flush=True)
print("over", flush=True)
if KIND == "naoqi":
    broker.shutdown()
