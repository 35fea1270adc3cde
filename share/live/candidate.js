// SPDX-License-Identifier: GPL-3.0-or-later
// The candidate of an optimiser that was simulated last: its curves, what they give, and how far that is off.
import { pretty } from "/tables.js";
import { Plot, colour, curve, translucent } from "/plots.js";

const symbols = [[/^potential/, "Φ"], [/^(omega|memory)/, "ω"], [/^(bonds|angles|dihedrals)/, "U"]];
const symbolOf = (name) => symbols.find(([pattern]) => pattern.test(name))?.[1] || name;
const of = (name) => (name ? ` (${name.replaceAll("_", " ")})` : "");
const unitOf = (unit) => (unit && unit !== "1" ? ` [${pretty(unit)}]` : "");
const digits = (value, count) => (value === null ? "unknown" : value.toPrecision(count));

export class Candidate {
  constructor(parent) {
    this.parent = parent;
    this.plots = new Map();
  }

  plot(name, title) {
    if (!this.plots.has(name))
      this.plots.set(name, new Plot(this.parent, title)).get(name).figure.dataset.candidate = name;
    return this.plots.get(name);
  }

  take(candidate) {
    if (!candidate.number) {
      this.clear();
      return;
    }
    const { number, error, temperature, temperature_unit: unit } = candidate;
    const said = error === null ? "it failed" : `fitness F = ${digits(error, 4)}`;
    const text = `Candidate ${number} of this iteration: ${said}; T = ${digits(temperature, 4)}${unitOf(unit)}.`;
    for (const { name, unit: u, r_unit: r, r: x, value } of candidate.curves) {
      const plot = this.plot(name, `candidate that was simulated last: ${symbolOf(name)}${of(name)}`);
      plot.show([curve("candidate", x, value, 0)], { x: `r${unitOf(r)}`, y: `${symbolOf(name)}${unitOf(u)}` });
      plot.say(text);
    }
    for (const { name, r_unit: r, r: x, value, target } of candidate.rdf) {
      const plot = this.plot("rdf" + name, `candidate that was simulated last: g(r)${of(name)}`);
      plot.show([curve("target", x, target, 7, { borderWidth: 4, borderColor: translucent(colour(7), 0.6) }),
        curve("candidate", x, value, 0)], { x: `r${unitOf(r)}`, y: "g(r)" });
      plot.say(text);
    }
  }

  update() {}

  clear() {
    this.plots.forEach((plot) => plot.remove());
    this.plots.clear();
  }

  get count() {
    return this.plots.size;
  }
}
