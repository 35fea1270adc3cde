// SPDX-License-Identifier: GPL-3.0-or-later
// Candidates of optimisers: their errors by iteration, their curves, and the front of several targets.
import { Individuals } from "/individuals.js";
import { keep } from "/tables.js";
import { Plot, colour, curve, points, translucent } from "/plots.js";

export class Population {
  constructor(parent) {
    this.parent = parent;
    this.tables = new Map();
    this.plots = new Map();
    this.individuals = null;
    this.chosen = { lines: -1, front: -1, individual: 0 };
  }

  plot(name, title, options) {
    if (!this.plots.has(name))
      this.plots.set(name, new Plot(this.parent, title, options)).get(name).figure.dataset.population = name;
    return this.plots.get(name);
  }

  update(changed) {
    keep(this.tables, changed);
    for (const [name, table] of changed)
      if (/^population_.*\.tsv$/.test(name) && table)
        this.showLines(name, table);
    if (changed.has("individuals.tsv") || changed.has("history.tsv"))
      this.showCloud();
    if (this.tables.has("pareto.tsv"))
      this.showFront(this.tables.get("pareto.tsv"));
  }

  // Every individual's error; a click shows its genes and its family.
  showCloud() {
    const table = this.tables.get("individuals.tsv"), history = this.tables.get("history.tsv");
    if (!table || !table.length)
      return;
    const all = this.individuals = new Individuals(table);
    const best = history && history.length ? points(history.column(0), history.values("error")) : [];
    const plot = this.plot("cloud", "errors of the individuals", { kind: "scatter", logarithmic: true,
      click: (nearest, chart, found) => this.choose(found.map((one) => chart.data.datasets[one.datasetIndex].data[one.index].number).find(Boolean)) });
    plot.show([
      { label: "an individual", data: all.cloud(), pointRadius: 3, backgroundColor: translucent(colour(0), 0.45) },
      { label: "median", data: all.medians(), type: "line", borderColor: colour(3), pointRadius: 0 },
      { label: "best", data: best, type: "line", borderColor: colour(1), pointRadius: 0 }],
    { x: "iteration", y: "error" });
    plot.say("Click an individual to see its genes, its parents and its children.");
    if (this.chosen.individual)
      this.choose(this.chosen.individual);
  }

  choose(number) {
    if (!this.individuals.row.has(number))
      return;
    this.chosen.individual = number;
    for (const [name, places] of this.tables)
      if (/^genes_.*\.tsv$/.test(name) && places.length > 1) {
        const curveName = name.replace(/^genes_|\.tsv$/g, "");
        this.individuals.show(this.plot(name, `genes of an individual (${curveName})`), number, curveName, places);
      }
  }

  showLines(name, table) {
    const plot = this.plot(name, `curves of the population (${name.replace("population_", "").replace(".tsv", "")})`, {
      click: (found) => { this.chosen.lines = found.datasetIndex; this.showLines(name, table); } });
    const count = table.columns.length - 1, chosen = this.chosen.lines;
    const sets = [];
    for (let k = 1; k <= count; k++)
      sets.push(curve(k === 1 ? "best" : "", table.column(0), table.column(k), k === 1 ? 1 : 0, {
        borderWidth: k === 1 || k - 1 === chosen ? 3 : 1,
        borderColor: k - 1 === chosen ? colour(3) : k === 1 ? colour(1) : translucent(colour(0), 0.35) }));
    if (chosen > 0 && chosen < count)
      sets[chosen].label = "chosen";
    const values = sets[0].data.map((p) => p.y), low = Math.min(...values), hasCore = /^population_potential/.test(name);
    plot.chart.options.scales.y.min = hasCore ? low - 0.3 * Math.abs(low) - 0.1 : undefined;
    plot.chart.options.scales.y.max = hasCore ? Math.max(3 * Math.abs(low), 1) : undefined;
    plot.show(sets, { x: table.label(0) });
    plot.say(chosen >= 0 && chosen < count
      ? `Candidate ${chosen + 1} of ${count}: error ${table.columns[chosen + 1].name}. Click another curve.`
      : `${count} candidates of the last large round. Click a curve to learn its error.`);
  }

  showFront(table) {
    const targets = table.columns.map((c) => c.name).filter((name) => name.endsWith("_rmse"));
    if (targets.length < 2)
      return;
    const [a, b] = targets, rank = table.values("rank");
    const plot = this.plot("front", "front of the targets", { kind: "scatter", logarithmic: false,
      click: (found, chart) => { this.chosen.front = chart.data.datasets[found.datasetIndex].rows[found.index]; this.showFront(table); } });
    const pick = (test) => table.rows.map((row, k) => k).filter(test);
    const set = (label, rows, k, radius) => ({ label, rows, pointRadius: radius, backgroundColor: colour(k),
      data: rows.map((n) => ({ x: table.rows[n][table.at(a)], y: table.rows[n][table.at(b)] })) });
    const chosen = this.chosen.front;
    const sets = [set("front", pick((k) => rank[k] === 1), 0, 5), set("others", pick((k) => rank[k] !== 1), 7, 3),
      set("result", pick((k) => table.values("chosen")[k] === 1), 1, 8)];
    if (chosen >= 0 && chosen < table.length)
      sets.unshift(set("shown", [chosen], 3, 10));
    plot.show(sets, { x: a.replaceAll("_", " "), y: b.replaceAll("_", " ") });
    plot.say("Click a member to see its curves.");
    this.showMember(table, chosen);
  }

  showMember(table, chosen) {
    for (const [name, curves] of this.tables) {
      if (!/^pareto_(potential|omega).*\.tsv$/.test(name) || curves.columns.length < 2)
        continue;
      const plot = this.plot(name, `curves of the front (${name.replace("pareto_", "").replace(".tsv", "")})`);
      const sets = curves.columns.slice(1).map((column, k) => curve(Number(column.name) === chosen + 1 ? `member ${column.name}` : "",
        curves.column(0), curves.column(k + 1), 0, { borderWidth: Number(column.name) === chosen + 1 ? 3 : 1,
          borderColor: Number(column.name) === chosen + 1 ? colour(3) : translucent(colour(0), 0.4) }));
      plot.show(sets, { x: curves.label(0) });
    }
  }

  clear() {
    this.plots.forEach((plot) => plot.remove());
    this.plots.clear();
    this.tables.clear();
    this.individuals = null;
    this.chosen = { lines: -1, front: -1, individual: 0 };
  }

  get count() {
    return this.plots.size;
  }
}
