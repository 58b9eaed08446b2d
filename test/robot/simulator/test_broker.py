"""The simulator's side of libqi: where it listens, whom it serves, whom it calls, and a port that is free again."""

import os
import queue
import re
import signal
import socket
import subprocess
import sys
import threading
from contextlib import closing, suppress
from pathlib import Path

import av
import pytest
import qi
from simulator import PATIENCE, connected
from sounds import sound_of
from waits import hold

from nao_library_modules.core.processes import descendants, identify, kill_survivors
from nao_sim_bridge.naoqi.binding import client_calls
from nao_sim_bridge.server import broker as module
from nao_sim_bridge.server import messages, own_sockets, wire
from nao_sim_bridge.server.broker import Broker
from nao_sim_bridge.server.wire import Wires
from nao_sim_bridge.testing import wait_until

SPEAKS = 0.01
"""s of processor time after which a copy of the speech process speaks: what comes before takes less than 1 ms."""
END_LIMIT = 60.0
"""s within which a simulator that is told to end is over, and after a kill all that it has started."""
LISTENS = re.compile(r"listens on 127\.0\.0\.1:(\d+)")


class Echo:
    """A module that is called, and can be held up."""

    def __init__(self, held_up=False):
        self.calls, self.entered, self.let_go = queue.Queue(), threading.Event(), threading.Event()
        if not held_up:
            self.let_go.set()

    @qi.bind(qi.Void, [qi.Dynamic])
    def hear(self, value):
        self.entered.set()
        self.let_go.wait(PATIENCE)
        self.calls.put(value)


@pytest.fixture
def listening():
    """Starts brokers that listen on a free port of an address."""
    made = []

    def start(address="127.0.0.1", port=0, name="test"):
        made.append(Broker(name))
        made[-1].listen(address, port)
        return made[-1]

    yield start
    for broker in made:
        broker.close()


@pytest.fixture
def connect():
    """Makes clients."""
    made = []

    def start(port):
        made.append(connected(port))
        return made[-1]

    yield start
    for session in made:
        session.close()


def test_a_broker_that_closes_ends_the_threads_of_its_calls(listening):
    broker, echo = listening(), Echo()
    broker.register("Closing", echo)
    broker.call("Closing", "hear", [1])
    assert echo.calls.get(timeout=PATIENCE) == 1
    (caller,) = (thread for thread in threading.enumerate() if thread.name == "calls of Closing")
    broker.close()
    caller.join(PATIENCE)
    assert not caller.is_alive()


def accepts(address, port):
    with socket.socket() as probe:
        probe.settimeout(2.0)
        return probe.connect_ex((address, port)) == 0


def test_it_listens_on_its_address_only_and_on_a_free_port(listening):
    loopback, everywhere = listening("127.0.0.1"), listening("0.0.0.0", name="mine")
    assert loopback.port != everywhere.port and everywhere.name == "mine"
    assert all(1024 <= broker.port <= 65535 for broker in (loopback, everywhere))
    reached = [accepts(a, broker.port) for broker in (loopback, everywhere) for a in ("127.0.0.1", "127.0.0.2")]
    assert reached == [True, False, True, True]


def test_what_cannot_be_listened_on_is_refused_at_once(listening, monkeypatch):
    port = listening().port
    monkeypatch.setattr(module.time, "sleep", lambda seconds: pytest.fail("waited for a port that is not being freed"))
    with pytest.raises(RuntimeError, match=f"cannot listen on 127.0.0.1:{port}: another program listens there"):
        listening(port=port)
    with pytest.raises(RuntimeError, match="cannot listen on 192.0.2.1:0: "):
        listening("192.0.2.1")


def test_a_port_that_a_connection_has_is_waited_for_and_told_as_what_it_is(listening, monkeypatch, caplog):
    with socket.create_server(("127.0.0.1", 0)) as listener, socket.socket() as connection:
        connection.connect(listener.getsockname())
        port = connection.getsockname()[1]
        with pytest.raises(RuntimeError, match=f"cannot listen on 127.0.0.1:{port}: {module.HELD}"):
            Broker().listen("127.0.0.1", port, lambda: False)
        assert f"port {port}: nobody listens, but {module.HELD}: waiting up to 65 s" in caplog.text
        monkeypatch.setattr(module, "BIND_PATIENCE", -1.0)
        with pytest.raises(RuntimeError, match=f"cannot listen on 127.0.0.1:{port}: {module.HELD}: choose another"):
            listening(port=port)


def test_the_port_is_free_at_its_end_also_of_who_connected_before_it_was_ready(listening, monkeypatch):
    early, free = socket.socket(), module.free_port_on_exit

    def ready(port):
        early.connect(("127.0.0.1", port))
        free(port)

    monkeypatch.setattr(module, "free_port_on_exit", ready)
    with early:
        broker = listening()
        broker.close()
        # A connection that is not reset would have the port for a minute.
        wait_until(lambda: not own_sockets.is_taken("127.0.0.1", broker.port), END_LIMIT / 2, "a free port")


def test_modules_of_clients_are_called_in_order_and_one_that_hangs_holds_up_no_other(listening, connect):
    broker, stuck, echo = listening(), Echo(held_up=True), Echo()
    client = connect(broker.port)
    client.listen("tcp://127.0.0.1:0")
    client.registerService("Stuck", stuck)
    client.registerService("Echo", echo)
    broker.call("Stuck", "hear", [1])
    assert stuck.entered.wait(PATIENCE)
    broker.call("Stuck", "hear", [2])
    for n in range(5):
        broker.call("Echo", "hear", [n])
    assert sorted(echo.calls.get(timeout=PATIENCE) for _ in range(5)) == list(range(5))
    broker.drop_calls()
    stuck.let_go.set()
    assert stuck.calls.get(timeout=PATIENCE) == 1
    broker.call("Stuck", "hear", [3])
    assert stuck.calls.get(timeout=PATIENCE) == 3  # the one that waited was dropped


def test_bytes_that_a_module_is_called_with_stay_bytes(listening, connect):
    broker, echo = listening(), Echo()
    client = connect(broker.port)
    client.listen("tcp://127.0.0.1:0")
    client.registerService("Echo", echo)
    broker.call("Echo", "hear", [[b"\x02\xff", {"picture": (1, 2.5, bytearray(b"text"))}, None, True, "ä", 2**40]])
    assert echo.calls.get(timeout=PATIENCE) == [b"\x02\xff", {"picture": (1, 2.5, b"text")}, None, True, "ä", 2**40]


def test_a_call_with_bytes_fails_as_its_method_does_and_when_its_program_has_ended(listening, connect):
    broker = listening()
    client = connect(broker.port)
    client.listen("tcp://127.0.0.1:0")
    client.registerService("Picky", Picky())
    picky = broker.service("Picky")
    with pytest.raises(RuntimeError, match="ValueError: too short"):
        picky.call("hear", b"\xff")
    assert picky.call("hear", b"\xff\xff") is None
    client.close()
    with pytest.raises(RuntimeError):
        picky.call("hear", b"\xff\xff")


def test_a_program_that_does_not_answer_holds_up_bytes_of_no_other(listening, connect, monkeypatch):
    broker, echo, wires = listening(), Echo(), Wires()
    monkeypatch.setattr(wire, "_CONNECT", 1000.0)
    client = connect(broker.port)
    client.listen("tcp://127.0.0.1:0")
    number = client.registerService("Echo", echo)
    (served,) = [each for each in client.services() if each["name"] == "Echo"]
    hear = next(n for n, each in broker.service("Echo").metaObject()["methods"].items() if each["name"] == "hear")
    with socket.create_server(("127.0.0.1", 0)) as silent, closing(wires):
        endpoint = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        threading.Thread(target=suppressed, args=(lambda: wires.call([endpoint], 2, 100, b""),), daemon=True).start()
        held_up, _ = silent.accept()
        with held_up:
            assert held_up.recv(1)  # its greeting, which nobody answers
            wires.call(served["endpoints"], number, hear, messages.packed_arguments("(m)", [b"\xff"])).value()
            assert echo.calls.get(timeout=PATIENCE) == b"\xff"


def suppressed(call):
    with suppress(RuntimeError):
        call()


class Picky:
    """Wants two bytes."""

    def hear(self, value):
        if len(value) < 2:
            raise ValueError("too short")


def test_a_module_whose_first_connection_is_refused_is_asked_again(listening, connect, monkeypatch):
    broker, echo = listening(), Echo()
    client = connect(broker.port)
    client.listen("tcp://127.0.0.1:0")
    client.registerService("Echo", echo)
    refusals = [RuntimeError("The call request could not be handled.")]
    real = module.answer
    monkeypatch.setattr(module, "answer", lambda *asked: real(*asked) if not refusals else raised(refusals.pop()))
    broker.call("Echo", "hear", [1])
    assert echo.calls.get(timeout=PATIENCE) == 1


def raised(error):
    raise error


def test_of_too_many_calls_that_wait_for_a_module_the_oldest_are_lost_and_counted(listening, connect, caplog):
    broker, stuck = listening(), Echo(held_up=True)
    client = connect(broker.port)
    client.listen("tcp://127.0.0.1:0")
    client.registerService("Stuck", stuck)
    broker.call("Stuck", "hear", [-1])
    assert stuck.entered.wait(PATIENCE)
    for n in range(module.WAITING + 3):
        broker.call("Stuck", "hear", [n])
    stuck.let_go.set()
    heard = [stuck.calls.get(timeout=PATIENCE) for _ in range(module.WAITING + 1)]
    assert heard == [-1, *range(3, module.WAITING + 3)]
    assert [r.args for r in caplog.records if "does not keep up" in r.msg] == [("Stuck", 1), ("Stuck", 2)]


def test_a_callback_that_always_fails_is_told_less_and_less(listening, connect, caplog):
    broker, echo = listening(), Echo()
    client = connect(broker.port)
    client.listen("tcp://127.0.0.1:0")
    client.registerService("Echo", echo)
    for _ in range(100):
        broker.call("Echo", "no_such_method", [1])
    broker.call("Echo", "hear", ["the last"])
    assert echo.calls.get(timeout=PATIENCE) == "the last"
    assert [r.args[-1] for r in caplog.records if "callback %s.%s" in r.msg] == [1, 2, 4, 8, 16, 32, 64]


CLIENT = """
import sys, time
import qi
session = qi.Session()
session.connect("tcp://127.0.0.1:" + sys.argv[1])
class Module:
    def hear(self, value):
        print("hears", flush=True)
        time.sleep(1000)
session.listen("tcp://127.0.0.1:0")
session.registerService("Client", Module())
if sys.argv[2:]:
    source = session.service(sys.argv[2])
    source.told.connect(lambda value: print("told", flush=True))
print("ready", flush=True)
time.sleep(1000)
"""


@pytest.fixture
def client_program():
    """Starts programs that are clients, killed after the test; each has said that it is ready."""
    started = []

    def start(*arguments):
        command = [sys.executable, "-c", CLIENT, *map(str, arguments)]
        started.append(subprocess.Popen(command, stdout=subprocess.PIPE, text=True))
        said(started[-1], "ready")
        return started[-1]

    yield start
    for one in started:
        one.kill()
        one.communicate()


def said(program, word):
    """Return when a program has said a word."""
    assert any(line.strip() == word for line in program.stdout)


def test_a_program_that_is_killed_in_a_call_leaves_no_thread_and_is_told_of(listening, client_program):
    broker, gone = listening(), queue.Queue()
    broker.when_gone(gone.put)
    program = client_program(broker.port)
    broker.call("Client", "hear", [1])
    broker.call("Client", "hear", [2])
    said(program, "hears")
    (caller,) = (thread for thread in threading.enumerate() if thread.name == "calls of Client")
    program.kill()
    assert gone.get(timeout=PATIENCE) == "Client"
    caller.join(PATIENCE)
    assert not caller.is_alive()


def test_a_module_that_never_answers_is_given_up(listening, client_program, monkeypatch):
    monkeypatch.setattr(client_calls, "GIVEN_UP", 0.2)
    broker, gone = listening(), queue.Queue()
    broker.when_gone(gone.put)
    client_program(broker.port)
    broker.call("Client", "hear", [1])
    assert gone.get(timeout=PATIENCE) == "Client"


def test_a_program_that_stopped_before_it_is_called_first_is_not_waited_for(listening, client_program, monkeypatch):
    monkeypatch.setattr(module, "FOUND", 0.2)
    broker = listening()
    hold(client_program(broker.port).pid)
    with pytest.raises(RuntimeError, match="no answer within 0.2 s"):
        broker.service("Client")


def test_a_client_that_takes_nothing_any_more_is_cut_off(listening, client_program, monkeypatch, caplog):
    monkeypatch.setattr(own_sockets, "STUCK", 0.5)
    monkeypatch.setattr(own_sockets, "LOOK_PERIOD", 0.1)
    broker, gone = listening(), queue.Queue()
    broker.when_gone(gone.put)

    class Source:
        def __init__(self):
            self.told = qi.Signal("(m)")

    source = Source()
    broker.register("Source", source)
    program = client_program(broker.port, "Source")
    source.told("first")
    said(program, "told")
    hold(program.pid)
    for _ in range(200):
        source.told("x" * 100000)  # more than the sockets hold
    assert gone.get(timeout=PATIENCE) == "Client"
    assert "has taken nothing for" in caplog.text


class Program:
    """A running simulator."""

    def __init__(self, *arguments, port=0):
        command = [sys.executable, "-m", "nao_sim_bridge", "--port", str(port), *arguments]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        output = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True}
        self.process = subprocess.Popen(command, env=environment, **output)
        self.said = []

    def port(self):
        """The port it says it listens on."""
        for line in self.process.stderr:
            self.said.append(line)
            match = LISTENS.search(line)
            if match:
                return int(match.group(1))
        raise AssertionError("it ended: " + "".join(self.said))

    def status(self):
        """Its exit status, after it has ended."""
        self.said.append(self.process.communicate(timeout=4 * PATIENCE)[1])
        return self.process.returncode


@pytest.fixture
def program():
    """Starts programs; those that still run are killed after the test."""
    started = []

    def start(*arguments, **options):
        started.append(Program(*arguments, **options))
        return started[-1]

    yield start
    for one in started:
        if one.process.poll() is None:
            one.process.kill()
            one.process.communicate()


@pytest.fixture
def used(connect):
    """Calls of every kind to a simulator, some of which still run."""

    def use(port):
        session = connect(port)
        session.service("NaoSimulation").advance(0.1)
        session.service("ALLeds").fade("FaceLeds", 0.0, 100.0, _async=True)
        session.service("ALMotion").call("wakeUp", _async=True)
        assert session.service("ALMotion").ping() is True
        return session

    return use


@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGINT, "shutdown"])
def test_a_signal_or_a_client_ends_the_program_in_order_while_calls_run(program, used, end):
    running = program("--paused")
    session = used(running.port())
    if end == "shutdown":
        session.service("ALSystem").call("shutdown", _async=True)
    else:
        running.process.send_signal(end)
    assert running.status() == 0, running.said


def test_after_a_kill_it_can_start_again_on_its_port_at_once(program, used):
    """Neither its clients nor the process that draws pictures may keep the port."""
    killed = program("--paused")
    port = killed.port()
    assert used(port).service("NaoSimulation").picture("front", 16, 16)
    killed.process.kill()
    killed.status()
    again = program("--paused", port=port)
    assert again.port() == port and not any("waiting" in line for line in again.said)


def frames(path):
    with av.open(str(path)) as film:
        return sum(1 for _ in film.decode(video=0))


def test_ctrl_c_ends_it_in_time_while_it_films_and_records_and_the_files_are_whole(program, connect, tmp_path):
    running = program("--record-dir", str(tmp_path))
    session = connect(running.port())
    film, video, sound = (tmp_path / name for name in ("film.mp4", "video.avi", "sound.wav"))
    session.service("NaoSimulation").startFilm(film.name, "front", 64, 64, 60.0)
    session.service("ALVideoRecorder").startRecording("/home/nao", video.stem)
    session.service("ALAudioRecorder").startMicrophonesRecording(sound.name, "wav", 16000, [0, 0, 1, 0])
    for path in (film, video, sound):
        wait_until(path.exists, 4 * PATIENCE, f"the beginning of {path.name}")
    running.process.send_signal(signal.SIGINT)
    running.process.wait(4 * PATIENCE)
    assert frames(film) and frames(video) and sound_of(sound).duration > 0.1


def stopped_copy(pid):
    """Stop a copy of the speech process that speaks; whether there was one.

    One that has only begun could not yet have asked the system to end it, and while it is stopped it cannot.
    """
    for worker in descendants(pid):
        for copy in descendants(worker.pid):
            if computed(copy.pid) > SPEAKS:
                os.kill(copy.pid, signal.SIGSTOP)
                wait_until(lambda pid=copy.pid: state(pid) != "R", PATIENCE, "a copy that stops or ends")
                return state(copy.pid) == "T"
    return False


def state(pid):
    """What a process does, the letter of /proc: R runs, T was stopped, Z ended; "" if it is gone."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return ""


def computed(pid):
    """Processor time that a process has had, s; 0 if it is gone."""
    try:
        return int(Path(f"/proc/{pid}/schedstat").read_text().split()[0]) / 1e9
    except (OSError, IndexError):
        return 0.0


def test_nothing_is_left_of_a_simulator_that_is_killed_while_it_speaks_draws_and_recognises(program, connect):
    running = program()
    pid, session = running.process.pid, connect(running.port())
    session.service("NaoSimulation").picture("front", 16, 16)
    hearing = session.service("ALSpeechRecognition")
    hearing.setVocabulary(["yes"], False)
    hearing.subscribe("test")
    text = " ".join(f"Number {number}, and so on, and so on, and on." for number in range(60))
    session.service("ALTextToSpeech").call("sayToFile", text, "text.wav", _async=True)
    wait_until(lambda: stopped_copy(pid), 4 * PATIENCE, "a text that is spoken")
    session.service("NaoSimulation").call("picture", "front", 4096, 4096, _async=True)
    started = descendants(pid)
    assert len(started) == 4
    running.process.kill()
    try:
        wait_until(lambda: not any(identify(one.pid) == one for one in started), END_LIMIT, "the end of its processes")
    finally:
        kill_survivors(started)


def test_what_keeps_it_from_starting_is_said_in_one_line(program):
    ended = program("--world", "moon")
    assert ended.status() == 1
    assert re.search(r"\[nao_sim\] ERROR .*no world 'moon'.*empty", ended.said[-1])


def test_it_knows_whether_a_client_is_connected(listening, connect):
    broker = listening()
    other = listening()
    connect(other.port)
    assert not broker.has_clients() and other.has_clients()
    client = connect(broker.port)
    assert broker.has_clients()
    client.close()
    wait_until(lambda: not broker.has_clients(), PATIENCE, "the connection has ended")
