# SPDX-License-Identifier: GPL-3.0-or-later
"""mesofit with its page, for tests: start it, ask it, compare folders."""
import http.client
import json
import os
import re
import shutil
import subprocess
import threading

SOURCES = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
PROGRAM = os.environ.get("MESOFIT", os.path.join(SOURCES, "build", "mesofit"))

# A fluid that is quick to simulate, with everything that has a panel.
SCENE = {
    "seed": 3, "box": [6, 6, 6], "particles": {"types": {"A": 300, "B": 348}}, "temperature": 1, "time_step": 0.02,
    "conservative": {"A-A": {"law": "soft-repulsion", "a": 25}, "A-B": {"law": "soft-repulsion", "a": 40},
                     "B-B": {"law": "soft-repulsion", "a": 25}},
    "dissipative": {"law": "power", "sigma": 3},
    "motion": {"every": 5, "lags": 40, "origin_every": 5},
    "measure": {"equilibration": 200, "samples": 60, "every": 20},
}

# Eight dumbbells of two types, whose bonds are long.
DUMBBELLS = {
    "seed": 3, "dimensions": 2, "box": [12, 12], "temperature": 0.1, "time_step": 0.01,
    "bonds": {"long": {"law": "harmonic", "k": 100, "length": 3}},
    "molecules": {"dumbbell": {"count": 8, "beads": ["A", "B"], "bonds": {"long": [[1, 2]]}}},
    "conservative": {key: {"law": "soft-repulsion", "a": 25} for key in ("A-A", "A-B", "B-B")},
    "dissipative": {"law": "power", "sigma": 3},
    "measure": {"equilibration": 100000, "samples": 10, "every": 10},
}


def water_fit(iterations):
    """Water by inverse Monte Carlo, a little of it."""
    with open(os.path.join(SOURCES, "runs", "spc-water-imc", "run.json"), encoding="utf-8") as file:
        run = json.load(file)
    run["target"]["rdf"]["file"] = "target.txt"
    run["method"].update(particles=512, replicas=4, samples=10, equilibration=40, iterations=iterations, precision=0.0001)
    run["verification"] = {"replicas": 2, "equilibration": 100, "samples": 20, "every": 10}
    return run


def make_folder(folder):
    """A working folder with a scene, a run file and its target."""
    shutil.copy(os.path.join(SOURCES, "targets", "spc-water", "spc298_rdf_com_1.0nm_100.txt"),
                os.path.join(folder, "target.txt"))
    for name, value in (("scene.json", SCENE), ("dumbbells.json", DUMBBELLS), ("run.json", water_fit(3))):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            json.dump(value, file, indent=1)


class Served:
    """The program with a page, until `end`."""

    def __init__(self, folder, *words):
        self.process = subprocess.Popen([PROGRAM, *words], cwd=folder, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        line = self.process.stdout.readline().strip()
        found = re.fullmatch(r"live at (http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{32}))", line)
        if not found:
            self.process.kill()
            raise AssertionError(f"no address: {line!r} {self.process.stderr.read()!r}")
        self.address, self.port, self.token = found[1], int(found[2]), found[3]
        self.said = []
        self.reader = threading.Thread(target=lambda: self.said.extend(self.process.stderr), daemon=True)
        self.reader.start()

    def ask(self, path, body=None):
        """The code and the bytes of an answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        connection.request("GET" if body is None else "POST", path, body, {"X-Mesofit-Token": self.token})
        answer = connection.getresponse()
        result = answer.status, answer.read()
        connection.close()
        return result

    def wish(self, **what):
        return self.ask("/api/wish", json.dumps(what))

    def state(self):
        return json.loads(self.ask("/api/state")[1])

    def wait(self, seconds=600):
        code = self.process.wait(seconds)
        self.reader.join(5)
        return code

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
        code = self.wait()
        self.process.stdout.close()
        self.process.stderr.close()
        return code


def run_plain(folder, *words):
    return subprocess.run([PROGRAM, *words], cwd=folder, capture_output=True, text=True, check=False).returncode


def differences(one, other):
    """Names of tables and settings that are not the same bytes; seconds are nobody's."""
    def files(folder):
        return {name for name in os.listdir(folder) if name.endswith((".tsv", ".pot", ".json"))} - {"timing.tsv", "tasks.tsv"}

    def contents(folder, name):
        with open(os.path.join(folder, name), "rb") as file:
            data = file.read()
        if name == "summary.json":
            data = re.sub(rb'"(seconds|steps_per_second)":\s*[^,\n]*', b"", data)
        return data

    names = files(one) | files(other)
    return sorted(name for name in names if name not in files(one) or name not in files(other)
                  or contents(one, name) != contents(other, name))
