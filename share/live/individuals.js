// SPDX-License-Identifier: GPL-3.0-or-later
// individuals.tsv: every candidate of an optimiser's rounds, its genes, its parents and its children.
import { colour, curve, translucent } from "/plots.js";

// Bernstein's polynomials, one row a place.
function basis(count, places) {
  const n = count - 1;
  return places.map((t) => {
    let weights = [1];
    for (let k = 0; k < n; k++)
      weights = [...weights, 0].map((w, j) => w * (1 - t) + (j > 0 ? weights[j - 1] * t : 0));
    return weights;
  });
}

// y at x between the points of two columns.
function between(xs, ys, x) {
  const k = Math.max(1, xs.findIndex((v) => v >= x));
  return ys[k - 1] + (ys[k] - ys[k - 1]) * (x - xs[k - 1]) / (xs[k] - xs[k - 1]);
}

export class Individuals {
  constructor(table) {
    this.table = table;
    this.row = new Map(table.rows.map((row, k) => [row[1], k]));
  }

  parents(number) {
    const row = this.table.rows[this.row.get(number)];
    return [...new Set([row[3], row[4]])].filter((parent) => this.row.has(parent));
  }

  children(number) {
    return this.table.rows.filter((row) => row[3] === number || row[4] === number).map((row) => row[1]);
  }

  error(number) {
    return this.table.rows[this.row.get(number)][2];
  }

  cloud() {
    return this.table.rows.filter((row) => Number.isFinite(row[2])).map((row) => ({ x: row[0], y: row[2], number: row[1] }));
  }

  medians() {
    const byIteration = new Map();
    for (const { x, y } of this.cloud())
      byIteration.set(x, [...(byIteration.get(x) || []), y]);
    return [...byIteration].map(([x, list]) => ({ x, y: list.sort((a, b) => a - b)[Math.floor(list.length / 2)] }));
  }

  // Coefficients of a curve, the last of which shifts it to end at 0.
  genes(number, name) {
    const row = this.table.rows[this.row.get(number)];
    return row.filter((_, k) => this.table.columns[k].name.replace(/\(\d+\)$/, "") === name && /\(\d+\)$/.test(this.table.columns[k].name));
  }

  curve(number, name, places) {
    const genes = this.genes(number, name), last = genes[genes.length - 1], base = places.column(2);
    return basis(genes.length, places.column(1)).map((weights, k) => base[k] + weights.reduce((sum, w, j) => sum + w * genes[j], -last));
  }

  polygon(number, name, places) {
    const genes = this.genes(number, name), last = genes[genes.length - 1], [r, t, base] = [0, 1, 2].map((k) => places.column(k));
    return genes.map((gene, k) => {
      const x = between(t, r, genes.length > 1 ? k / (genes.length - 1) : 0);
      return { x, y: gene - last + between(r, base, x) };
    });
  }

  // An individual's curve with its polygon, its parents dashed, its children thin.
  show(plot, number, name, places) {
    const r = places.column(0), parents = this.parents(number), children = this.children(number);
    const set = (label, of, k, more) => curve(label, r, this.curve(of, name, places), k, more);
    plot.show([
      ...children.slice(0, 40).map((child, k) => set(k === 0 ? "children" : "", child, 2, { borderWidth: 1, borderColor: translucent(colour(2), 0.5) })),
      ...parents.map((parent) => set(`parent ${parent}`, parent, 1, { borderDash: [6, 4] })),
      set(`individual ${number}`, number, 0, { borderWidth: 3 }),
      { label: "genes", data: this.polygon(number, name, places), borderColor: colour(3), backgroundColor: colour(3), borderWidth: 1, pointRadius: 4 }],
    { x: places.label(0) });
    const list = (numbers) => (numbers.length ? numbers.slice(0, 12).join(", ") + (numbers.length > 12 ? " …" : "") : "none");
    plot.say(`Individual ${number}: error ${this.error(number)}; parents ${list(parents)}; children ${list(children)}.`);
  }
}
