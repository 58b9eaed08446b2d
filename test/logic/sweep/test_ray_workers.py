"""Who makes the runs of a sweep when workers and computers are lost, or come later."""

from __future__ import annotations

import os
import re
import sys
import threading
from contextlib import redirect_stdout
from types import SimpleNamespace

import pytest
from fake_ray import FakeRay

from nao_sim_bridge.sweep import NoWorkers, progress, ray_start, ray_workers, sweep


def doubled(seed):
    """A run that says nothing of who makes it."""
    return 2 * seed


@pytest.fixture
def clock(monkeypatch):
    """Each look at the time is 3 s later."""
    now = [0.0]

    def monotonic():
        now[0] += 3.0
        return now[0]

    monkeypatch.setattr(ray_workers, "LOOK_PERIOD", 0.0)
    for module in (ray_start, ray_workers, progress):
        monkeypatch.setattr(module.time, "monotonic", monotonic)


@pytest.fixture
def run(monkeypatch, clock):
    """Sweep on a fake Ray: its rows."""

    def run(ray, function=doubled, seeds=8, **options):
        monkeypatch.setitem(sys.modules, "ray", ray)
        return sweep(function, seeds, progress=False, **options).rows

    return run


def test_without_ray_workers_are_refused_with_how_to_get_it(run):
    with pytest.raises(ImportError, match=r"workers need Ray: pip install .*workers=0"):
        run(None, workers=2)


def test_the_run_of_a_lost_computer_goes_to_another_worker_and_is_reported_in_one_line(run, capsys):
    ray = FakeRay(first=1, second=1)

    def lose_in_a_run(seed):
        if seed == 5 and ray.places["second"]:
            ray.lose("second")
        return doubled(seed)

    rows = run(ray, lose_in_a_run)
    assert [(row["seed"], row["result"], row["error"]) for row in rows] == [(seed, 2 * seed, "") for seed in range(8)]
    (told,) = capsys.readouterr().err.splitlines()
    assert re.fullmatch(
        r"sweep: lost a worker on second, 1 worker left; its run \(seed \d\) starts again \(1 of 3\): "
        "RayError: with second",
        told,
    )


def test_the_last_run_goes_to_the_worker_that_is_idle(run):
    ray = FakeRay(first=1, second=1)
    wait = ray.wait

    def wait_and_lose(futures, num_returns, timeout):
        """The computer whose worker alone has a run is lost, once."""
        working = [future for future in futures if future.actor.computer]
        if len(ray.calls) > 6 and [future.method for future in working] == ["run"] and all(ray.places.values()):
            ray.lose(working[0].actor.computer)
        return wait(futures, num_returns, timeout)

    ray.wait = wait_and_lose
    assert [row["result"] for row in run(ray, seeds=6)] == [2 * seed for seed in range(6)]
    assert not all(ray.places.values())


@pytest.mark.parametrize("moment", range(14))
def test_rows_are_all_there_in_order_whenever_a_computer_is_lost(run, moment):
    ray = FakeRay(first=1, second=2)
    ray.events[moment] = lambda: ray.lose("second")
    assert [row["result"] for row in run(ray)] == [2 * seed for seed in range(8)]


def test_a_computer_that_joins_later_makes_runs(run):
    ray = FakeRay(first=1)
    ray.events[4] = lambda: ray.places.update(second=1)
    run(ray)
    assert ("second", "run") in ray.calls


def test_a_run_that_takes_its_worker_along_each_time_is_a_row_with_the_reason(run, capsys):
    begun = []

    def deadly(seed):
        begun.append(seed)
        if seed == 1:
            raise SystemExit(1)
        return seed

    rows = run(FakeRay(first=2), deadly, 3)
    assert [row["error"] for row in rows] == ["", "lost 4 workers, the last one with RayError: the worker has died", ""]
    *lost, failed = capsys.readouterr().err.splitlines()
    assert begun.count(1) == 4 == len(lost) and "(seed 1)" in failed


def test_a_lost_computer_with_many_idle_workers_costs_no_run(run):
    ray = FakeRay(first=2, second=6)
    ray.events[12] = lambda: ray.lose("second")
    assert not any(row["error"] for row in run(ray, seeds=9))


def test_runs_without_a_place_are_reported_once_and_made_when_there_is_one(run, capsys):
    ray = FakeRay(first=0)
    ray.events[40] = lambda: ray.places.update(first=1)
    assert [row["result"] for row in run(ray, seeds=3)] == [0, 2, 4]
    (told,) = capsys.readouterr().err.splitlines()
    assert told.startswith(
        "sweep: 3 runs left and no worker yet: each waits for 1 processor, on 1 computer of the cluster"
    )


def test_workers_that_never_start_end_the_sweep_with_their_reason(run):
    ray = FakeRay(first=1)
    ray.broken.add("first")
    with pytest.raises(NoWorkers, match=r"no worker starts \(4 attempts\): RayError: with first"):
        run(ray)


def test_a_computer_where_no_worker_starts_leaves_the_runs_to_the_others(run):
    ray = FakeRay(first=1, second=1)
    ray.broken.add("second")
    assert not any(row["error"] for row in run(ray))


def test_no_more_workers_are_asked_for_than_are_wanted(run):
    ray = FakeRay(first=8)
    run(ray, workers=2)
    assert len(ray.actors) == 2


def test_no_worker_is_left_and_those_that_are_there_are_closed(run):
    ray = FakeRay(first=2)
    run(ray, seeds=3)
    there = [actor for actor in ray.actors if actor.computer]
    assert there and all(actor.lost for actor in ray.actors if not actor.computer)


def test_where_there_is_no_terminal_the_progress_is_lines(monkeypatch, clock, capsys):
    monkeypatch.setitem(sys.modules, "ray", FakeRay(first=1))
    sweep(doubled, 20)
    *lines, last = capsys.readouterr().err.splitlines()
    assert all(
        re.fullmatch(r"sweep: \d+ of 20 runs, (0 workers|1 worker)(, about \d+ min left)?", line) for line in lines
    )
    assert 3 < len(lines) < 20 and last == "sweep: 20 of 20 runs"


def test_rays_own_reports_stay_out_of_standard_output(capsys):
    with redirect_stdout(ray_start._WithoutRay(sys.stdout)):
        for name in (ray_start.RAYS_REPORTER, "another"):
            thread = threading.Thread(target=print, args=(f"printed by {name}",), name=name)
            thread.start()
            thread.join()
    assert capsys.readouterr().out == "printed by another\n"


@pytest.fixture
def slow(monkeypatch):
    """A Ray that is not there yet, and whose node is found at the look of the number that `late` has."""
    ray, services = FakeRay(first=1), SimpleNamespace(late=1, looks=0, seen={})

    def get_node():
        services.looks += 1
        if services.looks < services.late:
            raise RuntimeError("no such node")

    def starting():
        services.seen = {name: os.environ.get(name) for name in ray_start.PATIENCE}
        try:
            services.get_node()
        except RuntimeError:
            raise Exception("node\ntimed out") from None  # as Ray does

    services.get_node, ray.initialized, ray.starting = get_node, False, starting
    monkeypatch.setitem(sys.modules, "ray._private.services", services)
    monkeypatch.setattr(ray_start, "PAUSE", 0.0)
    monkeypatch.setenv("RAY_worker_niceness", "7")
    return ray, services


def test_a_ray_that_starts_slowly_is_waited_for_and_its_workers_get_time(run, slow, monkeypatch):
    ray, services = slow
    monkeypatch.setattr(ray_start, "START_LIMIT", 600.0)  # of the clock: 3 s a look
    services.late = 100
    assert [row["result"] for row in run(ray, seeds=3)] == [0, 2, 4] and services.looks == 100
    assert services.seen == {**ray_start.PATIENCE, "RAY_worker_niceness": "7"}  # that of the user
    assert not ray.initialized and services.get_node.__name__ == "get_node"
    assert "RAY_worker_register_timeout_seconds" not in os.environ


def test_a_ray_that_does_not_start_ends_the_sweep_with_its_reason(run, slow):
    ray, services = slow
    services.late = 10**6
    with pytest.raises(NoWorkers, match="Ray does not start on this computer: Exception: timed out"):
        run(ray)
    assert services.get_node.__name__ == "get_node"
