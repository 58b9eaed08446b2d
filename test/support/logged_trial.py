"""A trial with many answers, whose log and table are compared with what was played."""

from __future__ import annotations

import random

from played_study import Trial

from nao_library_modules.studies.study_table import table_of
from nao_library_modules.studies.trial_log import TrialState, read_events

ROUNDS = 4
CHOICES = ("red", "green", "blue")
PROTOCOL = f"""\
name: colours
phases:
  - phase: Task
    steps:
      - repeat: {ROUNDS}
        as: i
        steps:
          - say: "Round {{i}}"
          - {{wizard: "Which colour?", choices: [{", ".join(CHOICES)}], label: colour}}
          - {{wait: touch, sensors: [head], label: head}}
"""


class LoggedTrial(Trial):
    """Plays a round after the other, and keeps what it plays."""

    def __init__(self, folder, seed):
        super().__init__(folder, text=PROTOCOL)
        self._random = random.Random(seed)
        self.played: list[tuple[str, str, float]] = []  # path, answer, reaction time in s
        self._seen = 0

    def begin(self, participant="P01"):
        super().begin(participant)
        self.robot.events.subscribe(lambda _: setattr(self.robot, "time", round(self.robot.time + 0.01, 3)))
        return self

    def acts(self):
        """What the wizard and the participant do, a function each."""
        for number in range(1, ROUNDS + 1):
            yield lambda number=number: self._choose(f"1.1.r{number}.2")
            yield lambda number=number: self._touch(f"1.1.r{number}.3")

    def _choose(self, path):
        choice = self._random.choice(CHOICES)
        began = self.at(path).runner.outcome.began
        self.robot.time = round(self.robot.time + self._random.random(), 3)
        self.played.append((path, choice, round(self.robot.time - began, 4)))
        self.runner.choose(choice, "ann")
        self.until(lambda: any(each.path == path and each.ended for each in self.runner.state.outcomes))

    def _touch(self, path):
        seconds = round(self._random.random(), 3)
        self.at(path)
        self.played.append((path, "front head", seconds))
        self.touch(seconds)

    def compare(self):
        """Whatever happened to the disk: the log is whole, and the table tells what was played."""
        folder = self.files.trial(self.runner.id)
        events = read_events(folder.path)
        assert [event["n"] for event in events] == list(range(1, len(events) + 1))
        stamps = [event["stamp"] for event in events if event["kind"] == "trial"]
        assert stamps == sorted(stamps), "each event has the time when it happened"
        table = table_of(self.files, "colours")
        rows = [row for row in table.rows if row["kind"] != "say"]
        found = [(row["path"], row["answer"], row["reaction_s"]) for row in rows if row["kind"] in ("wizard", "touch")]
        assert found == self.played
        assert {row["outcome"] for row in table.rows} == {"done"}
        assert (folder.state().status, table.gaps) == ("finished", ())
        assert TrialState.of(events) == self.runner.state
        return events
