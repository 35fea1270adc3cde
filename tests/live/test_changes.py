# SPDX-License-Identifier: GPL-3.0-or-later
"""Temperature and time step of a simulation that runs are changed: what is measured is of what came last."""
import json
import os
import tempfile
import time
import unittest

from served import SCENE, Served, make_folder, run_plain


class Changes(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = self.place.name
        make_folder(self.folder)
        self.served = None

    def tearDown(self):
        if self.served:
            self.served.end()
        self.place.cleanup()

    def write(self, name, **more):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            json.dump({**SCENE, **more}, file)

    def summary(self, name):
        with open(os.path.join(self.folder, name, "summary.json"), encoding="utf-8") as file:
            return json.load(file)

    def table(self, name, file):
        with open(os.path.join(self.folder, name, file), encoding="utf-8") as lines:
            return [line.split("\t") for line in lines if not line.startswith("#")]

    def wait_for(self, test, seconds=60):
        until = time.time() + seconds
        while not test():
            self.assertLess(time.time(), until)
            time.sleep(0.05)

    def hold(self, scene, *words):
        """A run that is paused before its samples are over."""
        self.served = Served(self.folder, "live", scene, *words, "--start", "--quiet", "--stay")
        self.served.wish(wish="speed", speed=400)
        time.sleep(0.5)
        self.served.wish(wish="pause")
        self.wait_for(lambda: self.served.state()["phase"] == "paused")

    def finish(self):
        self.served.wish(wish="speed", speed=0)
        self.served.wish(wish="go")
        self.wait_for(lambda: self.served.state()["phase"] == "ended")

    def test_samples_are_of_the_new_temperature(self):
        self.write("scene.json")
        self.hold("scene.json", "-o", "hot")
        self.assertEqual(self.served.wish(wish="change", temperature=1.5, time_step=0.01)[0], 200)
        self.wait_for(lambda: "next step" in self.served.state()["message"])
        self.finish()
        summary = self.summary("hot")
        self.assertEqual(len(summary["changed"]), 1)
        changed = summary["changed"][0]
        self.assertEqual((changed["temperature"], changed["time_step"]), (1.5, 0.01))
        # Equilibration and samples, all of them after the change.
        measure = SCENE["measure"]
        steps = measure["equilibration"] + measure["samples"] * measure["every"]
        self.assertEqual(summary["engine_steps"], changed["step"] + steps)
        self.assertLess(abs(summary["temperature"] - 1.5), max(0.06, 4 * summary["temperature_error"]))
        rows = self.table("hot", "thermodynamics.tsv")
        self.assertEqual(len(rows), measure["samples"])
        # Without the change there is nothing to list.
        self.assertEqual(run_plain(self.folder, "simulate", "scene.json", "-o", "plain"), 0)
        self.assertNotIn("changed", self.summary("plain"))

    def test_run_that_was_stopped_goes_on_with_its_changes(self):
        """Stopped and gone on with, the folder has what a run has that was not stopped."""
        self.write("scene.json")
        for _ in range(5): # the pauses may come at different steps on a busy machine
            whole, parts = self.run_changed("whole", False), self.run_changed("parts", True)
            if whole[0] == parts[0]:
                break
        self.assertEqual(whole, parts)

    def run_changed(self, name, stops):
        """The step of the change and a table of the result."""
        self.served = Served(self.folder, "live", "scene.json", "-o", name, "--stay", "--quiet")
        self.served.wish(wish="speed", speed=1)
        self.served.ask("/api/start", "")
        self.wait_for(lambda: self.served.state()["phase"] == "running")
        time.sleep(0.3)
        self.served.wish(wish="pause")
        self.wait_for(lambda: self.served.state()["phase"] == "paused")
        self.served.wish(wish="change", temperature=0.7, time_step=0.03)
        self.wait_for(lambda: "next step" in self.served.state()["message"])
        self.served.wish(wish="speed", speed=0)
        if stops:
            self.served.wish(wish="step", steps=300)
            self.wait_for(lambda: self.served.state()["phase"] == "paused" and self.has_checkpoint(name, 300))
            self.served.wish(wish="stop")
            self.wait_for(lambda: self.served.state()["phase"] == "stopped")
            self.assertEqual(self.served.ask("/api/start?resume=1", "")[0], 200)
            self.wait_for(lambda: self.served.state()["phase"] == "ended")
        else:
            self.finish()
        self.served.end()
        self.served = None
        changed = self.summary(name)["changed"]
        return changed[0]["step"], changed, self.table(name, "rdf_A-B.tsv"), self.table(name, "motion.tsv")

    def has_checkpoint(self, name, steps):
        time.sleep(steps / 100) # so many steps take a second at most
        return os.path.exists(os.path.join(self.folder, name, "checkpoint.bin"))

    def test_what_cannot_change_is_refused_and_the_run_goes_on(self):
        self.write("scene.json")
        self.hold("scene.json", "-o", "same")
        for body, why in (({"temperature": -1}, b"temperature"), ({"time_step": "fast"}, b"time_step"), ({}, b"takes a temperature")):
            code, text = self.served.wish(wish="change", **body)
            self.assertEqual(code, 400)
            self.assertIn(why, text)
        self.finish()
        self.assertNotIn("changed", self.summary("same"))
        self.served.end()
        bare = {key: value for key, value in SCENE.items() if key != "dissipative"}
        with open(os.path.join(self.folder, "bare.json"), "w", encoding="utf-8") as file:
            json.dump(bare, file)
        self.hold("bare.json", "-o", "bare")
        self.assertEqual(self.served.wish(wish="change", temperature=2)[0], 200)
        self.wait_for(lambda: "there is no thermostat" in self.served.state()["message"])
        self.finish()
        self.assertNotIn("changed", self.summary("bare"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
