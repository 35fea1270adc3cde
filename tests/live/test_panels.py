# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panels show of the tables that a run has written."""
import json
import os
import unittest

from page import ActionChains, PageTest
from served import run_plain, water_fit


class Panels(PageTest):
    def run_file(self, name, content, folder):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            json.dump(content, file)
        verb = "fit" if "target" in content else "simulate"
        self.assertIn(run_plain(self.folder, verb, name, "-o", folder), (0, 1))

    def rows(self, folder, table):
        with open(os.path.join(self.folder, folder, table), encoding="utf-8") as lines:
            return [line.split() for line in lines if not line.startswith("#")]

    def titles(self):
        return [c.text for c in self.browser.find_elements("css selector", "#panels figcaption")]

    def test_inverse_monte_carlo_has_excess_and_energy(self):
        self.run_file("fit.json", water_fit(3), "fit")
        self.begin("live", "fit", dark=True)
        self.wait(lambda: "potential energy of a bead in the fit's samples" in self.titles())
        bins = len(self.rows("fit", "rdf_now.tsv"))
        self.assertEqual(self.chart("rdf_now.tsv", 2), [["", bins], ["", bins], ["S − S*", bins]]) # two earlier iterations
        self.check_console()

    def test_molecules_have_their_bonds_and_angles(self):
        """U of each group with its band, and p beside its target, of the fit's samples and of the verification."""
        scene = {"box": [4, 4, 4], "temperature": 1, "time_step": 0.01, "dissipative": {"law": "power", "sigma": 3},
                 "molecules": {"trimer": {"count": 60, "chain": {"beads": ["A", "A", "A"], "bond": "stiff_bond", "angle": "bend"}}}}
        law = {"conservative": {"law": "soft-repulsion", "a": 15}, "bonds": {"stiff_bond": {"law": "harmonic", "k": 80, "length": 0.6}},
               "angles": {"bend": {"law": "harmonic", "k": 10, "angle": 120}}}
        self.run_file("melt.json", {"seed": 2, **scene, **law, "rdf": {"range": 1.2, "bins": 30}, "bond_lengths": {"bins": 30},
                                    "bond_angles": {"bins": 30}, "measure": {"equilibration": 500, "samples": 200, "every": 20}}, "melt")
        groups = (("bond_lengths", "bonds", "stiff_bond"), ("bond_angles", "angles", "bend"))
        targets = {p: {g: {"file": f"melt/{p}.tsv"}} for p, _, g in groups}
        self.run_file("found.json", {"seed": 4, "scene": scene, "target": {"rdf": {"file": "melt/rdf.tsv"}, **targets},
                                     "method": {"name": "ibi", "replicas": 2, "iterations": 3},
                                     "verification": {"replicas": 2, "equilibration": 200, "samples": 20, "every": 20}}, "found")
        self.begin("live", "found")
        self.wait(lambda: {f"{u}_{g}.tsv" for _, u, g in groups} <= set(self.panels()))
        self.wait(lambda: {f"now_{p}_{g}.tsv" for p, _, g in groups} | {f"{p}_{g}.tsv" for p, _, g in groups} <= set(self.panels()))
        for title in ('U of the bond "stiff_bond"', 'U of the angle "bend"', 'bond lengths of "stiff_bond"',
                      'bond lengths of "stiff_bond" less their target', 'bond angles of "bend", last samples of the fit'):
            self.assertIn(title, self.titles())
        for p, u, g in groups:
            rows = self.rows("found", f"{u}_{g}.tsv")
            known = sum(row[2] != "nan" for row in rows)
            self.assertLess(known, len(rows))
            self.assertEqual(self.chart(f"{u}_{g}.tsv")[-1], ["U", known])
            self.assertEqual([label for label, _ in self.chart(f"now_{p}_{g}.tsv") if label], ["target", "result"])
        self.assertEqual(self.browser.execute_script(
            "return Chart.getChart(document.querySelector(`[data-table='angles_bend.tsv'] canvas`)).options.scales.x.title.text"), "θ [degrees]")
        for name, table in (("bond", "bonds_stiff_bond.tsv"), ("lengths", "bond_lengths_stiff_bond.tsv")):
            self.browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })",
                                        self.browser.find_element("css selector", f"[data-table='{table}']"))
            self.shoot(name)
        self.check_console()

    def test_results_are_compared_with_those_of_another_folder(self):
        self.run_file("one.json", water_fit(1), "one")
        self.run_file("other.json", {**water_fit(1), "seed": 9}, "other")
        self.begin("live", "one")
        self.wait(lambda: {"potential.tsv", "rdf.tsv"} <= set(self.panels()))
        self.assertNotIn("other run", [label for label, _ in self.chart("potential.tsv")])
        self.at("other").send_keys("other/")
        self.at("compare-go").click()
        for table, column in (("potential.tsv", 1), ("rdf.tsv", 3)):
            self.wait(lambda table=table: "other run" in [label for label, _ in self.chart(table)])
            last = float([row for row in self.rows("other", table) if row[column] != "nan"][-1][column])
            self.assertEqual(self.browser.execute_script(
                "return Chart.getChart(document.querySelector(`[data-table='${arguments[0]}'] canvas`)).data.datasets"
                ".find((s) => s.label === 'other run').data.at(-1).y", table), last)
        self.check_console()

    def test_results_in_other_units_are_not_drawn_over_these(self):
        reduced = {"box": [5, 5, 5], "particles": {"count": 375}, "temperature": 1, "time_step": 0.02,
                   "conservative": {"law": "soft-repulsion", "a": 25}, "dissipative": {"law": "power", "sigma": 3},
                   "measure": {"equilibration": 50, "samples": 10, "every": 10}}
        nm = {**reduced, "units": "nm-ps", "temperature": 298, "particles": {"count": 375, "mass": 18},
              "conservative": {"law": "soft-repulsion", "a": 25, "cutoff": 1}, "dissipative": {"law": "power", "sigma": 3, "cutoff": 1}}
        self.run_file("reduced.json", reduced, "reduced")
        self.run_file("again.json", {**reduced, "seed": 8}, "again")
        self.run_file("nm.json", nm, "nm")
        self.begin("live", "reduced")
        self.wait(lambda: "rdf.tsv" in self.panels())
        for folder, drawn in (("again", True), ("nm", False)):
            self.at("other").clear()
            self.at("other").send_keys(folder)
            self.at("compare-go").click()
            self.wait(lambda drawn=drawn: ("other run" in [label for label, _ in self.chart("rdf.tsv")]) == drawn)
            self.assertEqual("same units" in self.text("message"), not drawn)
        self.check_console()

    def test_front_of_several_targets_shows_the_curves_of_a_member(self):
        fluid = {"box": [3, 3, 3], "particles": {"count": 81}, "time_step": 0.02, "dissipative": {"law": "power", "sigma": 3}}
        self.run_file("fluid.json", {**fluid, "seed": 5, "conservative": {"law": "soft-repulsion", "a": 25},
                                     "rdf": {"range": 1, "bins": 20}}, "fluid")
        self.run_file("front.json", {
            "seed": 3, "scene": fluid, "target": {"rdf": {"file": "fluid/rdf.tsv"}, "pressure": {"value": 20, "error": 0.5}},
            "unknowns": {"potential": {"coefficients": 4, "maximum": 30}},
            "method": {"name": "pareto", "population": 8, "generations": 3, "equilibration": 20, "samples": 4, "every": 8,
                       "temperature_tolerance": 0.5},
            "verification": {"replicas": 2, "equilibration": 20, "samples": 5, "every": 8}}, "front")
        self.begin("live", "front")
        front = self.wait(lambda: next(iter(self.browser.find_elements("css selector", "[data-population=front] canvas")), None))
        self.browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", front)
        x, y, member = self.browser.execute_script("""
            const chart = Chart.getChart(arguments[0]), n = chart.data.datasets.findIndex((s) => s.label === "front");
            const point = chart.getDatasetMeta(n).data[0], box = arguments[0].getBoundingClientRect();
            return [point.x - box.width / 2, point.y - box.height / 2, chart.data.datasets[n].rows[0] + 1];""", front)
        ActionChains(self.browser).move_to_element_with_offset(front, int(x), int(y)).click().perform()
        shown = "[data-population='pareto_potential.tsv'] canvas"
        labels = self.wait(lambda: self.browser.execute_script("const c = document.querySelector(arguments[0]);"
            "return c && Chart.getChart(c).data.datasets.map((s) => s.label).filter(Boolean)", shown))
        self.assertEqual(labels, [f"member {member}"])
        self.check_console()

    def test_friction_with_memory_and_across_pairs_has_curves_and_genes(self):
        fluid = {"box": [3, 3, 3], "particles": {"count": 81}, "time_step": 0.02, "conservative": {"law": "soft-repulsion", "a": 25}}
        etd = {"r_minimum": 0.4, "r_maximum": 0.9}
        curve = {"coefficients": 4, "maximum": 6}
        self.run_file("fluid.json", {**fluid, "seed": 5, "dissipative": {"law": "power", "sigma": 3},
                                     "measure": {"equilibration": 100, "samples": 60, "every": 10},
                                     "etd": {**etd, "bins": 12, "times": 12, "every": 2}}, "target")
        self.run_file("bred.json", {
            "seed": 3, "target": {"etd": {"file": "target/etd.tsv", "error_file": "target/etd_error.tsv", **etd}},
            "unknowns": {"omega": curve, "omega_transverse": curve, "memory": {"slow": curve}},
            "scene": {**fluid, "memory": {"slow": {"time": 0.2}}},
            "method": {"name": "genetic", "population": 7, "generations": 3, "equilibration": 10, "samples": 4, "every": 8,
                       "temperature_tolerance": 0.5},
            "verification": {"replicas": 2, "equilibration": 20, "samples": 5, "every": 8}}, "bred")
        self.begin("live", "bred")
        self.wait(lambda: {"omega.tsv", "omega_transverse.tsv", "memory_slow.tsv", "etd_cells.tsv"} <=
                  set(self.panels()) | set(self.titles()) | {"etd_cells.tsv"})
        self.assertIn('ω(r) of the memory "slow"', self.titles())
        self.assertIn("ω(r) across pairs", self.titles())
        self.assertFalse([title for title in self.titles() if "flat" in title or "history" in title])
        # Three generations: two earlier ones, the band if there is one, and the best.
        self.assertEqual([label for label, _ in self.chart("memory_slow.tsv")][:2], ["", ""])
        cloud = self.wait(lambda: next(iter(self.browser.find_elements("css selector", "[data-population=cloud] canvas")), None))
        self.browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", cloud)
        number = self.find_of_last_round()
        self.click_individual(cloud, number)
        for name in ("omega", "omega_transverse", "memory_slow"):
            note = self.wait(lambda name=name: next((p for p in self.browser.find_elements(
                "css selector", f"[data-population='genes_{name}.tsv'] p") if p.text), None))
            self.assertIn(f"Individual {number}: error", note.text)
            self.check_curve(name, number)
        self.shoot("memory")
        self.check_console()

    def heads(self, name):
        """Errors by which the columns of the last round's curves are named."""
        with open(os.path.join(self.folder, "bred", f"population_{name}.tsv"), encoding="utf-8") as lines:
            head = [line for line in lines if line.startswith("#")][-1][1:].split()
        return [float(heading.split("[")[0]) for heading in head[1:]]

    def find_of_last_round(self):
        """The last individual whose curves are told; names have four digits."""
        heads = self.heads("omega")
        return next(int(row[1]) for row in reversed(self.rows("bred", "individuals.tsv"))
                    if min(abs(float(row[2]) / head - 1) for head in heads) < 1e-3)

    def click_individual(self, cloud, number):
        """Where the chart has drawn it."""
        x, y = self.browser.execute_script("""
            const chart = Chart.getChart(arguments[0]), set = chart.data.datasets.findIndex((s) => s.label === "an individual");
            const index = chart.data.datasets[set].data.findIndex((point) => point.number === arguments[1]);
            const point = chart.getDatasetMeta(set).data[index], box = arguments[0].getBoundingClientRect();
            return [point.x - box.width / 2, point.y - box.height / 2];""", cloud, number)
        ActionChains(self.browser).move_to_element_with_offset(cloud, int(x), int(y)).click().perform()

    def check_curve(self, name, number):
        """The page makes of an individual's genes the curve that the program has written of it."""
        error = float(next(row[2] for row in self.rows("bred", "individuals.tsv") if row[1] == str(number)))
        column = 1 + min(enumerate(self.heads(name)), key=lambda head: abs(head[1] - error))[0]
        written = [(float(row[0]), float(row[column])) for row in self.rows("bred", f"population_{name}.tsv")]
        drawn = self.browser.execute_script(
            "return Chart.getChart(document.querySelector(`[data-population='genes_${arguments[0]}.tsv'] canvas`)).data.datasets"
            ".find((s) => s.label.startsWith('individual')).data", name)
        self.assertGreater(len(drawn), 10)
        for point in drawn:
            near = min(written, key=lambda one: abs(one[0] - point["x"]))
            self.assertAlmostEqual(near[0], point["x"], delta=1e-6)
            self.assertAlmostEqual(near[1], point["y"], delta=1e-4)


if __name__ == "__main__":
    unittest.main(verbosity=2)
