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

const arrowsAcross = 24, pixelsAcross = 1200;

// Velocities of blocks of cells, as arrows on a canvas of `size` pixels a cell; `most` is as long as a block. Returns their number.
function drawArrows(canvas, size, columns, rows, velocity, most) {
  const context = canvas.getContext("2d"), block = Math.ceil(Math.max(columns, rows) / arrowsAcross);
  let arrows = 0;
  for (let j = 0; j < rows; j += block)
    for (let i = 0; i < columns; i += block) {
      const right = Math.min(i + block, columns), high = Math.min(j + block, rows), scale = 0.5 * block * size / most;
      const mean = meanVelocity(velocity, [i, right], [j, high]);
      if (!mean || Math.hypot(...mean) * scale < 1)
        continue;
      drawArrow(context, [0.5 * (i + right) * size, (rows - 0.5 * (j + high)) * size], [mean[0] * scale, -mean[1] * scale]);
      arrows++;
    }
  return arrows;
}

// About its middle, half of it being (x, y): white with a dark edge.
function drawArrow(context, [middleX, middleY], [x, y]) {
  const tip = [middleX + x, middleY + y];
  context.lineCap = context.lineJoin = "round";
  for (const [colour, width] of [["#0008", 5], ["#fff", 2]]) {
    Object.assign(context, { strokeStyle: colour, lineWidth: width });
    context.beginPath();
    context.moveTo(middleX - x, middleY - y);
    context.lineTo(...tip);
    context.moveTo(tip[0] - 0.6 * x + 0.35 * y, tip[1] - 0.6 * y - 0.35 * x);
    context.lineTo(...tip);
    context.lineTo(tip[0] - 0.6 * x - 0.35 * y, tip[1] - 0.6 * y + 0.35 * x);
    context.stroke();
  }
}

// Of the cells of a block where there is a flow.
function meanVelocity(velocity, [left, right], [low, high]) {
  let x = 0, y = 0, cells = 0;
  for (let j = low; j < high; j++)
    for (let i = left; i < right; i++) {
      const v = velocity(i, j);
      if (v && v.every(Number.isFinite))
        [x, y, cells] = [x + v[0], y + v[1], cells + 1];
    }
  return cells ? [x / cells, y / cells] : null;
}

// Cells of a solvent: colour by the speed, arrows along the velocity.
function showFlow(panel, table) {
  const [vx, vy] = ["v_x", "v_y"].map((name) => table.at(name));
  const xs = axis(table.column(0)), ys = axis(table.column(1));
  const at = new Map(table.rows.map((row) => [row[0] + "/" + row[1], [row[vx], row[vy]]]));
  const velocity = (i, j) => at.get(xs[i] + "/" + ys[j]);
  const speed = (v) => v ? Math.hypot(...v) : NaN;
  const most = Math.max(...[...at.values()].map(speed).filter(Number.isFinite), 1e-30);
  const cells = document.createElement("canvas"), { canvas } = panel;
  paint(cells, xs.length, ys.length, (i, j) => speed(velocity(i, j)) / most);
  const size = Math.ceil(pixelsAcross / xs.length);
  Object.assign(canvas, { width: size * xs.length, height: size * ys.length });
  canvas.style.height = "auto";
  const context = canvas.getContext("2d");
  context.imageSmoothingEnabled = false;
  context.drawImage(cells, 0, 0, canvas.width, canvas.height);
  canvas.dataset.arrows = drawArrows(canvas, size, xs.length, ys.length, velocity, most);
  panel.note.textContent = `Speed of the flow, from 0 (dark) to ${most.toPrecision(3)} (bright), and its direction. Across: x. Upwards: y.`;
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
