# SPDX-License-Identifier: GPL-3.0-or-later
"""Who looks changes nothing: folders with and without a page are the same bytes."""
import http.client
import json
import os
import tempfile
import threading
import time
import unittest

from served import Served, differences, make_folder, run_plain


class Looker:
    """Reads events and asks for particles, as a page does, until the program has gone."""

    def __init__(self, served):
        self.served, self.events, self.frames = served, 0, 0
        self.threads = [threading.Thread(target=act, daemon=True) for act in (self.read, self.draw)]
        for thread in self.threads:
            thread.start()

    def read(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.served.port, timeout=60)
        try:
            connection.request("GET", "/api/events", headers={"X-Mesofit-Token": self.served.token})
            answer = connection.getresponse()
            while line := answer.readline():
                self.events += line.startswith(b"event: ")
        except OSError:
            pass
        connection.close()

    def draw(self):
        while self.served.process.poll() is None:
            try:
                self.frames += len(self.served.ask("/api/particles")[1]) > 64
            except (OSError, http.client.HTTPException):
                return
            time.sleep(0.02)


class SameBits(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = self.place.name
        make_folder(self.folder)

    def tearDown(self):
        self.place.cleanup()

    def check(self, one, other):
        self.assertEqual(differences(os.path.join(self.folder, one), os.path.join(self.folder, other)), [])

    def wait_for(self, served, phase):
        for _ in range(600):
            if served.process.poll() is not None or served.state()["phase"] == phase:
                return
            time.sleep(0.05)
        self.fail(f"never {phase}")

    def test_simulation_that_is_watched_paused_and_stepped(self):
        self.assertEqual(run_plain(self.folder, "simulate", "scene.json", "-o", "plain"), 0)
        served = Served(self.folder, "simulate", "scene.json", "-o", "watched", "--live", "--quiet")
        looker = Looker(served)
        served.wish(wish="speed", speed=300)
        time.sleep(0.5)
        self.assertEqual(served.wish(wish="pause")[0], 200)
        self.wait_for(served, "paused")
        for _ in range(5):
            served.wish(wish="step", steps=3)
            time.sleep(0.1)
        served.wish(wish="speed", speed=0)
        served.wish(wish="go")
        self.assertEqual(served.wait(), 0)
        self.assertGreater(looker.events, 5)
        self.assertGreater(looker.frames, 5)
        served.end()
        self.check("plain", "watched")

    def test_fit_that_is_watched_and_paused(self):
        self.assertIn(run_plain(self.folder, "fit", "run.json", "-o", "plain", "--threads", "2"), (0, 1))
        served = Served(self.folder, "live", "run.json", "-o", "watched", "--start", "--threads", "2")
        looker = Looker(served)
        time.sleep(1)
        served.wish(wish="pause")
        time.sleep(1)
        served.wish(wish="go")
        self.assertIn(served.wait(), (0, 1))
        self.assertGreater(looker.events, 3)
        served.end()
        self.check("plain", "watched")

    def test_fit_that_is_stopped_and_goes_on(self):
        self.assertIn(run_plain(self.folder, "fit", "run.json", "-o", "plain"), (0, 1))
        served = Served(self.folder, "live", "run.json", "-o", "stopped", "--start", "--stay")
        for _ in range(600):
            if os.path.exists(os.path.join(self.folder, "stopped", "potential.tsv")):
                break
            time.sleep(0.05)
        served.wish(wish="stop")
        self.wait_for(served, "stopped")
        self.assertEqual(served.ask("/api/start?resume=1", "")[0], 200)
        self.wait_for(served, "ended")
        served.end()
        self.assertIn("mesofit: interrupted after ", "".join(served.said))  # the terminal hears of it, too
        self.check("plain", "stopped")

    def test_refusal_is_the_programs_own(self):
        served = Served(self.folder, "live", "scene.json")
        with open(os.path.join(self.folder, "scene.json"), encoding="utf-8") as file:
            scene = json.load(file)
        scene["temperature"] = -1
        served.ask("/api/start", json.dumps(scene))
        self.wait_for(served, "refused")
        self.assertIn("scene.json: temperature: ", served.state()["message"])
        self.assertEqual(served.end(), 0)


if __name__ == "__main__":
    unittest.main()
