"""The listings of the paper, started as users start them."""

from examples_fixture import ExampleTest


class PaperExamples(ExampleTest):
    def told(self, name):
        """Lines of an example's own: actionlib logs as well."""
        return [line for line in self.run_example(f"paper/{name}.py").splitlines() if not line.startswith("[")]

    def test_green_eyes(self):
        lines = self.told("green_eyes")
        self.assertEqual(lines[0], "half: 0.5")
        self.assertEqual((len(lines[1].split()), lines[2]), (17, "back: as before"))
        self.assertEqual([self.robot.led(f"Face/Led/{part}/Left/0Deg") for part in ("Red", "Green", "Blue")], [0, 1, 0])

    def test_linked_functions(self):
        self.robot.module("ALMotion").wakeUp()
        self.assertEqual(self.told("linked_functions")[-2:], ["three goals: done", "one goal: done"])
        self.assertAlmostEqual(self.angle("RElbowRoll"), 0.4, delta=0.05)

    def test_animation(self):
        self.robot.module("ALMotion").wakeUp()
        told = self.told("animation")
        self.assertIn("setPose: done", told)
        rows = [line.split() for line in told if "is at" in line]
        self.assertEqual(len(rows), 6)
        for name, _, wanted, _, _, reached in rows:
            self.assertAlmostEqual(float(reached), float(wanted), delta=0.05, msg=name)

    def test_several_servers(self):
        self.robot.module("ALMotion").wakeUp()
        self.assertEqual(self.told("several_servers")[-3:], ["motion: done", "audio_out: done", "lights: done"])
        self.assertAlmostEqual(self.angle("HeadYaw"), 0.3, delta=0.05)
