"""The robots of a ROS master, and the client of each: the only way by which the console reaches a robot."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from functools import partial
from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalID
from geometry_msgs.msg import Twist
from std_srvs.srv import Empty

from nao_library_msgs.srv import DescribeFunctions
from naoqi.errors import NaoError

from ...cli.output import plain, progress_text
from ...core.errors import of_those
from ...core.process_owners import OwnerLine
from ...core.server_types import DESCRIBE, ServerType, servers_among, those_in
from ...ros.driver_types import spoken
from ...ros.goal_client import SERVER_LIMIT, GoalTracker, NoService, NotAnswered, call_service, server_connection
from ...ros.master_api import GONE
from ...studies.commands import CommandGoal, NotThere, RobotCommand, ServiceRefused, Stopped, goal_of, type_of
from ...studies.robot_events import EventStream, namespace_of, within
from .robot_goals import ENDS, LOST, STATES, ForeignGoals, GoalEnd, LastStop, Run

FRESH, PATIENCE = 1.0, 0.5
"""s of this computer: for which an answer is good, and for which one is waited."""
FIRST_PATIENCE = 10.0
"""s for which the first answer is waited: without any, each robot would be told to be none."""
CANCEL, CANCEL_TYPE = "/cancel", "actionlib_msgs/GoalID"
"""End of the names of topics by which goals are cancelled, and their type."""


class MasterLook:
    """The books of the master, as they were a second ago at most. Any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._read = float("-inf")
        self._services: list[str] = []
        self._subscribed: dict[str, list[str]] = {}
        self._types: dict[str, str] = {}
        self._asking, self._answered = False, threading.Event()

    def namespaces(self) -> list[str]:
        """Of the robots that have servers, each with a slash at both ends, sorted."""
        return sorted({name.rpartition("/")[0] + "/" for name in self._all_servers()})

    def servers(self, namespace: str) -> list[str]:
        """Relative names of the servers of a robot, sorted."""
        return sorted(those_in(namespace, self._all_servers()), key=str.lower)

    def cancel_topics(self, namespace: str) -> list[str]:
        """Full names of the topics by which goals of a robot's actions are cancelled, also those of its driver."""
        self._look()
        return [
            name
            for name in self._subscribed
            if name.startswith(namespace) and name.endswith(CANCEL) and self._types.get(name) == CANCEL_TYPE
        ]

    def services(self) -> list[str]:
        """Full names of all services."""
        self._look()
        return list(self._services)

    def service_address(self, service: str) -> str:
        """Where a service is at this moment, by its full name; empty if it is not there."""
        try:
            code, _, address = rospy.get_master().lookupService(service)
        except GONE:
            return ""
        return address if code == 1 else ""

    def _all_servers(self) -> list[str]:
        self._look()
        return [name for name in servers_among(self._services) if f"{name}/goal" in self._subscribed]

    def _look(self) -> None:
        """Read the registrations again where they are old.

        Wait once for a slow master, and only briefly after its first answer.
        """
        with self._lock:
            if time.monotonic() - self._read < FRESH:
                return
            if self._read == float("-inf"):
                patience = FIRST_PATIENCE
            else:
                patience = 0.0 if self._asking else PATIENCE
            if not self._asking:
                self._asking = True
                self._answered.clear()
                threading.Thread(target=self._ask, name="look at the master", daemon=True).start()
        self._answered.wait(patience)

    def _ask(self) -> None:
        services: Any = []
        subscribers: Any = []
        types: dict[str, str] = {}
        try:
            code, _, state = rospy.get_master().getSystemState()
            if code == 1:
                _, subscribers, services = state
                types = dict(rospy.get_master().getTopicTypes()[2])
        except GONE:
            pass  # no master: nothing runs
        with self._lock:
            self._services = [name for name, _ in services]
            self._subscribed = {name: list(nodes) for name, nodes in subscribers}
            self._types = types
            self._read = time.monotonic()
            self._asking = False
        self._answered.set()


log = logging.getLogger(__name__)

WALK_HOLD = 0.4
"""s that a velocity holds; who wants more sends it again."""
CONSOLE = "console"
"""Who sends goals in nobody's name."""
STOP_WALK = "stop_walk_srv"


class RobotClient:
    """A robot's servers, by their names in its namespace. Any thread.

    ROS API:
        Client of the actions that describe themselves. Publishes `cmd_vel` (geometry_msgs/Twist) while somebody walks
        it, and `*/cancel` of all actions at a stop. Calls `NAME/describe`, `stop_walk_srv`.

    Attributes:
        seen_servers: Relative names of the servers that ran at the last look, while somebody watches.
    """

    def __init__(self, namespace: str, master: MasterLook) -> None:
        self.namespace = namespace
        self.name = namespace.strip("/") or "/"
        self.events = EventStream(namespace, self.now)
        self._master = master
        self._lock = threading.RLock()
        # These two may be held while the master is waited for; the other one never is, for a stop needs it.
        self._following, self._connecting = threading.RLock(), threading.Lock()
        self._clients: dict[str, actionlib.ActionClient] = {}
        self._types: dict[str, ServerType] = {}
        self._described: dict[str, tuple[str, Any]] = {}
        self._cancels: dict[str, rospy.Publisher] = {}
        self._own: dict[str, tuple[Run, _OwnedGoal]] = {}
        self._stops = 0
        self._last_stop = LastStop()
        self._foreign = ForeignGoals(namespace, self._is_own)
        self._watchers = 0
        self.seen_servers: list[str] = []
        self._owners: OwnerLine | None = None
        self._walk_lock = threading.Condition()
        self._walk: tuple[float, float, float] | None = None
        self._walk_until = 0.0
        self._walk_thread: threading.Thread | None = None
        self._velocity: rospy.Publisher | None = None

    def now(self) -> float:
        """ROS time, s."""
        return rospy.get_time()

    # --- what there is --------------------------------------------------------------------------------------------

    def servers(self) -> list[str]:
        """Relative names of the servers that run."""
        return self._master.servers(self.namespace)

    def describe(self, server: str) -> Any:
        """What a server says of all its functions, DescribeFunctionsResponse; kept until it is started anew.

        Raises NotThere.
        """
        place = self._master.service_address(self.namespace + server + DESCRIBE)
        if not place:
            raise NotThere(f"there is no server {server!r}{of_those(server, self.servers())}")
        with self._lock:
            kept = self._described.get(server)
        if kept is None or kept[0] != place:
            kept = (place, self.call(server + DESCRIBE, DescribeFunctions))
            with self._lock:
                self._described[server] = kept
                self._types.pop(server, None)
        return kept[1]

    def describe_all(self) -> dict[str, Any]:
        """Server -> what it says of its functions, of all that run."""
        described = {}
        for server in self.servers():
            with suppress(NaoError):  # it has gone meanwhile
                described[server] = self.describe(server)
        return described

    def state_of(self, server: str) -> Any:
        """How a server does: DescribeFunctionsResponse without functions. Raises NotThere."""
        return self.call(server + DESCRIBE, DescribeFunctions, without_functions=True)

    def has_service(self, name: str) -> bool:
        return bool(self._master.service_address(self.namespace + name))

    def call(self, name: str, kind: type, /, **fields: Any) -> Any:
        """Call a service of this robot, or one by its full name. Raises NotThere, ServiceRefused."""
        full = name if name.startswith("/") else self.namespace + name
        try:
            return call_service(full, kind, kind._request_class(**fields))
        except NoService as error:
            raise NotThere(str(error)) from None
        except NotAnswered as error:
            raise ServiceRefused(str(error)) from None

    def topic(self, name: str, kind: type, callback: Callable[[Any], None], queue_size: int = 1) -> Callable[[], None]:
        """Listen to a topic of this robot, or to one by its full name; what comes back ends that."""
        full = name if name.startswith("/") else self.namespace + name
        subscriber = rospy.Subscriber(
            full, spoken(kind, self.namespace), callback, queue_size=queue_size, tcp_nodelay=True
        )
        return subscriber.unregister

    # --- goals ----------------------------------------------------------------------------------------------------

    def send(
        self,
        command: RobotCommand,
        by: str = "",
        label: str = "",
        stops: int | None = None,
        patience: float = SERVER_LIMIT,
    ) -> Run | None:
        """Carry out a command; None for one that stops everything.

        `stops`: as it was when somebody wanted that. `patience`: s for which a server is waited for that has gone.
        Raises BadGoal if it will not do, NotThere if there is no such server, Stopped if everything was stopped
        meanwhile.
        """
        stops = self._stops if stops is None else stops
        if command.stops:
            self.stop(by)
            return None
        types = self._types_of(command.server)
        return self.send_goal(goal_of(command, types), by, label or command.label, stops, patience)

    def send_goal(
        self,
        goal: CommandGoal,
        by: str = "",
        label: str = "",
        stops: int | None = None,
        patience: float = SERVER_LIMIT,
    ) -> Run:
        """Send a goal; see `send`. Raises NotThere if no server takes it, Stopped."""
        stops = self._stops if stops is None else stops
        client = self._client(goal.server, goal.action, patience)
        names = [function.function for function in getattr(goal.goal, "functions", ())]  # those of plans have none
        run = Run("", self.namespace, goal.server, names, label or ", ".join(names), by or CONSOLE, self.now())
        tracker = _OwnedGoal(self._owner_line(goal.server), server_connection(client))
        chain = plain(goal.goal).get("functions", [plain(goal.goal)])
        if stops != self._stops:
            raise Stopped(f"everything was stopped: {run.label} is not sent")
        handle = client.send_goal(goal.goal, partial(self._moved, run, tracker), partial(self._told, run))
        self._note(run, tracker, handle)
        if stops != self._stops:
            run.cancel()
        self.events.add("sent", f"{goal.server}: {run.label}", run.by, goal=run.id, server=goal.server, chain=chain)
        self._lose_goals(goal.server, client)  # it may have died before the goal was among those that go on
        return run

    @property
    def runs(self) -> list[Run]:
        """The goals that go on, those of other programs among them while somebody watches."""
        with self._lock:
            own = [run for run, _ in self._own.values()]
        return [*own, *self._foreign.runs()]

    def prepare(self, servers: Iterable[str]) -> None:
        """Connect to servers, so that the first goal of each goes at once. In the background."""
        for server in servers:
            _in_thread(self._prepare, server)

    def watch(self) -> Callable[[], None]:
        """Follow goals of other programs until what comes back is called; be ready to stop at once from now on."""
        with self._following:
            self._watchers += 1
        self.refresh()
        turns = iter([self._unwatch])
        return lambda: next(turns, lambda: None)()

    def refresh(self) -> None:
        """Take notice of servers that have come or gone; called while somebody watches."""
        with self._following:
            if not self._watchers:
                return
            self.seen_servers = self._master.servers(self.namespace)
            self._foreign.follow(self.seen_servers)
            for topic in self._master.cancel_topics(self.namespace):
                if topic not in self._cancels:
                    publisher = rospy.Publisher(topic, GoalID, queue_size=2, tcp_nodelay=True)
                    with self._lock:
                        self._cancels[topic] = publisher

    def _unwatch(self) -> None:
        with self._following:
            self._watchers -= 1
            if self._watchers:
                return
            self._foreign.follow(())  # topics of cancels stay: who comes back while the master hangs can stop

    # --- stop and walk --------------------------------------------------------------------------------------------

    @property
    def stops(self) -> int:
        """How often everything was stopped; who acts later than asked for gives it to `send`."""
        return self._stops

    def stop(self, by: str = "") -> None:
        """End all goals of all actions of the robot, and its walk."""
        runs = self.runs
        with self._lock:
            self._stops += 1
            ready = {topic: each for topic, each in self._cancels.items() if each.get_num_connections()}
            own = [run for run, _ in self._own.values()]
        self._hold_walk(None)
        for publisher in ready.values():
            publisher.publish(GoalID())
        for run in own:
            run.cancel()  # a goal that is on its way may come behind the cancel of all
        for step in self._last_stop.begin(runs, self._stop_walk, partial(self._stop_others, set(ready))):
            _in_thread(step)
        self.events.add("stopped", "everything is told to stop", by)  # last: whoever listens may take a while

    def was_stopped(self, by: str) -> None:
        """Another program has ended all goals; what was wanted before is not sent any more."""
        with self._lock:
            self._stops += 1
        self._last_stop.begin(self.runs)
        self.events.add("stopped", f"everything was told to stop by {by}", by)

    @property
    def stop_state(self) -> str:
        """How far the last stop is, see `LastStop`; goals of other programs count while somebody watches."""
        return self._last_stop.state(self.runs)

    def walk(self, x: float, y: float, theta: float, by: str = "") -> None:
        """Walk at shares -1..1 of the top speed, ahead, to the left and turning left, for WALK_HOLD s."""
        way = tuple(max(-1.0, min(1.0, float(value))) for value in (x, y, theta))
        began = self._hold_walk(way)
        if began and any(way):
            self._last_stop.has_begun()
            self.events.add("walked", "walks by hand", by, velocity=list(way))

    def _hold_walk(self, way: Any) -> bool:
        """Whether a walk by hand begins with it."""
        with self._walk_lock:
            began = self._walk is None
            if way is None and began:
                return False
            self._walk = way or (0.0, 0.0, 0.0)
            self._walk_until = time.monotonic() + WALK_HOLD if any(self._walk) else 0.0
            if self._walk_thread is None:
                self._walk_thread = threading.Thread(target=self._walk_on, name=f"walk of {self.name}", daemon=True)
                self._walk_thread.start()
            self._walk_lock.notify_all()
        return began

    def _walk_on(self) -> None:
        """Send velocities at once and ten times a second, and a stop at their end."""
        with self._connecting:
            if self._velocity is None:
                topic = self.namespace + "cmd_vel"
                self._velocity = rospy.Publisher(topic, Twist, queue_size=1, tcp_nodelay=True)
        while True:
            with self._walk_lock:
                over = time.monotonic() >= self._walk_until or self._walk is None
                x, y, theta = (0.0, 0.0, 0.0) if over else self._walk
                velocity = Twist()
                velocity.linear.x, velocity.linear.y, velocity.angular.z = x, y, theta
                self._velocity.publish(velocity)
                if over:
                    self._walk = self._walk_thread = None
                    return
                left = min(0.1, self._walk_until - time.monotonic())
                self._walk_lock.wait(max(left, 0.0))

    def _stop_walk(self) -> None:
        """End a walk that no goal holds."""
        try:
            if self.has_service(STOP_WALK):
                self.call(STOP_WALK, Empty)
        except NaoError as error:
            log.warning("the robot %s was not told to stop walking: %s", self.name, error)

    def _stop_others(self, ready: set[str]) -> None:
        """Cancel the goals of actions that nobody was connected to."""
        topics = [topic for topic in self._master.cancel_topics(self.namespace) if topic not in ready]
        left = [rospy.Publisher(topic, GoalID, queue_size=1) for topic in topics]
        made = list(left)

        def tell() -> bool:
            for publisher in [each for each in left if each.get_num_connections()]:
                publisher.publish(GoalID())
                left.remove(publisher)
            return not left

        within(SERVER_LIMIT, tell)
        for publisher in made:
            publisher.unregister()

    # --- inside ---------------------------------------------------------------------------------------------------

    def _types_of(self, server: str) -> ServerType:
        with self._lock:
            if server in self._types:
                return self._types[server]
        try:
            types = type_of(server, self.describe)
        except KeyError as error:
            raise NotThere(str(error)) from None
        with self._lock:
            return self._types.setdefault(server, types)

    def _prepare(self, server: str) -> None:
        try:
            self._client(server, self._types_of(server).action)
            self._owner_line(server)
        except NaoError as error:
            log.info("%s is not there yet: %s", server, error)

    def _client(self, server: str, action: type, patience: float = SERVER_LIMIT) -> Any:
        """The client of a server. `patience`: s for which one is waited for that ran before."""
        with self._connecting:
            if server not in self._clients:
                client = self._clients[server] = actionlib.ActionClient(self.namespace + server, action)
                client.pub_goal.impl.add_subscriber_listener(_Departure(partial(self._lose_goals, server, client)))
            client = self._clients[server]
        limit = SERVER_LIMIT if client.last_status_msg is None else patience
        if not within(limit, lambda: server_connection(client) is not None):
            raise NotThere(f"the server {server} does not run{of_those(server, self.servers())}")
        return client

    def _owner_line(self, server: str) -> OwnerLine | None:
        """The line to the watch of this robot's owners: should the console die, its goals end."""
        with self._connecting:
            if self._owners is None:
                try:
                    self._owners = OwnerLine(self.state_of(server).robot)
                    self._owners.name = rospy.get_name()
                except NaoError:
                    return None
            return self._owners

    def _is_own(self, goal: str) -> bool:
        return goal.startswith(rospy.get_name() + "-")

    def _note(self, run: Run, tracker: _OwnedGoal, handle: Any) -> None:
        """Have a goal among those that go on; done once, before anything is told of it."""
        with self._lock:
            if run.id:
                return
            run.id = handle.comm_state_machine.action_goal.goal_id.id
            run.cancel_goal = lambda: _in_thread(tracker.cancel, handle)
            self._own[run.id] = run, tracker

    def _moved(self, run: Run, tracker: _OwnedGoal, handle: Any) -> None:
        """A goal has changed its state: in actionlib's thread, under its lock."""
        self._note(run, tracker, handle)
        status = handle.get_goal_status()
        if status not in ENDS:
            run.state = STATES.get(status, run.state)
        tracker.look(handle)
        if tracker.over.is_set():
            _in_thread(self._end, run, handle)

    def _told(self, run: Run, _: Any, feedback: Any) -> None:
        run.feedback = plain(feedback)
        run.progress = progress_text(run.feedback)

    def _end(self, run: Run, handle: Any) -> None:
        end, result = ENDS[handle.get_terminal_state()], handle.get_result()
        text = handle.get_goal_status_text() or "" if end is not LOST else _lost(run)
        self._over(run, end, text, {} if result is None else plain(result))

    def _lose_goals(self, server: str, client: Any) -> None:
        """End the goals of a server that has gone: nothing more will be told of them."""
        left = client.pub_goal.impl.connections
        with self._lock:
            own = list(self._own.values())
        for run, tracker in own:
            if run.server == server and tracker.connection not in left:
                tracker.lose()
                self._over(run, LOST, _lost(run), {})

    def _over(self, run: Run, end: GoalEnd, text: str, result: Mapping[str, Any]) -> None:
        with self._lock:
            if self._own.pop(run.id, None) is None:
                return
        told = f"{run.server}: {run.label} {end.state}" + (f": {text}" if text and end.failed else "")
        about = {"goal": run.id, "server": run.server, "state": end.state, "reason": text, "result": result}
        self.events.add("ended", told, run.by, **about)
        run.end(end, text, result)


class _OwnedGoal(GoalTracker):
    """A goal that the watch of its robot cancels if this process dies. `connection`: what it goes through."""

    def __init__(self, owners: OwnerLine | None, connection: Any) -> None:
        super().__init__()
        self.owners = owners  # type: ignore[misc]  # several robots, a line to each
        self.connection = connection

    def lose(self) -> None:
        """Its server has gone."""
        if self.owners is not None:
            self.owners.let_go(self)
        self.acknowledged.set()
        self.over.set()


class _Departure(rospy.SubscribeListener):
    """Calls `then`, in a thread of its own, when somebody takes goals no more."""

    def __init__(self, then: Callable[[], None]) -> None:
        super().__init__()
        self._then = then

    def peer_unsubscribe(self, _topic_name: str, _num_peers: int) -> None:
        """Called by rospy."""
        _in_thread(self._then)


def _lost(run: Run) -> str:
    """What is known of a goal whose server has gone."""
    return (
        f"the server {run.robot}{run.server} died or was started again, or the connection to it broke, before"
        f" {run.label!r} was over: nobody knows how much of it was done. Look at the robot, and why in the terminal of"
        " the stack; then press again"
    )


def _in_thread(task: Callable[..., Any], *arguments: Any) -> None:
    threading.Thread(target=task, args=arguments, daemon=True).start()


PERIOD = 2.0
"""s of this computer between two looks for new servers while somebody watches."""


class Robots:
    """The robots that the master knows, each made when it is asked for first. Any thread."""

    def __init__(self) -> None:
        self.master = MasterLook()
        self._lock = threading.Lock()
        self._robots: dict[str, RobotClient] = {}
        self._watchers: dict[object, Callable[[], None]] = {}
        self._changed = threading.Condition()

    def names(self) -> list[str]:
        """Names of the robots: their namespaces without slashes, or "/"."""
        return [namespace.strip("/") or "/" for namespace in self.master.namespaces()]

    def robot(self, name: str = "") -> RobotClient:
        """A robot by its name; empty: the first. Raises NotThere if it has never been seen."""
        known = self.known(name) if name else None
        if known is not None:
            return known
        names = self.names()
        wanted = name.strip("/") or ("/" if name or "/" in names or not names else names[0])
        namespace = namespace_of(wanted)
        with self._lock:
            if namespace in self._robots:
                return self._robots[namespace]
            if name and wanted not in names:
                raise NotThere(f"there is no robot {name!r}{of_those(wanted, names)}")
            return self._robots.setdefault(namespace, RobotClient(namespace, self.master))

    def known(self, name: str) -> RobotClient | None:
        """A robot that was asked for before; the master is not asked, as a stop must not wait for it."""
        with self._lock:
            return self._robots.get(namespace_of(name))

    def watch(self, robot: RobotClient) -> Callable[[], None]:
        """Follow what a robot does and which servers it has, until what comes back is called."""
        key, end = object(), robot.watch()
        with self._changed:
            first = not self._watchers
            self._watchers[key] = robot.refresh
        if first:
            threading.Thread(target=self._look, name="look at the master", daemon=True).start()
        return lambda: self._leave(key, end)

    def _leave(self, key: object, end: Callable[[], None]) -> None:
        with self._changed:
            if self._watchers.pop(key, None) is None:
                return
            self._changed.notify_all()
        end()

    def _look(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: not self._watchers, PERIOD)
                if not self._watchers:
                    return
                watched = set(self._watchers.values())
            for refresh in watched:
                try:
                    refresh()
                except Exception:  # looks again in a while
                    log.exception("a look at the master failed")
