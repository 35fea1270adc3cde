# SPDX-License-Identifier: GPL-3.0-or-later
"""A fit that is watched and steered in the browser, and a film of a simulation."""
import base64
import glob
import json
import os
import time
import unittest

from page import Keys, PageTest
from served import run_plain, water_fit

FLUID = {"box": [3, 3, 3], "particles": {"count": 81}, "time_step": 0.02, "dissipative": {"law": "power", "sigma": 3}}


class Steering(PageTest):
    def write(self, name, content):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            json.dump(content, file)

    def test_damping_of_a_fit_is_changed(self):
        self.write("run.json", water_fit(8))  # so many that a slow browser changes it before the last
        self.begin("live", "run.json", "--stay")
        self.press("start")
        damping = self.at("change-damping")
        self.wait(lambda: damping.get_attribute("placeholder") == "1")
        self.assertFalse(self.at("change-temperature").is_displayed())
        damping.send_keys("0.5", Keys.ENTER)
        self.wait(lambda: "next iteration" in self.text("message"))
        self.wait(lambda: damping.get_attribute("placeholder") == "0.5")
        self.shoot("damping")
        self.wait(lambda: self.phase() == "ended")
        self.assertFalse(self.at("change").is_displayed())
        with open(os.path.join(self.folder, "out", "summary.json"), encoding="utf-8") as file:
            self.assertEqual([c["damping"] for c in json.load(file)["changed"]], [0.5])
        self.check_console()

    def candidate(self, name):
        """Title of the axis, and curves by their names, of a panel of the candidate; None before there is one."""
        return self.browser.execute_script(
            "const canvas = document.querySelector(`[data-candidate='${arguments[0]}'] canvas`), chart = canvas && Chart.getChart(canvas);"
            "return chart ? [chart.options.scales.y.title.text, Object.fromEntries(chart.data.datasets.map((s) => [s.label, s.data])),"
            "canvas.closest('figure').querySelector('p').textContent] : null", name)

    def test_candidate_is_shown_with_what_it_gives(self):
        """A candidate is what its curves say of it. There are generations enough for a slow browser to pause."""
        self.write("fluid.json", {**FLUID, "seed": 5, "conservative": {"law": "soft-repulsion", "a": 25}, "rdf": {"range": 1, "bins": 20}})
        self.assertEqual(run_plain(self.folder, "simulate", "fluid.json", "-o", "fluid"), 0)
        for method in ("genetic", "cma-es"):
            with self.subTest(method):
                self.check_candidate(method)
                self.browser.quit()
                self.served.end()

    def check_candidate(self, method):
        self.write("bred.json", {
            "seed": 3, "scene": FLUID, "target": {"rdf": {"file": "fluid/rdf.tsv"}},
            "unknowns": {"potential": {"coefficients": 4, "maximum": 30}},
            "method": {"name": method, "population": 8, "generations" if method == "genetic" else "rounds": 6, "equilibration": 100, "samples": 200, "every": 30,
                       "temperature_tolerance": 0.5},
            "verification": {"replicas": 2, "equilibration": 20, "samples": 5, "every": 8}})
        self.begin("live", "bred.json", "-o", method, "--force", "--stay")
        self.press("start")
        self.wait(lambda: self.candidate("rdf"))
        self.press("pause")
        self.wait(lambda: self.phase() == "paused")
        axis, curves, text = self.candidate("potential")
        self.assertIn("Φ", axis)
        self.assertRegex(text, r"^Candidate [1-8] of this iteration: (fitness F = 0?\.?\d[\d.e-]*|it failed); T = [01]\.\d+ \[T_0\]\.$")
        self.assertAlmostEqual(curves["candidate"][-1]["y"], 0)
        self.assertGreater(len(curves["candidate"]), 10)
        _, curves, _ = self.candidate("rdf")
        with open(os.path.join(self.folder, "fluid", "rdf.tsv"), encoding="utf-8") as lines:
            target = [float(line.split()[1]) for line in lines if not line.startswith("#")]
        for known, point in zip(target, curves["target"]):
            self.assertAlmostEqual(known, point["y"], 3)
        # F is the rms of what is drawn.
        squares = [(one["y"] - other["y"]) ** 2 for one, other in zip(curves["candidate"], curves["target"])]
        if "F = " in text:
            self.assertAlmostEqual(float(text.split("F = ")[1].split(";")[0]) / (sum(squares) / len(squares)) ** 0.5, 1, 2)
        self.browser.execute_script("document.querySelector('[data-candidate=rdf]').scrollIntoView({ block: 'center' })")
        self.shoot("candidate")
        self.press("resume")
        self.wait(lambda: self.phase() == "ended")
        self.check_console()

    def test_film_of_the_particles(self):
        """What was recorded is a film that the browser plays, with particles of two colours in it."""
        self.begin("live", "scene.json", "-o", "seen", "--stay")
        self.served.wish(wish="speed", speed=50)
        self.press("start")
        self.wait(lambda: "step" in self.text("frames"))
        self.press("record")
        self.wait(lambda: self.text("record") == "Stop recording")
        time.sleep(3)
        self.press("record")
        film = self.wait(lambda: next(iter(glob.glob(os.path.join(self.downloads, "*.webm"))), None))
        self.assertEqual(self.text("record"), "Record")
        self.assertEqual(os.path.basename(film), "scene.webm")
        with open(film, "rb") as file:
            content = file.read()
        shown = [int(self.at("particles").get_attribute(name)) for name in ("width", "height")]
        self.check_console()
        self.browser.switch_to.new_window("tab") # the page itself may play nothing
        width, height, blue, red = self.browser.execute_async_script("""
            const [text, done] = arguments, bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
            const video = Object.assign(document.createElement("video"), { muted: true, src: URL.createObjectURL(new Blob([bytes], { type: "video/webm" })) });
            video.onerror = () => done([0, 0, 0, 0]);
            video.play();
            video.ontimeupdate = () => {
                if (video.currentTime < 1)
                    return;
                video.pause();
                const [width, height] = [video.videoWidth, video.videoHeight], canvas = Object.assign(document.createElement("canvas"), { width, height });
                canvas.getContext("2d").drawImage(video, 0, 0);
                const data = canvas.getContext("2d").getImageData(0, 0, width, height).data;
                let blue = 0, red = 0;
                for (let k = 0; k < data.length; k += 4) {
                    blue += data[k + 2] > 90 && data[k + 2] > data[k] + 20;
                    red += data[k] > 90 && data[k] > data[k + 2] + 20;
                }
                done([width, height, blue, red]);
            };""", base64.b64encode(content).decode())
        self.assertLess(abs(width - shown[0]) + abs(height - shown[1]), 4) # films have even numbers of pixels
        self.assertGreater(blue, 200)
        self.assertGreater(red, 200)


if __name__ == "__main__":
    unittest.main(verbosity=2)
