# SPDX-License-Identifier: GPL-3.0-or-later
"""The particles that the page draws: places and energies of a run that is held."""
import struct
import tempfile
import time
import unittest

from served import SCENE, Served, make_folder

HEAD, COUNTS, POLARITY, ENERGY, POTENTIAL = 64, 32, 1, 2, 4
REPULSION = {key: law["a"] for key, law in SCENE["conservative"].items()}


def read(frame):
    """Parts, box, numbers of the types, places, energies and bonds of a frame (live/live_particles.h)."""
    name, count, _, parts, types, bonds = struct.unpack_from("=4s5I", frame)
    assert name == b"MFP1"
    box = struct.unpack_from("=3f", frame, 40)
    counts = struct.unpack_from("=8I", frame, HEAD)[:types]
    at = HEAD + COUNTS
    places = struct.unpack_from(f"={3 * count}f", frame, at)
    at += 16 * count + (8 * count if parts & POLARITY else 0)
    energies = struct.unpack_from(f"={count}f", frame, at) if parts & ENERGY else None
    at += 4 * count if parts & ENERGY else 0
    bonded = struct.unpack_from(f"={2 * bonds}I", frame, at)
    assert len(frame) == at + 8 * bonds + 8 * 16
    names = [name.rstrip(b"\0") for name in struct.unpack("16s" * types, frame[-8 * 16:][:16 * types])]
    assert names == [b"A", b"B"], names
    return parts, box, counts, [places[3 * k:3 * k + 3] for k in range(count)], energies, list(zip(bonded[::2], bonded[1::2]))


def sum_pairs(box, counts, places):
    """Half of a (1 - r)^2 / 2 of each pair nearer than 1, the repulsion of Groot and Warren, by all pairs."""
    kinds = [kind for kind, number in zip("AB", counts) for _ in range(number)]
    energies = [0.0] * len(places)
    for i, one in enumerate(places):
        for j in range(i):
            square = 0.0
            for d in range(3):
                x = one[d] - places[j][d]
                x -= box[d] * round(x / box[d])
                square += x * x
            if square < 1:
                half = 0.25 * REPULSION["-".join(sorted((kinds[i], kinds[j])))] * (1 - square ** 0.5) ** 2
                energies[i] += half
                energies[j] += half
    return energies


class Held(unittest.TestCase):
    """A run of a scene, paused."""
    SCENE = "scene.json"

    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        make_folder(self.place.name)
        self.served = Served(self.place.name, "live", self.SCENE, "-o", "out", "--start", "--quiet", "--stay")
        self.served.wish(wish="speed", speed=100)
        time.sleep(0.5)
        self.served.wish(wish="pause")
        self.wait_for(lambda: self.served.state()["phase"] == "paused")

    def tearDown(self):
        self.served.end()
        self.place.cleanup()

    def wait_for(self, test, seconds=30):
        until = time.time() + seconds
        while not (found := test()):
            self.assertLess(time.time(), until)
            time.sleep(0.05)
        return found

    def frame(self, query=""):
        return self.served.ask("/api/particles" + query)[1]


class Particles(Held):
    def test_energies_come_for_who_asks_while_the_run_is_held(self):
        first = read(self.wait_for(self.frame))
        self.assertEqual(first[0], POTENTIAL)
        self.assertIsNone(first[4])
        self.assertEqual(first[5], [])
        asked = self.wait_for(lambda: (lambda got: got if got[0] & ENERGY else None)(read(self.frame("?energies=1"))))
        self.assertEqual(asked[:4], (POTENTIAL | ENERGY, *first[1:4]))
        for told, summed in zip(asked[4], sum_pairs(*asked[1:4])):
            self.assertAlmostEqual(told, summed, delta=1e-3)
        self.assertGreater(sum(asked[4]) / len(asked[4]), 1)
        # Once nobody asks for them any more, the next step has none.
        time.sleep(1.2)
        self.wait_for(self.frame)
        self.served.wish(wish="step", steps=1)
        self.wait_for(lambda: read(self.frame())[3] != first[3])
        self.assertEqual(read(self.frame())[0], POTENTIAL)


class Dumbbells(Held):
    SCENE = "dumbbells.json"

    def test_bonds_come_with_each_frame(self):
        bonds = [(k, 8 + k) for k in range(8)]
        self.assertEqual(read(self.wait_for(self.frame))[5], bonds)
        asked = self.wait_for(lambda: (lambda got: got if got[0] & ENERGY else None)(read(self.frame("?energies=1"))))
        self.assertEqual(asked[5], bonds)


if __name__ == "__main__":
    unittest.main(verbosity=2)
