# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of a simulation on the page are those of its tables, in the units of its file."""
import http.client
import json
import os
import tempfile
import threading
import unittest

from served import Served

# Beads of water in nm and ps; ABOBA keeps the temperature in the middle of its step.
SCENE = {
    "units": "nm-ps", "seed": 3, "box": [2.79, 2.79, 2.79], "particles": {"count": 648, "mass": 18.0154},
    "temperature": 298, "time_step": 0.02, "dynamics": {"integrator": "aboba"},
    "conservative": {"law": "soft-repulsion", "a": 133, "cutoff": 0.465},
    "dissipative": {"law": "power", "sigma": 11, "cutoff": 0.465},
    "measure": {"equilibration": 200, "samples": 60, "every": 20},
}
# Name on the page, in the table, its unit.
NAMES = (("step", "step", ""), ("time", "time", "ps"), ("temperature", "temperature", "K"),
         ("potential energy of a bead", "potential_energy", "kJ/mol"), ("pressure", "pressure", "bar"),
         ("configurational temperature", "temperature_configurational", "K"))


class Numbers(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        with open(os.path.join(self.place.name, "scene.json"), "w", encoding="utf-8") as file:
            json.dump(SCENE, file)
        self.served = Served(self.place.name, "live", "scene.json", "-o", "seen", "--stay", "--quiet")
        self.told, self.changed = {}, threading.Condition()
        threading.Thread(target=self.listen, daemon=True).start()

    def tearDown(self):
        self.served.end()
        self.place.cleanup()

    def listen(self):
        """Keep the newest event of each kind."""
        connection = http.client.HTTPConnection("127.0.0.1", self.served.port, timeout=60)
        connection.request("GET", "/api/events", headers={"X-Mesofit-Token": self.served.token})
        name, lines = "", []
        for line in connection.getresponse():
            text = line.decode().rstrip("\n")
            if text.startswith("event: "):
                name = text[7:]
            elif text.startswith("data: "):
                lines.append(text[6:])
            elif name and not text:
                with self.changed:
                    self.told[name] = "\n".join(lines)
                    self.changed.notify_all()
                name, lines = "", []
        connection.close()

    def wait(self, name, test):
        with self.changed:
            self.assertTrue(self.changed.wait_for(lambda: name in self.told and test(json.loads(self.told[name])), 60))
            return json.loads(self.told[name])

    def test_last_numbers_are_the_last_row_of_the_table(self):
        self.wait("state", lambda state: state["phase"] == "ready")
        self.assertEqual(self.served.ask("/api/start", b"")[0], 200)
        self.wait("state", lambda state: state["phase"] == "ended")
        steps = SCENE["measure"]["equilibration"] + SCENE["measure"]["samples"] * SCENE["measure"]["every"]
        numbers = self.wait("numbers", lambda numbers: numbers["step"]["value"] == steps)
        with open(os.path.join(self.place.name, "seen", "thermodynamics.tsv"), encoding="utf-8") as file:
            lines = file.read().splitlines()
        head = [name.partition("[")[0] for name in lines[0][2:].split("\t")]
        row = dict(zip(head, map(float, lines[-1].split("\t"))))
        for shown, written, unit in NAMES:
            self.assertEqual(numbers[shown]["unit"], unit)
            self.assertAlmostEqual(numbers[shown]["value"] / row[written], 1, 6, shown)

    def test_time_that_is_left_knows_of_the_slider(self):
        self.wait("state", lambda state: state["phase"] == "ready")
        self.served.wish(wish="speed", speed=400)
        self.served.ask("/api/start", b"")
        self.wait("progress", lambda progress: progress["rate"] > 100)
        self.served.wish(wish="speed", speed=20)
        told = self.wait("progress", lambda progress: progress["rate"] == 20)
        self.assertAlmostEqual(told["left"], (told["total"] - told["done"]) / 20)


if __name__ == "__main__":
    unittest.main()
