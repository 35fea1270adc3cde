# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a run is, in its folder, for who looks from elsewhere."""
import json
import os
import signal
import subprocess
import tempfile
import time
import unittest

from served import PROGRAM, SCENE, make_folder


class Progress(unittest.TestCase):
    def test_simulation_that_runs_tells_how_far_it_is(self):
        """Steps, rate and time left agree with each other and with what is left to do; later nothing is left behind."""
        with tempfile.TemporaryDirectory() as folder:
            make_folder(folder)
            measure = {"equilibration": 200, "samples": 1000000, "every": 20}
            with open(os.path.join(folder, "long.json"), "w", encoding="utf-8") as file:
                json.dump({**SCENE, "measure": measure}, file)
            run = subprocess.Popen([PROGRAM, "simulate", "long.json", "-o", "out", "--quiet"], cwd=folder, stderr=subprocess.DEVNULL)
            path, until = os.path.join(folder, "out", "progress.json"), time.monotonic() + 120
            while not os.path.exists(path):
                self.assertLess(time.monotonic(), until)
                time.sleep(0.2)
            with open(path, encoding="utf-8") as file:
                told = json.load(file)
            run.send_signal(signal.SIGINT)
            self.assertEqual(run.wait(120), 130)
            self.assertFalse(os.path.exists(path))
            self.assertEqual(set(told), {"done", "total", "unit", "rate", "left", "text"})
            self.assertEqual(told["total"], measure["equilibration"] + measure["samples"] * measure["every"])
            self.assertEqual(told["unit"], "steps")
            self.assertTrue(told["text"].startswith(f"step {told['done']}  T "), told)
            number, unit = told["left"].split()
            left = float(number) * {"s": 1, "min": 60, "h": 3600}[unit]
            # Two digits of the time left, rounded: 5 % at most.
            self.assertAlmostEqual(left / ((told["total"] - told["done"]) / told["rate"]), 1, delta=0.06)


if __name__ == "__main__":
    unittest.main()
