// SPDX-License-Identifier: GPL-3.0-or-later
// Tables as the program writes them: a head that begins with #, columns apart by tabs.
import { getText } from "/server.js";

// "g_error[1]" → name and unit.
function parseName(text) {
  const found = /^(.*?)\[(.*)\]$/.exec(text);
  return found ? { name: found[1], unit: found[2] === "1" ? "" : found[2] } : { name: text, unit: "" };
}

// Units and names as a page can write them, and a table's head cannot.
export const pretty = (unit) => unit.replaceAll("lambda", "λ").replaceAll("tau", "τ").replaceAll("k_B.T_0", "k_B T_0")
  .replaceAll("^2", "²").replaceAll("^3", "³").replaceAll("^d", "ᵈ");
const symbols = { phi: "Φ", "phi [degrees]": "φ", theta: "θ", omega: "ω", energy: "U", msd: "MSD", vacf: "VACF", temperature_configurational: "configurational temperature" };
export const symbol = (name) => symbols[name] || name.replaceAll("_", " ");

export function parse(text) {
  const lines = text.split("\n").filter((line) => line.trim());
  const head = lines.filter((line) => line.startsWith("#")).pop() || "#";
  const columns = head.slice(1).trim().split(/\t|\s+/).map(parseName);
  const rows = lines.filter((line) => !line.startsWith("#"))
    .map((line) => line.trim().split(/\t|\s+/).map(Number));
  const table = { columns, rows, length: rows.length };
  table.at = (name) => columns.findIndex((column) => column.name === name);
  table.has = (name) => table.at(name) >= 0;
  table.column = (k) => rows.map((row) => row[k]);
  table.values = (name) => table.column(table.at(name));
  table.unit = (k) => columns[k].unit && ` [${pretty(columns[k].unit)}]`;
  table.label = (k) => (symbols[columns[k].name + table.unit(k)] || symbol(columns[k].name)) + table.unit(k);
  return table;
}

// Put changed tables into a map, and take those out that have gone.
export function keep(map, changed) {
  for (const [name, table] of changed)
    if (table)
      map.set(name, table);
    else
      map.delete(name);
}

// Tables of the folder that is shown, read again when they have changed.
export class Tables {
  constructor() {
    this.place = "result";
    this.known = new Map();
    this.busy = false;
  }

  // What changed, as a map from names to tables; null for those that have gone.
  async update(listing) {
    const changed = new Map();
    if (listing.in !== this.place)
      for (const name of this.known.keys())
        changed.set(name, null);
    const files = listing.files.filter((file) => file.name.endsWith(".tsv") && !file.folder);
    const stamps = listing.in === this.place ? this.known : new Map();
    const now = new Map(files.map((file) => [file.name, listing.in + file.seconds + "/" + file.size]));
    for (const name of this.known.keys())
      if (!now.has(name))
        changed.set(name, null);
    for (const [name, stamp] of now)
      if (stamps.get(name) !== stamp)
        try {
          changed.set(name, parse(await getText("file", { in: listing.in, path: name })));
        } catch { now.delete(name); }
    this.place = listing.in;
    this.known = now;
    return changed;
  }
}
