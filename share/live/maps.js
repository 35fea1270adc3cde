// SPDX-License-Identifier: GPL-3.0-or-later
// Panels of two variables: escape times of pairs, and the flow of a solvent.
import { makePanel } from "/plots.js";

// Dark blue to yellow, by a number from 0 to 1.
function shade(value) {
  const t = Math.min(1, Math.max(0, value));
  return [255 * Math.min(1, 0.15 + 1.1 * t * t), 255 * Math.min(1, 0.1 + 0.85 * t), 255 * (0.45 - 0.3 * t * t)];
}

function paint(canvas, columns, rows, value) {
  canvas.width = columns;
  canvas.height = rows;
  const context = canvas.getContext("2d"), image = context.createImageData(columns, rows);
  for (let j = 0; j < rows; j++)
    for (let i = 0; i < columns; i++) {
      const v = value(i, rows - 1 - j), at = 4 * (j * columns + i);
      image.data.set(Number.isFinite(v) ? [...shade(v), 255] : [120, 120, 120, 60], at);
    }
  context.putImageData(image, 0, 0);
}

// Shape times × bins: E(t, r_0), the first column being the time.
function showEscape(panel, table) {
  const bins = table.columns.length - 1;
  paint(panel.canvas, bins, table.length, (i, j) => table.rows[j][i + 1]);
  panel.note.textContent = `E(t, r₀), from 0 (dark) to 1 (bright). Across: r₀, ${bins} bins. Upwards: ${table.label(0)} to ${table.rows[table.length - 1][0]}.`;
}

const axis = (values) => [...new Set(values)].sort((a, b) => a - b);

// Rows of the target's cells: time, r0, target, result.
function showCells(panel, table) {
  const times = axis(table.values("time")), bins = axis(table.values("r0"));
  const at = new Map(table.rows.map((row) => [row[table.at("time")] + "/" + row[table.at("r0")], row]));
  const cell = (i, j, name) => at.get(times[j] + "/" + bins[i])?.[table.at(name)];
  paint(panel.canvas, 2 * bins.length + 1, times.length, (i, j) =>
    i === bins.length ? NaN : i < bins.length ? cell(i, j, "target") : cell(i - bins.length - 1, j, "result"));
  panel.note.textContent = `E(t, r₀) of the target (left) and the result (right). Upwards: ${table.label(table.at("time"))} to ${times[times.length - 1]}.`;
}

// Cells of a solvent: colour by the speed, arrows along the velocity.
function showFlow(panel, table) {
  const names = table.columns.map((c) => c.name);
  const vx = names.findIndex((n) => /^v(elocity)?_x$/.test(n)), vy = names.findIndex((n) => /^v(elocity)?_y$/.test(n));
  if (vx < 0 || vy < 0)
    return;
  const xs = axis(table.column(0)), ys = axis(table.column(1));
  const at = new Map(table.rows.map((row) => [row[0] + "/" + row[1], row]));
  const speed = (row) => Math.hypot(row[vx], row[vy]);
  const most = Math.max(...table.rows.map(speed).filter(Number.isFinite), 1e-30);
  paint(panel.canvas, xs.length, ys.length, (i, j) => {
    const row = at.get(xs[i] + "/" + ys[j]);
    return row ? speed(row) / most : NaN;
  });
  panel.note.textContent = `speed of the flow, from 0 (dark) to ${most.toPrecision(3)} (bright)`;
}

const kinds = { "etd.tsv": ["escape of pairs", showEscape], "etd_cells.tsv": ["escape of pairs", showCells],
  "flow_field.tsv": ["flow", showFlow] };

export class Maps {
  constructor(parent) {
    this.parent = parent;
    this.panels = new Map();
  }

  update(changed) {
    for (const [name, table] of changed)
      if (kinds[name])
        this.showOne(name, table);
  }

  showOne(name, table) {
    if (!table || !table.length) {
      this.panels.get(name)?.figure.remove();
      this.panels.delete(name);
      return;
    }
    if (!this.panels.has(name)) {
      const figure = makePanel(this.parent, kinds[name][0]);
      const canvas = document.createElement("canvas"), note = document.createElement("p");
      canvas.className = "map";
      canvas.setAttribute("role", "img");
      canvas.setAttribute("aria-label", "map: " + kinds[name][0]);
      figure.append(canvas, note);
      this.panels.set(name, { figure, canvas, note });
    }
    kinds[name][1](this.panels.get(name), table);
  }

  clear() {
    this.panels.forEach((panel) => panel.figure.remove());
    this.panels.clear();
  }

  get count() {
    return this.panels.size;
  }
}
