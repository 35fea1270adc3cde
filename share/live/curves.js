// SPDX-License-Identifier: GPL-3.0-or-later
// Panels of curves: one for each table that is known, whatever run has written it.
import { keep, symbol } from "/tables.js";
import { Plot, band, colour, curve, points, translucent } from "/plots.js";

const most = 60; // faint lines of a history

// y within what lies beyond the core, which would flatten the rest.
function besideCore(datasets) {
  const values = datasets.flatMap((set) => set.data.map((p) => p.y)).filter(Number.isFinite);
  if (!values.length)
    return [undefined, undefined];
  const sorted = [...values].sort((a, b) => a - b);
  const low = sorted[0], middle = sorted[Math.floor(sorted.length / 2)];
  const high = sorted[sorted.length - 1];
  const limit = middle + Math.max(4 * (middle - low), 0.5);
  return high > limit + 3 * Math.abs(limit - low) ? [low - 0.1 * (limit - low), limit] : [undefined, undefined];
}

// y of the curve that has a name, where it has an error: beyond, U of a group goes on without end.
function ofCurve(datasets) {
  const values = datasets.filter((set) => set.label).flatMap((set) => set.data.map((p) => p.y)), high = Math.max(...values);
  return values.length ? [-0.05 * high, 1.05 * high] : [undefined, undefined];
}
const rangeOf = (datasets) => (datasets.some((set) => set.label === symbol("energy")) ? ofCurve : besideCore)(datasets);

// What a table's columns say as curves: y, its error, and what it is to be compared with.
function pairs(table, x, names) {
  return names.filter((name) => table.has(name)).flatMap((name, k) => {
    const y = table.values(name);
    const error = table.has(name + "_error") ? table.values(name + "_error") : null;
    return [...(error ? band(x, y, error, k) : []), curve(symbol(name), x, y, k)];
  });
}

// Earlier iterations of a curve, faint: the columns of its history but the last.
function earlier(history) {
  if (!history)
    return [];
  const sets = [], count = history.columns.length - 1, first = Math.max(1, count - most + 1);
  for (let k = first; k < count; k++)
    sets.push(curve("", history.column(0), history.column(k), 7,
      { borderWidth: 1, borderColor: translucent(colour(7), 0.3 + 0.4 * (k - first) / (count - first + 1)) }));
  return sets;
}

// The same table of another run, if it speaks the same units: nothing is converted here.
function otherOf(context, name) {
  const table = context.tables.get(name), other = context.other.get(name);
  return table && other && [0, 1].every((k) => table.columns[k].unit === other.columns[k]?.unit) ? other : null;
}

// An unknown: its curve with a band, earlier iterations, the truth, another run's.
function showUnknown(plot, table, name, context) {
  const x = table.column(0), value = table.columns[1].name;
  const history = context.tables.get(name.replace(".tsv", "_history.tsv")), sets = earlier(history);
  const error = table.has(value + "_error") ? table.values(value + "_error") : null, group = value === "energy";
  const y = table.values(value).map((v, k) => (group && error && !Number.isFinite(error[k]) ? NaN : v));
  if (error)
    sets.push(...band(x, y, error, 0));
  sets.push(curve(symbol(value), x, y, 0));
  if (table.has("truth") && table.values("truth").some(Number.isFinite))
    sets.push(curve("truth", x, table.values("truth"), 1, { borderDash: [6, 4] }));
  const other = otherOf(context, name);
  if (other)
    sets.push(curve("other run", other.column(0), other.column(1), 2, { borderDash: [3, 3] }));
  plot.show(sets, { x: table.label(0), y: table.label(1) });
  plot.say(history ? `Iterations: ${history.columns.length - 1}. Grey: earlier ones. The band is 1.96 standard errors.` : "");
}

// The function that a table is of, and the pair of types in the table's name.
const functions = { rdf: "g(r)", rdf_now: "g(r)", vacf: "velocity autocorrelation", msd: "mean-square displacement", structure_factor: "S(q)" };
function functionOf(name) {
  const key = /^(rdf_now|rdf|[a-z_]+)/.exec(name)[0];
  return functions[key] || key.replaceAll("_", " ");
}
const nowOf = (name) => (/^rdf_now|^now_/.test(name) ? ", last samples of the fit" : "");
const pairOf = (name) => name.replace(/^rdf(_now)?|\.tsv$/g, "").replace("_", " ");

// Lengths and angles of a group of molecules, whose name the table's has at its end.
const groupFile = /^(?:now_)?(bond_lengths|bond_angles|dihedral_angles)_(.+)\.tsv$/;
function groupOf(name) {
  const [, kind, group] = groupFile.exec(name);
  return `${kind.replace("_", " ")} of "${group}"`;
}

// A target and what was found of it.
function showTarget(plot, table, name, context) {
  const x = table.column(0), sets = [];
  if (table.has("target")) {
    sets.push(...band(x, table.values("target"), table.has("target_error") ? table.values("target_error") : x.map(() => 0), 7));
    sets.push(curve("target", x, table.values("target"), 7, { borderWidth: 4, borderColor: translucent(colour(7), 0.6) }));
    sets.push(curve("result", x, table.values("result"), 0));
  } else {
    sets.push(...pairs(table, x, [table.columns[1].name]));
  }
  const other = otherOf(context, name);
  if (other)
    sets.push(curve("other run", other.column(0), other.values(other.has("result") ? "result" : other.columns[1].name), 2,
      { borderDash: [3, 3] }));
  plot.show(sets, { x: table.label(0), y: (groupFile.test(name) ? "p" : functionOf(name)) + table.unit(1) });
}

function showDifference(plot, table) {
  const x = table.column(0), target = table.values("target"), result = table.values("result");
  const difference = result.map((v, k) => v - target[k]);
  const known = table.has("result_error") && table.has("target_error");
  const noise = known
    ? table.values("result_error").map((e, k) => Math.hypot(e || 0, table.values("target_error")[k] || 0)) : x.map(() => 0);
  plot.show([...band(x, x.map(() => 0), noise, 7), curve("result − target", x, difference, 1)],
    { x: table.label(0), y: "difference" });
  plot.say(known ? "The band is what statistical errors alone would give, 1.96 standard errors." : "");
}

// S − S* of the last iteration over those before it.
function showExcess(plot, table, name, context) {
  const history = context.tables.get(name.replace("rdf_now", "excess").replace(".tsv", "_history.tsv"));
  plot.show([...earlier(history), curve("S − S*", table.column(0), table.values("excess"), 1)], { x: table.label(0), y: "pairs" });
  plot.say("Pairs in each bin of the sampled system, less those of the target. Grey: earlier iterations.");
}

// What a history without units is in; with units its head says them.
const reduced = { pressure: " [k_B T_0/λᵈ]", potential_energy: " [k_B T_0]" };

// The name of one column; of several the unit that they share.
function labelOf(table, names) {
  const [k, ...more] = names.map((name) => table.at(name)).filter((at) => at >= 0);
  if (names.length === 1)
    return table.label(k) + (table.columns[k].unit ? "" : reduced[names[0]] || "");
  return more.every((at) => table.unit(at) === table.unit(k)) ? table.unit(k).trim() : "";
}

// Columns of a history, each against the first one.
const showColumns = (names) => (plot, table) => {
  plot.show(pairs(table, table.column(0), names).map((set) => ({ ...set, pointRadius: set.label && table.length < 40 ? 3 : 0 })),
    { x: table.label(0), y: labelOf(table, names) });
};

const positive = (names) => (table) => names.some((name) => table.has(name) && table.values(name).some((v) => v > 0));
const hasColumns = (names) => (table) => names.some((name) => table.has(name) && table.values(name).some(Number.isFinite));

// Curves that a fit finds: Φ, ω, that across pairs, those of modes of memory, U of groups; not their histories and flat directions.
const unknownFile = /^(?!.*_(history|flat)\.tsv$)(potential(_[^_]+-[^_]+)?|omega(_[^_]+-[^_]+)?|omega_transverse|memory_.+|(bonds|angles|dihedrals)_.+)\.tsv$/;
const named = [[/^memory_(.*)\.tsv$/, "ω(r) of the memory \"$1\""], [/^(bond|angle|dihedral)s_(.*)\.tsv$/, "U of the $1 \"$2\""]];
function unknownTitle(name) {
  const [form, title] = named.find(([pattern]) => pattern.test(name)) || [];
  return form ? name.replace(form, title)
    : name.replace(".tsv", "").replace("potential", "Φ(r)").replace("omega_transverse", "ω(r) across pairs").replace(/^omega/, "ω(r)").replace("_", " ");
}

// file, title, what shows it; `when` says whether the table has it.
const kinds = [
  { file: unknownFile, title: unknownTitle, show: showUnknown, range: rangeOf },
  { file: /^rdf(_now)?(_[^_]+-[^_]+)?\.tsv$/, title: (n) => "g(r)" + nowOf(n) + pairOf(n), show: showTarget },
  { file: /^rdf(_now)?(_[^_]+-[^_]+)?\.tsv$/, title: (n) => "g(r) less its target" + nowOf(n) + pairOf(n), show: showDifference, when: (t) => t.has("target") },
  { file: groupFile, title: (n) => groupOf(n) + nowOf(n), show: showTarget },
  { file: groupFile, title: (n) => groupOf(n) + " less their target" + nowOf(n), show: showDifference, when: (t) => t.has("target") },
  { file: /^rdf_now(_[^_]+-[^_]+)?\.tsv$/, title: (n) => "S − S* by bin" + pairOf(n), show: showExcess },
  { file: /^history\.tsv$/, title: () => "error of the fit", show: showColumns(["error", "noise", "least", "mean"]), logarithmic: true, when: positive(["error"]) },
  { file: /^history\.tsv$/, title: () => "pressure", show: showColumns(["pressure"]), when: hasColumns(["pressure"]) },
  { file: /^history\.tsv$/, title: () => "potential energy of a bead in the fit's samples", show: showColumns(["potential_energy"]),
    when: hasColumns(["potential_energy"]) },
  { file: /^history\.tsv$/, title: () => "directions of Φ that follow the data", show: showColumns(["directions"]), when: hasColumns(["directions"]) },
  { file: /^history\.tsv$/, title: () => "step and samples", show: showColumns(["damping", "disagreement", "acceptance"]), when: hasColumns(["damping"]) },
  { file: /^history\.tsv$/, title: () => "diversity of the population", show: showColumns(["diversity"]), when: hasColumns(["diversity"]) },
  { file: /^history\.tsv$/, title: () => "simulations that failed", show: showColumns(["failures"]), when: positive(["failures"]) },
  { file: /^(vacf|msd|structure_factor|force_covariance)\.tsv$/, title: functionOf, show: showTarget },
  { file: /^motion\.tsv$/, title: () => "mean-square displacement", show: showColumns(["msd"]) },
  { file: /^motion\.tsv$/, title: () => "velocity autocorrelation", show: showColumns(["vacf"]), when: hasColumns(["vacf"]) },
  { file: /^thermodynamics\.tsv$/, title: () => "temperatures", show: showColumns(["temperature_configurational", "temperature"]) },
  { file: /^thermodynamics\.tsv$/, title: () => "potential energy of a bead", show: showColumns(["potential_energy"]) },
  { file: /^thermodynamics\.tsv$/, title: () => "pressure", show: showColumns(["pressure"]) },
  { file: /^(polarity|polar_order|clusters|local_density|speeds|collisions|flow_profile|pareto_history)\.tsv$/,
    title: (n) => n.replace(".tsv", "").replaceAll("_", " "),
    show: (plot, table) => showColumns([table.columns[1].name])(plot, table) },
];

export class Curves {
  constructor(parent) {
    this.parent = parent;
    this.plots = new Map();
    this.tables = new Map();
    this.other = new Map();
  }

  update(changed) {
    keep(this.tables, changed);
    kinds.forEach((kind, number) => {
      const names = [...this.tables.keys(), ...changed.keys()].filter((name) => kind.file.test(name));
      for (const name of new Set(names))
        this.showOne(kind, number, name);
    });
  }

  showOne(kind, number, name) {
    const key = number + name, table = this.tables.get(name);
    if (!table || table.length === 0 || (kind.when && !kind.when(table))) {
      this.plots.get(key)?.remove();
      this.plots.delete(key);
      return;
    }
    if (!this.plots.has(key)) {
      const plot = new Plot(this.parent, kind.title(name), { logarithmic: kind.logarithmic, range: kind.range });
      plot.figure.dataset.table = name;
      this.plots.set(key, plot);
    }
    kind.show(this.plots.get(key), table, name, this);
  }

  compare(tables) {
    this.other = tables;
    this.update(new Map());
    return [...tables.keys()].filter((name) => otherOf(this, name)).length;
  }

  clear() {
    this.plots.forEach((plot) => plot.remove());
    this.plots.clear();
    this.tables.clear();
    this.other.clear();
  }

  get count() {
    return this.plots.size;
  }
}
