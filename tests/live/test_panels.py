# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panels show of the tables that a run has written."""
import json
import os
import unittest

from page import PageTest
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

    def test_inverse_monte_carlo_has_excess_energy_and_singular_values(self):
        run = water_fit(3)
        run["method"]["regularisation"] = "truncated"
        self.run_file("cut.json", run, "cut")
        self.begin("live", "cut", dark=True)
        self.wait(lambda: "singular_values.tsv" in self.panels())
        self.wait(lambda: "potential energy of a bead in the fit's samples" in self.titles())
        values = self.rows("cut", "singular_values.tsv")
        used = sum(row[2] == "1" for row in values)
        shown = dict(self.chart("singular_values.tsv")[2:])
        self.assertEqual([label for label, _ in self.chart("singular_values.tsv")[:2]], ["", ""]) # two earlier iterations
        self.assertEqual(shown["used"], used)
        self.assertEqual(shown["left out, or less than half used"], sum(row[2] == "0" and float(row[1]) > 0 for row in values))
        bins = len(self.rows("cut", "rdf_now.tsv"))
        self.assertEqual(self.chart("rdf_now.tsv", 2), [["", bins], ["", bins], ["S − S*", bins]])
        panel = self.browser.find_element("css selector", "[data-table='singular_values.tsv']")
        self.assertIn(f"took {used}.0 of {len(values)}", panel.text)
        self.browser.execute_script("arguments[0].scrollIntoView({ block: 'center' })", panel)
        self.shoot("singular")
        self.check_console()


if __name__ == "__main__":
    unittest.main(verbosity=2)
