"""The study of touches, with a simulated hand: what it writes beside what the simulator knows."""

import csv
import tempfile
from pathlib import Path

from examples_fixture import ExampleTest

STRICT = 0.010
"""s between the contact of the hand and the onset that the robot tells, at most."""


class TouchStudy(ExampleTest):
    def test_reaction_times_are_from_the_end_of_the_question_to_the_contact_of_the_hand(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "study.csv"
            self.run_example("touch_study.py", "--trials", "3", "--simulated-hand", "--output", str(file))
            with file.open(encoding="utf-8") as lines:
                trials = list(csv.DictReader(lines))
        self.assertEqual([trial["problem"] for trial in trials], [""] * 3)
        for trial in trials:
            question_end, contact, onset = (float(trial[name]) for name in ("question_end", "hand_contact", "onset"))
            self.assertAlmostEqual(onset, contact, delta=STRICT)
            self.assertAlmostEqual(float(trial["reaction_s"]), onset - question_end, delta=0.002)
            self.assertGreater(onset - question_end, 0.5)  # the hand waits as long before it comes
