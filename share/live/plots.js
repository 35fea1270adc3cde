// SPDX-License-Identifier: GPL-3.0-or-later
// Panels with plots of Chart.js, in the colours of figures (plots/style.gp) and, at last, the grey of what is
// compared with.
const palette = ["#0072b2", "#d55e00", "#009e73", "#aa4499", "#e69f00", "#56b4e9", "#882255", "#6b7785"];
const dark = matchMedia("(prefers-color-scheme: dark)");
const all = new Set();

const ink = () => getComputedStyle(document.documentElement).getPropertyValue("--ink").trim();
const line = () => getComputedStyle(document.documentElement).getPropertyValue("--line").trim();
dark.addEventListener("change", () => all.forEach((plot) => plot.recolour()));

export const colour = (k) => palette[k % palette.length];
export const translucent = (hex, part) => hex + Math.round(255 * part).toString(16).padStart(2, "0");

export function makePanel(parent, title) {
  const figure = document.createElement("figure");
  figure.className = "panel";
  const caption = document.createElement("figcaption");
  caption.textContent = title;
  figure.append(caption);
  parent.append(figure);
  return figure;
}

export const points = (x, y) => {
  const list = [];
  for (let k = 0; k < x.length; k++)
    if (Number.isFinite(x[k]) && Number.isFinite(y[k]))
      list.push({ x: x[k], y: y[k] });
  return list;
};

// A curve.
export const curve = (label, x, y, k, more = {}) => ({
  label, data: points(x, y), borderColor: colour(k), backgroundColor: colour(k), borderWidth: 2, pointRadius: 0, ...more });

// The band of ±1.96 standard errors about a curve, as two datasets without a name.
export function band(x, y, error, k) {
  const fill = translucent(colour(k), 0.22);
  const edge = { label: "", borderWidth: 0, pointRadius: 0, backgroundColor: fill, borderColor: fill };
  const width = error.map((e) => (Number.isFinite(e) ? 1.96 * e : 0));
  return [{ ...edge, data: points(x, y.map((v, n) => v - width[n])) },
    { ...edge, data: points(x, y.map((v, n) => v + width[n])), fill: "-1" }];
}

// 0, where no curve goes below it and they are not all far above: bands alone may end below.
function fromZero(datasets) {
  const values = datasets.filter((set) => set.label).flatMap((set) => set.data.map((p) => p.y));
  const low = Math.min(...values), high = Math.max(...values);
  return values.length && low >= 0 && low < high / 4 ? 0 : undefined;
}

export class Plot {
  constructor(parent, title, { x = "", y = "", logarithmic = false, kind = "line", click = null, range = null } = {}) {
    this.figure = makePanel(parent, title);
    const box = document.createElement("div");
    box.className = "plot";
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `plot: ${title}`);
    box.append(this.canvas);
    this.figure.append(box);
    this.note = document.createElement("p");
    this.figure.append(this.note);
    this.range = range;
    this.chart = new window.Chart(this.canvas, {
      type: kind, data: { datasets: [] },
      options: {
        animation: false, responsive: true, maintainAspectRatio: false, parsing: false, normalized: true,
        interaction: { mode: "nearest", intersect: false, axis: kind === "scatter" ? "xy" : "x" },
        onClick: click ? (event, found) => found.length && click(found[0], this.chart, found) : undefined,
        scales: {
          x: { type: "linear", title: { display: true, text: x } },
          y: { type: logarithmic ? "logarithmic" : "linear", title: { display: true, text: y } } },
        plugins: { legend: { labels: { boxWidth: 14, filter: (item) => item.text } },
          tooltip: { filter: (item) => item.dataset.label !== "" } } } });
    all.add(this);
    this.recolour();
  }

  recolour() {
    for (const scale of Object.values(this.chart.options.scales)) {
      scale.grid = { color: line() };
      scale.ticks = { ...scale.ticks, color: ink(), includeBounds: false };
      scale.title.color = ink();
    }
    this.chart.options.plugins.legend.labels.color = ink();
    this.chart.update("none");
  }

  show(datasets, { x, y } = {}) {
    const scales = this.chart.options.scales;
    if (x)
      scales.x.title.text = x;
    if (x === "iteration")
      scales.x.ticks.precision = 0;
    if (y)
      scales.y.title.text = y;
    // What comes later lies above what came before, which Chart.js does the other way round.
    this.chart.data.datasets = datasets.map((set, k) => ({ ...set, order: datasets.length - k }));
    if (this.range)
      [scales.y.min, scales.y.max] = this.range(datasets);
    else if (scales.y.type === "linear")
      scales.y.min = fromZero(datasets);
    this.chart.options.plugins.legend.display = datasets.filter((set) => set.label).length > 0;
    this.chart.update("none");
  }

  say(text) {
    this.note.textContent = text;
  }

  remove() {
    all.delete(this);
    this.chart.destroy();
    this.figure.remove();
  }
}
