# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn: colours and slices of particles, the flow of a solvent, figures; and files of one's own."""
import base64
import json
import math
import os
import re
import struct
import unittest
import zlib

from page import PageTest
from served import run_plain
from test_particles import HEAD, COUNTS

# Few beads, far from each other, so that each can be found in the picture.
LATTICE = [(1.5 + 3 * (k % 4), 1.5 + 3 * (k // 4)) for k in range(16)]
FLAT = {"seed": 4, "dimensions": 2, "box": [12, 12], "temperature": 1, "time_step": 0.001,
        "particles": {"count": 16, "placement": "file", "file": "lattice.txt"},
        "measure": {"equilibration": 0, "samples": 1000000, "every": 10}}
SPEEDING = {**FLAT, "conservative": {"law": "soft-repulsion", "a": 25}}
TURNING = {**FLAT, "interactions": {"self-propulsion": {"force": 0.01}}, "temperature": 1e-6,
           "dynamics": {"integrator": "brownian", "orientation_temperature": 0.01}}


def read_png(data):
    """Width, height and rows of red, green, blue of a PNG without interlacing."""
    width, height, depth, kind = struct.unpack_from(">IIBB", data, 16)
    assert depth == 8 and kind in (2, 6)
    size, at, packed = (3 if kind == 2 else 4), 8, b""
    while at < len(data):
        length, name = struct.unpack_from(">I4s", data, at)
        if name == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    flat, stride, rows = zlib.decompress(packed), width * size, []
    above = bytearray(stride)
    for y in range(height):
        method, line = flat[y * (stride + 1)], bytearray(flat[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            left, up, corner = (line[x - size] if x >= size else 0), above[x], (above[x - size] if x >= size else 0)
            nearest = min((abs(up - corner), 0, left), (abs(left - corner), 1, up), (abs(left + up - 2 * corner), 2, corner))[2]
            line[x] = (line[x] + (0, left, up, (left + up) // 2, nearest)[method]) % 256
        rows.append(line)
        above = line
    return width, height, lambda x, y: tuple(rows[y][size * x:size * x + 3])


class Views(PageTest):
    def write(self, name, content):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(content if isinstance(content, str) else json.dumps(content))

    def hold(self, scene):
        """Begin the scene and hold it after some steps; returns its last frame."""
        self.write("lattice.txt", "".join(f"{x} {y}\n" for x, y in LATTICE))
        self.write("flat.json", scene)
        self.begin("live", "flat.json", "-o", "seen", "--stay")
        self.served.wish(wish="speed", speed=50)
        self.press("start")
        self.wait(lambda: "step" in self.text("frames"))
        self.press("pause")
        self.wait(lambda: self.phase() == "paused")
        return self.wait(self.frame_that_is_drawn)

    def frame_that_is_drawn(self):
        """The program's last frame, once the page has drawn that one."""
        frame = self.served.ask("/api/particles")[1]
        return frame if f"step {struct.unpack_from('=d', frame, 24)[0]:.0f}," in self.text("frames") else None

    def colour(self, name):
        self.at("colour").find_element("css selector", f"option[value={name}]").click()
        self.wait(lambda: self.at("colour").get_attribute("value") == name)
        self.browser.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")

    def picture(self):
        canvas = self.at("particles")
        self.browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", canvas)
        return read_png(base64.b64decode(canvas.screenshot_as_base64))

    def beads(self, frame):
        """Colours of the beads' middles, and their places and what follows them in the frame."""
        count = struct.unpack_from("=I", frame, 4)[0]
        numbers = struct.unpack_from(f"={(len(frame) - HEAD - COUNTS) // 4}f", frame, HEAD + COUNTS)
        places = [numbers[3 * k:3 * k + 2] for k in range(count)]
        width, height, pixel = self.picture()
        # The middle of the box is the middle of the picture; a box is 0.85 of its height.
        found = [pixel(round(width / 2 + (x - 6) / 12 * 0.85 * height), round(height / 2 - (y - 6) / 12 * 0.85 * height))
                 for x, y in places]
        return found, places, numbers[3 * count:]

    def test_colours_by_speed_and_depth(self):
        frame = self.hold(SPEEDING)
        self.colour("speed")
        found, places, speeds = self.beads(frame)
        order = sorted(range(16), key=lambda k: speeds[k])
        reds, blues = ([found[k][c] for k in order] for c in (0, 2))
        self.assertGreater(reds[-1], reds[0] + 50)
        for colours in (reds, blues[::-1]): # from blue to yellow
            self.assertTrue(all(b >= a - 3 for a, b in zip(colours, colours[1:])), colours)
        self.colour("depth")
        found, places, _ = self.beads(frame)
        rows = [[red for (red, _, _), (_, y) in zip(found, places) if abs(y - level) < 1.5] for level in (1.5, 4.5, 7.5, 10.5)]
        self.assertEqual([len(row) for row in rows], [4] * 4)
        self.assertTrue(all(max(low) < min(high) for low, high in zip(rows, rows[1:])), rows)
        self.check_console()

    def test_colour_by_polarity_goes_round_with_the_direction(self):
        frame = self.hold(TURNING)
        self.colour("polarity")
        found, _, behind = self.beads(frame)
        off = []
        for k, (red, green, blue) in enumerate(found):
            # Three cosines, a third of a turn apart.
            hue = math.atan2(math.sqrt(3) * (blue - green), 2 * red - green - blue)
            direction = math.atan2(behind[16 + 2 * k + 1], behind[16 + 2 * k])
            off.append((hue - direction - math.pi + 3 * math.pi) % (2 * math.pi) - math.pi)
        self.assertLess(max(map(abs, off)), 0.1, off)
        self.check_console()

    def test_slices_show_the_layer_that_they_cut(self):
        layers = [(x + 0.5, y + 0.5, z) for z in (2, 6) for x in range(8) for y in range(8)]
        self.write("lattice.txt", "".join(f"{x} {y} {z}\n" for x, y, z in layers))
        self.write("layers.json", {"seed": 4, "box": [8, 8, 8], "temperature": 0.0001, "time_step": 0.001,
                                   "particles": {"types": {"A": 64, "B": 64}, "placement": "file", "file": "lattice.txt"},
                                   "measure": {"equilibration": 0, "samples": 1000000, "every": 10}})
        self.begin("live", "layers.json", "-o", "seen", "--stay")
        self.served.wish(wish="speed", speed=50)
        self.press("start")
        self.wait(lambda: "step" in self.text("frames"))
        self.press("pause")
        for part, at, blue, red in ((1, 0.5, True, True), (0.2, 0.26, True, False), (0.2, 0.76, False, True), (0.2, 0.5, False, False)):
            for name, value in (("slice", part), ("slice-at", at)):
                self.browser.execute_script("arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'))",
                                            self.at(name), value)
            self.browser.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")
            width, height, pixel = self.picture()
            some = [pixel(x, y) for x in range(0, width, 3) for y in range(0, height, 3)]
            self.assertEqual(sum(b > 90 and b > r + 20 for r, _, b in some) > 50, blue, (part, at))
            self.assertEqual(sum(r > 90 and r > b + 20 for r, _, b in some) > 50, red, (part, at))
        self.check_console()

    def test_flow_of_a_solvent_has_arrows_and_speeds(self):
        self.write("channel.json", {
            "seed": 1, "dimensions": 2, "box": [24, 16], "particles": {"count": 0}, "temperature": 1, "time_step": 0.1,
            "dynamics": {"integrator": "collision-dynamics", "particles_per_cell": 10, "angle": 130, "thermostat": "yes",
                         "walls": "plates", "acceleration": [0.05, 0], "obstacle_centre": [8, 8], "obstacle_radius": 3},
            "measure": {"equilibration": 500, "samples": 50, "every": 10}, "flow_field": {"spacing": 1}})
        self.assertEqual(run_plain(self.folder, "simulate", "channel.json", "-o", "channel"), 0)
        self.begin("live", "channel")
        canvas = self.wait(lambda: next(iter(self.browser.find_elements("css selector", "canvas[data-arrows]")), None))
        self.browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", canvas)
        self.assertGreater(int(canvas.get_attribute("data-arrows")), 24 * 16 * 0.8)
        with open(os.path.join(self.folder, "channel", "flow_field.tsv"), encoding="utf-8") as lines:
            rows = [[float(word) for word in line.split()] for line in lines if not line.startswith("#")]
        fastest = max((math.hypot(row[2], row[3]), row[0], row[1]) for row in rows if not math.isnan(row[2]))
        figure = canvas.find_element("xpath", "..")
        self.assertAlmostEqual(float(figure.text.split(" to ")[-1].split()[0]) / fastest[0], 1, 2)
        self.shoot("flow")
        # Between arrows the fastest cell is bright, those in the obstacle are dark. A cell has 50 pixels.
        corner = "return [...arguments[0].getContext('2d').getImageData(50 * arguments[1] + 1, 50 * (15 - arguments[2]) + 1, 1, 1).data]"
        bright = self.browser.execute_script(corner, canvas, math.floor(fastest[1]), math.floor(fastest[2]))
        inside = self.browser.execute_script(corner, canvas, 8, 8)
        self.assertGreater(bright[0], 200)
        self.assertLess(inside[0], 100)
        self.check_console()

    def test_file_of_ones_own_comes_into_the_folder_and_figures_are_shown(self):
        self.assertEqual(run_plain(self.folder, "simulate", "scene.json", "-o", "done"), 0)
        own = os.path.join(self.place.name, "own.json")
        with open(own, "w", encoding="utf-8") as file:
            json.dump({"box": [7, 7, 7]}, file)
        self.begin("live", "done")
        self.at("tab-files").click()
        self.when_there(lambda: self.at("files").find_element("css selector", "input[type=file]"), lambda chooser: chooser.send_keys(own))
        self.wait(lambda: os.path.exists(os.path.join(self.folder, "own.json")))
        with open(own, "rb") as one, open(os.path.join(self.folder, "own.json"), "rb") as other:
            self.assertEqual(one.read(), other.read())
        figures = [name for name in os.listdir(os.path.join(self.folder, "done", "figures")) if name.endswith(".png")]
        self.assertTrue(figures)
        self.click_button("done/")
        self.click_button("figures/")
        self.click_button(figures[0])
        picture = self.wait(lambda: next(iter(self.at("files").find_elements("css selector", "img.figure")), None))
        self.wait(lambda: self.browser.execute_script("return arguments[0].naturalWidth", picture) > 300)
        self.check_console()

    def look_at(self, name):
        """The text field with the contents of a file."""
        self.click_button(name)
        return self.wait(lambda: next(iter(self.at("files").find_elements("css selector", f"[aria-label='contents of {name}']")), None))

    def put(self, name, contents):
        with open(os.path.join(self.folder, name), "wb") as file:
            file.write(contents)

    def get(self, name):
        with open(os.path.join(self.folder, name), "rb") as file:
            return file.read()

    def test_texts_are_saved_as_they_were_but_for_what_was_edited(self):
        """Line ends and letters stay; what would not is shown alone, and of a long file its beginning."""
        mark, long = b"\xef\xbb\xbf", 2 << 30
        self.put("dos.txt", mark + "# r\r\n1 \u00e9\r\n".encode())
        self.put("mac.txt", b"# r\r1 2\r")
        refused = {"latin.txt": (b"caf\xe9\r\n", "caf\u00e9\n", "not UTF-8"), "mixed.txt": (b"1\r\n2\n", "1\n2\n", "lines end"),
                   "nul.dat": (b"1\0\n", "1\0\n", "NUL")}
        for name, (contents, _, _) in refused.items():
            self.put(name, contents)
        self.put("long.lammpstrj", b"ITEM: TIMESTEP\n")
        os.truncate(os.path.join(self.folder, "long.lammpstrj"), long)
        self.begin("live")
        self.at("tab-files").click()
        for name, expected in (("dos.txt", mark + "# r\r\n1 \u00e9\r\n3 4\r\n".encode()), ("mac.txt", b"# r\r1 2\r3 4\r")):
            field = self.look_at(name)
            self.browser.execute_script("arguments[0].value += '3 4\\n'", field)
            self.click_button("save " + name)
            self.wait(lambda: self.get(name) == expected)
        for name, (contents, shown, why) in refused.items():
            field = self.look_at(name)
            self.assertEqual((field.get_property("readOnly"), field.get_property("value")), (True, shown))
            self.assertIn(why, self.text("files"))
            self.assertIsNone(self.button("save " + name))
            self.assertEqual(self.get(name), contents)
        field = self.look_at("long.lammpstrj")
        self.assertTrue(field.get_property("readOnly"))
        self.assertEqual(len(field.get_property("value")), 200000)
        self.assertTrue(field.get_property("value").startswith("ITEM: TIMESTEP\n"))
        self.check_console()

    def test_rate_and_time_left_are_those_of_the_run(self):
        self.begin("live", "scene.json", "-o", "seen", "--stay")
        self.served.wish(wish="speed", speed=100)
        self.press("start")
        self.wait(lambda: "left" in self.text("progress-text"))
        self.wait(lambda: 90 < self.rate() < 110)
        self.check_console()

    def rate(self):
        """The number before "/s" in the progress, 0 without one."""
        found = re.search(r", ([\d.]+)/s", self.text("progress-text"))
        return float(found[1]) if found else 0


if __name__ == "__main__":
    unittest.main(verbosity=2)
