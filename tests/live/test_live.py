# SPDX-License-Identifier: GPL-3.0-or-later
"""The page in a real browser: what a person does with it."""
import glob
import json
import os
import time
import unittest
import zipfile

from page import ActionChains, Keys, PageTest
from served import differences, run_plain, water_fit


class Page(PageTest):
    def iterations(self):
        path = os.path.join(self.folder, "out", "history.tsv")
        if not os.path.exists(path):
            return 0
        with open(path, encoding="utf-8") as file:
            return sum(not line.startswith("#") for line in file)

    def test_water_from_the_page(self):
        """Begin, watch three iterations, pause, go on, stop, go on; download; the same bits again."""
        with open(os.path.join(self.folder, "run.json"), "w", encoding="utf-8") as file:
            json.dump(water_fit(6), file)
        self.begin("live", "run.json", "--stay")
        self.assertEqual(self.phase(), "ready")
        self.press("start")
        self.wait(lambda: "potential.tsv" in self.panels())
        self.press("pause")
        self.wait(lambda: self.phase() == "paused")
        held = self.iterations()
        time.sleep(2)
        self.assertEqual(self.iterations(), held)
        self.press("resume")
        self.wait(lambda: self.phase() == "running")
        self.press("stop")
        self.wait(lambda: self.phase() == "stopped")
        self.assertIn("interrupted", self.text("message"))
        self.assertIn("\"Go on\"", self.text("message"))
        self.assertNotIn("left", self.text("progress-text"))
        self.press("resume")
        self.wait(lambda: self.phase() == "ended")
        self.assertGreaterEqual(self.iterations(), 3)
        self.wait(lambda: "rdf.tsv" in self.panels())
        self.assertIn("rdf_now.tsv", self.panels())
        self.check_verdict()
        self.shoot("fit")
        self.at("tab-files").click()
        self.click_button("results")
        self.click_button("download as zip")
        found = self.wait(lambda: glob.glob(os.path.join(self.downloads, "*.zip")))
        with zipfile.ZipFile(found[0]) as archive:
            again = os.path.join(self.folder, "again.json")
            self.assertIsNone(archive.testzip())
            with open(again, "wb") as file:
                file.write(archive.read("used.json"))
        self.assertIn(run_plain(self.folder, "fit", "again.json", "-o", "again"), (0, 1))
        self.assertEqual(differences(os.path.join(self.folder, "out"), os.path.join(self.folder, "again")), [])
        self.check_console()

    def check_verdict(self):
        with open(os.path.join(self.folder, "out", "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        self.wait(lambda: self.at("verdict").is_displayed())
        self.assertTrue(self.text("verdict").startswith(summary["status"].replace("_", " ")))
        shown = float(self.text("verdict").split("target ")[1].split()[0])
        self.assertAlmostEqual(shown / summary["rdf_rmse"], 1, 2)

    def test_simulation_is_drawn_turned_and_stepped(self):
        self.begin("live", "scene.json", "-o", "seen", "--stay", dark=True)
        self.served.wish(wish="speed", speed=50)
        self.press("start")
        self.wait(lambda: "step" in self.text("frames"))
        canvas = self.at("particles")
        ActionChains(self.browser).move_to_element(canvas).click_and_hold().move_by_offset(80, 30).release().perform()
        self.wait(lambda: canvas.get_attribute("data-turn"))
        turned = canvas.get_attribute("data-turn")
        canvas.send_keys(Keys.ARROW_LEFT)
        self.wait(lambda: canvas.get_attribute("data-turn") != turned)
        self.press("pause")
        self.wait(lambda: self.phase() == "paused")
        time.sleep(0.5)
        before = self.step()
        self.press("step")
        self.wait(lambda: self.step() == before + 1)
        colours = self.at("colour")
        offered = [o.get_attribute("value") for o in colours.find_elements("tag name", "option") if o.is_enabled()]
        self.assertEqual(offered, ["type", "speed", "energy", "depth"])
        colours.send_keys("energy")
        self.browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", canvas)
        self.press("step")
        self.wait(lambda: "k_B T_0" in self.text("frames"))
        self.shoot("energy")
        colours.send_keys("type")
        self.served.wish(wish="speed", speed=0)
        self.press("resume")
        self.wait(lambda: {"rdf_A-B.tsv", "motion.tsv", "thermodynamics.tsv"} <= set(self.panels()))
        self.browser.execute_script("scrollTo(0, 0)")
        self.shoot("simulation")
        self.check_pixels(canvas)
        self.check_types(canvas)
        self.check_console()

    def step(self):
        return self.browser.execute_script(
            "const box = [...document.querySelectorAll('#numbers div')].find((e) => e.querySelector('span').textContent === 'step');"
            "return box ? Number(box.querySelector('b').textContent) : -1")

    def check_types(self, canvas):
        """The legend names the types in the colours of figures, and leaves one out."""
        labels = [e for e in self.at("types").find_elements("tag name", "label") if e.is_displayed()]
        self.assertEqual([e.text.strip() for e in labels], ["A", "B"])
        bead = labels[1].find_element("class name", "bead").value_of_css_property("background-color")
        self.assertEqual([int(n) for n in bead[bead.index("(") + 1:-1].split(",")[:3]], [0xd5, 0x5e, 0])
        labels[1].click()
        self.wait(lambda: self.count_pixels(canvas)[1] == 0)
        self.assertGreater(self.count_pixels(canvas)[0], 200)
        labels[1].click()

    def check_pixels(self, canvas):
        """Two types are drawn in two colours."""
        blue, red = self.count_pixels(canvas)
        self.assertGreater(blue, 200)
        self.assertGreater(red, 200)

    def count_pixels(self, canvas):
        return self.browser.execute_async_script("""
            const [text, done] = arguments, bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
            createImageBitmap(new Blob([bytes], { type: "image/png" })).then((image) => {
                const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
                const context = canvas.getContext("2d");
                context.drawImage(image, 0, 0);
                const data = context.getImageData(0, 0, image.width, image.height).data;
                let blue = 0, red = 0;
                for (let k = 0; k < data.length; k += 4) {
                    blue += data[k + 2] > 90 && data[k + 2] > data[k] + 20;
                    red += data[k] > 90 && data[k] > data[k + 2] + 20;
                }
                done([blue, red]);
            });""", canvas.screenshot_as_base64)

    def test_bonds_are_drawn_unless_an_end_is_left_out(self):
        """Each half has the colour of its bead: there is much more of it than where the other bead is left out."""
        self.begin("live", "dumbbells.json", "-o", "bonded", "--stay")
        self.served.wish(wish="speed", speed=100)
        self.press("start")
        self.wait(lambda: "step" in self.text("frames"))
        self.press("pause")
        self.wait(lambda: self.phase() == "paused")
        canvas = self.at("particles")
        self.browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", canvas)
        time.sleep(0.5)
        self.shoot("bonds")
        blue, red = self.count_pixels(canvas)
        self.assertGreater(red, 200)
        next(e for e in self.at("types").find_elements("tag name", "label") if e.text.strip() == "B").click()
        self.wait(lambda: self.count_pixels(canvas)[1] == 0)
        beads = self.count_pixels(canvas)[0]
        self.assertGreater(beads, 50)
        self.assertGreater(blue, 1.3 * beads)
        self.check_console()

    def test_temperature_and_time_step_change_while_it_runs(self):
        self.begin("live", "scene.json", "-o", "changed", "--stay")
        self.served.wish(wish="speed", speed=300)
        self.press("start")
        self.wait(lambda: self.at("change").is_displayed())
        self.wait(lambda: self.at("change-temperature").get_attribute("placeholder") == "1")
        self.at("change-temperature").send_keys("-2", Keys.ENTER)
        self.wait(lambda: "temperature" in self.text("message"))
        self.at("change-temperature").clear()
        self.at("change-temperature").send_keys("1.25")
        self.at("change-time-step").send_keys("0.01", Keys.ENTER)
        self.wait(lambda: self.at("change-temperature").get_attribute("placeholder") == "1.25")
        self.assertEqual(self.at("change-time-step").get_attribute("placeholder"), "0.01")
        self.shoot("changed")
        self.served.wish(wish="speed", speed=0)
        self.wait(lambda: self.phase() == "ended")
        self.assertFalse(self.at("change").is_displayed())
        with open(os.path.join(self.folder, "changed", "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        self.assertEqual([c["temperature"] for c in summary["changed"]], [1.25])
        # The only fault that the console may tell is the answer that refused −2.
        faults = [entry["message"] for entry in self.browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertTrue(all("400" in fault for fault in faults), faults)

    def test_family_of_an_individual(self):
        """A folder of a genetic fit has the cloud of its individuals; a click shows genes and parents."""
        fluid = {"box": [3, 3, 3], "particles": {"count": 81}, "time_step": 0.02, "dissipative": {"law": "power", "sigma": 3}}
        files = {"fluid.json": {**fluid, "seed": 5, "conservative": {"law": "soft-repulsion", "a": 25}, "rdf": {"range": 1, "bins": 20}},
                 "genetic.json": {"seed": 3, "scene": fluid, "target": {"rdf": {"file": "fluid/rdf.tsv"}},
                                  "unknowns": {"potential": {"coefficients": 6, "maximum": 30}},
                                  "method": {"name": "genetic", "population": 10, "generations": 4, "equilibration": 40, "samples": 8,
                                             "every": 5, "temperature_tolerance": 0.5},
                                  "verification": {"replicas": 2, "equilibration": 20, "samples": 8, "every": 5}}}
        for name, content in files.items():
            with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
                json.dump(content, file)
        self.assertEqual(run_plain(self.folder, "simulate", "fluid.json", "-o", "fluid"), 0)
        self.assertIn(run_plain(self.folder, "fit", "genetic.json", "-o", "bred"), (0, 1))
        self.begin("live", "bred")
        cloud = self.wait(lambda: next(iter(self.browser.find_elements("css selector", "[data-population=cloud] canvas")), None))
        self.browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", cloud)
        # The last individual, where the chart has drawn it.
        x, y = self.browser.execute_script("""
            const chart = Chart.getChart(arguments[0]), set = chart.data.datasets.findIndex((s) => s.label === "an individual");
            const points = chart.getDatasetMeta(set).data, point = points[points.length - 1], box = arguments[0].getBoundingClientRect();
            return [point.x - box.width / 2, point.y - box.height / 2];""", cloud)
        ActionChains(self.browser).move_to_element_with_offset(cloud, int(x), int(y)).click().perform()
        note = self.wait(lambda: next((p for p in self.browser.find_elements("css selector", "[data-population='genes_potential.tsv'] p") if p.text), None))
        self.assertRegex(note.text, r"Individual \d+: error [\d.e-]+; parents \d+(, \d+)?; children none")
        labels = self.browser.execute_script("return Chart.getChart(document.querySelector(\"[data-population='genes_potential.tsv'] canvas\")).data.datasets.map((s) => s.label)")
        self.assertIn("genes", labels)
        self.assertTrue(any(label.startswith("parent ") for label in labels))
        self.shoot("family")
        self.check_console()

    def delay_answers(self, name, seconds):
        """As through a slow tunnel: the answer comes when what it tells of is long over."""
        self.browser.execute_script(
            "const whole = window.fetch; window.fetch = async (url, how) => { const answer = await whole(url, how);"
            "if (url.startsWith('/api/' + arguments[0])) await new Promise((done) => setTimeout(done, 1000 * arguments[1])); return answer; };",
            name, seconds)

    def test_tab_that_was_chosen_stays_when_an_answer_comes_late(self):
        self.begin("live")
        self.at("tab-files").click()
        self.delay_answers("open", 1)
        self.delay_answers("start", 2)
        self.open_file("scene.json")
        self.wait(lambda: self.phase() == "ready")
        self.at("tab-settings").click()
        time.sleep(1.5)
        self.assertTrue(self.at("settings").is_displayed())
        self.press("start")
        self.wait(lambda: self.phase() in ("running", "ended"))
        self.at("tab-files").click()
        time.sleep(2.5)
        self.assertTrue(self.at("files").is_displayed())

    def test_folder_that_was_chosen_stays_when_an_earlier_list_comes_late(self):
        self.assertEqual(run_plain(self.folder, "simulate", "scene.json", "-o", "done"), 0)
        self.begin("live", "done")
        self.at("tab-files").click()
        self.browser.execute_script("window.fetchAtOnce = window.fetch")
        self.wait(lambda: self.button("results"))
        self.delay_answers("files", 1)
        self.click_button("working folder")
        self.browser.execute_script("window.fetch = window.fetchAtOnce")
        self.click_button("results")
        self.wait(lambda: self.button("download as zip"))
        time.sleep(1.5)
        offered = [button.text for button in self.at("files").find_elements("tag name", "button")]
        self.assertIn("download as zip", offered)

    def test_another_file_is_chosen_edited_refused_and_saved(self):
        self.begin("live")
        self.assertEqual(self.phase(), "choosing")
        self.at("tab-files").click()
        self.open_file("scene.json")
        self.wait(lambda: self.phase() == "ready")
        self.at("tab-settings").click()
        self.shoot("settings")
        field = self.wait(lambda: self.at("settings").find_element("css selector", "input[data-name=temperature]"))
        field.clear()
        field.send_keys("-3", Keys.TAB)
        self.press("start")
        self.wait(lambda: self.phase() == "refused")
        self.assertIn("temperature", self.text("message"))
        self.at("tab-settings").click()
        field = self.at("settings").find_element("css selector", "input[data-name=temperature]")
        field.clear()
        field.send_keys("1.5", Keys.TAB)
        self.at("tab-files").click()
        self.when_there(lambda: self.at("files").find_element("css selector", "input[placeholder='new.json']"),
                        lambda name: name.send_keys("hot.json"))
        self.click_button("save")
        self.wait(lambda: os.path.exists(os.path.join(self.folder, "hot.json")))
        with open(os.path.join(self.folder, "hot.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file)["temperature"], 1.5)
        self.shoot("files")
        self.press("start")
        self.wait(lambda: self.phase() == "ended")
        with open(os.path.join(self.folder, "out", "used.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file)["temperature"], 1.5)
        self.check_console()

    def test_results_open_the_same_panels_on_a_phone(self):
        self.assertEqual(run_plain(self.folder, "simulate", "scene.json", "-o", "done"), 0)
        self.begin("live", "done", width=500, height=840)
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                     {"width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True})
        self.wait(lambda: {"rdf_A-A.tsv", "motion.tsv", "thermodynamics.tsv"} <= set(self.panels()))
        wide = self.browser.execute_script("return document.documentElement.scrollWidth - window.innerWidth")
        self.assertLessEqual(wide, 0)
        self.shoot("phone")
        self.check_console()

    def test_settings_have_the_units_of_their_file(self):
        scene = {"units": "nm-ps", "box": [3, 3, 3], "particles": {"count": 300, "mass": 18}, "temperature": 298}
        with open(os.path.join(self.folder, "nm.json"), "w", encoding="utf-8") as file:
            json.dump(scene, file)
        with open(os.path.join(self.folder, "used.json"), "w", encoding="utf-8") as file:
            json.dump({**scene, "units": {"system": "nm-ps", "length": 0.46, "temperature": 298}}, file)
        for name, units in (("nm.json", ("box [nm]", "temperature [K]", "time_step [ps]")),
                            ("used.json", ("box [nm]", "temperature [K]", "time_step [ps]")),
                            ("scene.json", ("box [lambda]", "temperature [T_0]", "time_step [tau]"))):
            self.begin("live", name)
            self.at("tab-settings").click()
            self.wait(lambda units=units: all(unit in self.text("settings") for unit in units))
            field = self.browser.find_element("css selector", "#settings input[data-name='temperature']")
            self.assertEqual(field.get_attribute("placeholder") == "", name != "scene.json")
            self.browser.quit()
            self.served.end()
        self.browser = None

    def type(self, key):
        ActionChains(self.browser).send_keys(key).perform()

    def tab_to(self, name):
        for _ in range(40):
            if self.browser.switch_to.active_element.get_attribute("id") == name:
                return
            self.type(Keys.TAB)
        self.fail(f"no way to {name} by the keyboard")

    def test_keyboard_alone(self):
        self.begin("live", "scene.json", "--stay")
        self.tab_to("start")
        outline = self.browser.execute_script("return getComputedStyle(document.activeElement).outlineStyle")
        self.assertNotEqual(outline, "none")
        self.type(Keys.ENTER)
        self.wait(lambda: self.phase() in ("running", "ended"))
        self.tab_to("tab-view")
        self.type(Keys.ARROW_RIGHT)
        self.wait(lambda: self.at("settings").is_displayed())
        self.assertEqual(self.browser.switch_to.active_element.get_attribute("id"), "tab-settings")
        unnamed = self.browser.execute_script(
            "return [...document.querySelectorAll('button, input, select, textarea, canvas')].filter((e) => "
            "!e.textContent.trim() && !e.getAttribute('aria-label') && !(e.labels && e.labels.length)).length")
        self.assertEqual(unnamed, 0)
        self.wait(lambda: self.phase() == "ended")
        self.check_console()

    def test_stale_token_is_refused(self):
        self.begin("live", "scene.json")
        self.browser.get(self.served.address.replace(self.served.token, "0" * 32))
        self.assertIn("The token is missing, or that of another run", self.browser.page_source)
        self.browser.execute_script("sessionStorage.setItem('mesofit-token', '0'.repeat(32))")
        self.browser.get(self.served.address.split("?")[0])
        self.wait(lambda: self.phase() == "gone")
        self.assertIn("token", self.text("message"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
