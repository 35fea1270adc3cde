# SPDX-License-Identifier: GPL-3.0-or-later
"""The damping of an inversion that runs is changed: its steps are shorter from then on, and the result says so."""
import json
import os
import tempfile
import time
import unittest

from served import Served, differences, make_folder, run_plain, water_fit

DAMPING = 0.25


class TooLate(Exception):
    """A run ended before it heard what it was to do."""


class Damping(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = self.place.name
        make_folder(self.folder)
        self.served = self.name = None
        fit = water_fit(4)
        # Few samples would be noise, by which a fit damps its steps itself; from nearer there would be no steps left.
        fit["method"].update(samples=400, start="mean-force")
        self.write("run.json", {**fit, "verification": {"replicas": 2, "equilibration": 50, "samples": 5, "every": 10}})

    def tearDown(self):
        if self.served:
            self.served.end()
        self.place.cleanup()

    def write(self, name, content):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            json.dump(content, file)

    def summary(self, name):
        with open(os.path.join(self.folder, name, "summary.json"), encoding="utf-8") as file:
            return json.load(file)

    def rows(self, name, table):
        """Numbers of a table, of which the first one is on the left of each row."""
        path = os.path.join(self.folder, name, table)
        if not os.path.exists(path):
            return []
        with open(path, encoding="utf-8") as lines:
            return [[float(word) for word in line.split()] for line in lines if not line.startswith("#")]

    def column(self, name, table, head):
        with open(os.path.join(self.folder, name, table), encoding="utf-8") as lines:
            heads = [line for line in lines if line.startswith("#")][-1][1:].split()
        return [row[heads.index(head)] for row in self.rows(name, table)]

    def wait_for(self, test, seconds=300):
        until = time.time() + seconds
        while not test():
            self.assertLess(time.time(), until)
            time.sleep(0.02)

    def wait_for_phase(self, wanted):
        """A run that has ended before the wish came has come too far."""
        self.wait_for(lambda: self.served.state()["phase"] in (wanted, "ended"))
        if self.served.state()["phase"] != wanted:
            raise TooLate

    def change(self, stops):
        self.served.wish(wish="pause")
        self.wait_for_phase("paused")
        self.assertEqual(self.served.wish(wish="change", damping=DAMPING)[0], 200)
        self.wait_for(lambda: "next iteration" in self.served.state()["message"])
        self.served.wish(wish="go")
        if stops:
            self.wait_for(lambda: len(self.rows(self.name, "history.tsv")) >= 2)
            self.served.wish(wish="stop")
            self.wait_for_phase("stopped")
            self.assertEqual(self.served.ask("/api/start?resume=1", "")[0], 200)
        self.wait_for_phase("ended")

    def run_changed(self, name, stops):
        """The result's list of changes; perhaps of a run that was stopped in a later iteration and gone on with."""
        self.name = name
        for _ in range(20): # a busy machine may bring a wish too late
            self.served = Served(self.folder, "live", "run.json", "-o", name, "--start", "--quiet", "--stay", "--force")
            try:
                self.change(stops)
                break
            except TooLate:
                pass
            finally:
                self.served.end()
                self.served = None
        return self.summary(name)["changed"]

    def test_step_is_a_part_of_what_it_would_be(self):
        changed = self.run_changed("slow", False)
        self.assertEqual([change["damping"] for change in changed], [DAMPING])
        at = int(changed[0]["iteration"])
        self.assertEqual(run_plain(self.folder, "fit", "run.json", "-o", "plain"), 1)
        self.assertNotIn("changed", self.summary("plain"))
        self.assertEqual(self.column("slow", "history.tsv", "damping[1]"), [1] * at + [DAMPING] * (4 - at))
        # Up to the change both runs are the same, and so is what the next step is made of: r, then Φ of each iteration.
        pairs = zip(self.rows("slow", "potential_history.tsv"), self.rows("plain", "potential_history.tsv"))
        parts = []
        for slow, plain in pairs:
            self.assertEqual(slow[:at + 2], plain[:at + 2])
            whole = plain[at + 2] - plain[at + 1]
            if abs(whole) > 1e-2 and plain[at + 1] < 3: # the core is hardly known
                parts.append((slow[at + 2] - slow[at + 1]) / whole)
        self.assertGreater(len(parts), 20)
        # Bins that the target hardly knows are cut one by one.
        near = [part for part in parts if abs(part / DAMPING - 1) < 1e-3]
        self.assertGreater(len(near), 0.9 * len(parts))

    def test_run_that_was_stopped_goes_on_with_it(self):
        for _ in range(20): # the pauses may come in different iterations on a busy machine
            whole, parts = self.run_changed("whole", False), self.run_changed("parts", True)
            if whole == parts:
                break
        self.assertEqual(whole, parts)
        self.assertEqual(differences(os.path.join(self.folder, "whole"), os.path.join(self.folder, "parts")), [])

    def test_what_a_run_does_not_have_is_refused(self):
        self.served = Served(self.folder, "live", "run.json", "--start", "--quiet", "--stay")
        for body, why in (({"damping": 0}, b"damping"), ({"damping": 2}, b"damping"), ({"temperature": 1}, b"takes a damping"),
                          ({}, b"takes a damping")):
            code, text = self.served.wish(wish="change", **body)
            self.assertEqual(code, 400)
            self.assertIn(why, text)
        self.served.wish(wish="stop")
        self.served.end()
        self.served = Served(self.folder, "live", "scene.json", "--start", "--quiet", "--stay")
        self.assertEqual(self.served.wish(wish="change", damping=0.5)[0], 400)


if __name__ == "__main__":
    unittest.main(verbosity=2)
