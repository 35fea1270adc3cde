// SPDX-License-Identifier: GPL-3.0-or-later
// The particles as points of WebGL, turned by mouse, touch and keys.
import { ask } from "/server.js";
import { Bonds, meanBond } from "/bonds.js";
import { Beads, typeColours } from "/shaders.js";

const head = 64, mostTypes = 8, nameSize = 16;

// The number below which so large a part of them lies, by some hundreds of them.
function percentile(numbers, part) {
  const stride = Math.max(1, Math.floor(numbers.length / 500));
  const some = Float32Array.from({ length: Math.ceil(numbers.length / stride) }, (_, k) => numbers[k * stride]).sort();
  return some[Math.floor(part * (some.length - 1))];
}

function parse(buffer) {
  const view = new DataView(buffer), little = true;
  const count = view.getUint32(4, little), parts = view.getUint32(12, little);
  const types = Array.from(new Uint32Array(buffer, head, mostTypes));
  let at = head + 4 * mostTypes;
  const take = (numbers) => { const list = new Float32Array(buffer, at, numbers); at += 4 * numbers; return list; };
  const frame = { count, dimensions: view.getUint32(8, little), types, step: view.getFloat64(24, little), time: view.getFloat64(32, little),
    box: [40, 44, 48].map((k) => view.getFloat32(k, little)), places: take(3 * count), speeds: take(count),
    polarities: parts & 1 ? take(2 * count) : null, energies: parts & 2 ? take(count) : null, hasPotential: (parts & 4) !== 0 };
  frame.bonds = new Uint32Array(buffer, at, 2 * view.getUint32(20, little));
  at += frame.bonds.byteLength;
  const text = new TextDecoder();
  frame.names = types.map((_, k) => text.decode(new Uint8Array(buffer, at + nameSize * k, nameSize)).replace(/\0.*/s, ""));
  return frame;
}

export class Particles {
  constructor(canvas, { scene, frames, colours, types }) {
    Object.assign(this, { canvas, scene, frames, colours, types, hidden: new Set(), range: "", turn: [1, 0, 0, 0, 1, 0, 0, 0, 1], scale: 1, serial: 0, frame: null, drawn: 0, since: 0, wanted: false });
    this.choice = { colour: "type", slice: 1, sliceAt: 0.5, bead: 1 };
    // Beads are cut out of squares, whose edges are all that smoothing by the browser would see, at four times the work.
    this.gl = canvas.getContext("webgl2", { antialias: false, alpha: false });
    if (this.gl)
      this.prepare();
    this.listen();
  }

  prepare() {
    this.beads = new Beads(this.gl);
    this.bonds = new Bonds(this.gl);
    this.gl.enable(this.gl.DEPTH_TEST);
    this.gl.clearColor(0.05, 0.063, 0.078, 1);
  }

  // Ask for frames while they are wanted and seen; a slow browser asks less often.
  async follow() {
    if (this.wanted)
      return;
    this.wanted = true;
    while (this.wanted) {
      const begun = performance.now();
      if (!document.hidden && this.gl)
        try {
          const answer = await ask("particles", { after: this.serial, ...(this.choice.colour === "energy" ? { energies: 1 } : {}) });
          const buffer = await answer.arrayBuffer();
          if (buffer.byteLength > head) {
            this.serial = Number(answer.headers.get("X-Mesofit-Serial"));
            this.take(parse(buffer));
          }
        } catch { this.wanted = false; }
      await new Promise((done) => setTimeout(done, document.hidden ? 500 : Math.max(5, 30 - (performance.now() - begun))));
    }
  }

  // A scene may have a solvent alone.
  take(frame) {
    if (frame.count === 0)
      return;
    this.frame = frame;
    this.shades = null;
    this.offer();
    this.offerTypes();
    this.show();
  }

  // The legend: types in their colours, each of which can be left out.
  offerTypes() {
    const { names, types } = this.frame, known = names.filter((name, k) => name && types[k]);
    if (this.types.dataset.names === known.join(" "))
      return;
    this.types.dataset.names = known.join(" ");
    this.hidden.clear();
    this.types.replaceChildren(...names.map((name, k) => {
      const label = document.createElement("label"), box = document.createElement("input"), bead = document.createElement("span");
      Object.assign(box, { type: "checkbox", checked: true });
      bead.className = "bead";
      bead.style.background = typeColours[k];
      box.addEventListener("change", () => { this.hidden[box.checked ? "delete" : "add"](k); this.show(); });
      label.append(box, bead, name);
      label.hidden = !name || !types[k];
      return label;
    }));
  }

  leave() {
    this.wanted = false;
  }

  show() {
    if (this.scene.hidden)
      this.scene.hidden = false;
    if (this.pending)
      return;
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.draw(); });
  }

  findShades() {
    const { count, types, speeds, polarities, energies, places, box } = this.frame, shades = new Float32Array(count);
    const choice = this.choice.colour;
    this.range = "";
    if (choice === "type") {
      let id = 0;
      types.forEach((number, type) => { for (let k = 0; k < number && id < count; k++) shades[id++] = type; });
    } else if (choice === "speed") {
      const most = percentile(speeds, 0.98) || 1;
      for (let k = 0; k < count; k++)
        shades[k] = speeds[k] / most;
    } else if (choice === "energy" && energies) {
      const low = percentile(energies, 0.02), high = percentile(energies, 0.98);
      for (let k = 0; k < count; k++)
        shades[k] = (energies[k] - low) / (high - low || 1);
      this.range = `, energy ${low.toPrecision(3)} (blue) to ${high.toPrecision(3)} (yellow) k_B T_0`;
    } else if (choice === "polarity" && polarities) {
      for (let k = 0; k < count; k++)
        shades[k] = 0.5 + Math.atan2(polarities[2 * k + 1], polarities[2 * k]) / (2 * Math.PI);
    } else {
      for (let k = 0; k < count; k++)
        shades[k] = box[2] > 0 ? places[3 * k + 2] / box[2] : places[3 * k + 1] / box[1];
    }
    this.coloured = choice === "type" ? 0 : choice === "polarity" && polarities ? 2 : 1;
    return shades;
  }

  // Colours that this simulation has.
  offer() {
    const { polarities, speeds, hasPotential } = this.frame;
    const has = { type: true, depth: true, speed: Number.isFinite(speeds[0]), energy: hasPotential, polarity: polarities !== null };
    for (const option of this.colours.options)
      option.disabled = !has[option.value];
    if (!has[this.choice.colour])
      this.choice.colour = this.colours.value = "type";
  }

  draw() {
    const { gl, frame, canvas } = this;
    if (!gl || !frame)
      return;
    const ratio = window.devicePixelRatio || 1, width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.shades = this.shades || this.findShades();
    const view = { turn: this.turn, box: frame.box, scale: (frame.dimensions === 2 ? 1.7 : 1.25) * this.scale, aspect: width / height, bead: this.findBead(), coloured: this.coloured,
      slice: this.choice.slice >= 1 ? 2 : this.choice.slice, sliceAt: this.choice.sliceAt, height };
    this.beads.draw(view, frame, this.shades, this.hidden);
    if (frame.bonds.length > 0)
      this.bonds.draw(view, frame, this.shades, this.hidden);
    this.countFrame();
  }

  // Beads fill about a quarter of the box, however many there are, unless they would hide their bonds.
  findBead() {
    const { box, count, dimensions, bonds } = this.frame, volume = dimensions === 3 ? box[0] * box[1] * box[2] : box[0] * box[1];
    if (bonds.length > 0)
      this.bond ??= meanBond(this.frame);
    return this.choice.bead * Math.min(0.9 * Math.pow(volume / Math.max(1, count), 1 / dimensions), 0.5 * (this.bond ?? Infinity));
  }

  // Told twice a second, and also of a frame after which none comes.
  countFrame() {
    this.drawn++;
    this.telling = this.telling || setTimeout(() => this.tellFrames(), 500);
  }

  tellFrames() {
    const now = performance.now();
    this.telling = null;
    if (!this.frame)
      return;
    this.frames.textContent = `${this.frame.count} beads, step ${this.frame.step}, ${(1000 * this.drawn / (now - this.since)).toFixed(0)} frames/s${this.range}`;
    this.drawn = 0;
    this.since = now;
  }

  rotate(x, y) {
    const [cx, sx, cy, sy] = [Math.cos(x), Math.sin(x), Math.cos(y), Math.sin(y)], m = this.turn;
    for (let c = 0; c < 3; c++) { // the columns of the matrix, turned about the screen's axes
      const [a, b, d] = m.slice(3 * c, 3 * c + 3), e = cx * a + sx * d, f = cx * d - sx * a;
      m.splice(3 * c, 3, e, cy * b - sy * f, sy * b + cy * f);
    }
    this.canvas.dataset.turn = m.map((v) => v.toFixed(3)).join(" ");
    this.show();
  }

  zoom(factor) {
    this.scale = Math.min(8, Math.max(0.2, this.scale * factor));
    this.show();
  }

  choose(name, value) {
    this.choice[name] = value;
    this.shades = null;
    if (this.frame)
      this.show();
  }

  listen() {
    const { canvas } = this;
    let last = null;
    canvas.addEventListener("pointerdown", (event) => { last = event; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener("pointermove", (event) => {
      if (last) {
        this.rotate((event.clientX - last.clientX) * 0.01, (event.clientY - last.clientY) * 0.01);
        last = event;
      }
    });
    for (const end of ["pointerup", "pointercancel"])
      canvas.addEventListener(end, () => { last = null; });
    canvas.addEventListener("wheel", (event) => { event.preventDefault(); this.zoom(Math.exp(-0.001 * event.deltaY)); }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
      if (turns[event.key]) {
        event.preventDefault();
        this.rotate(...turns[event.key]);
      } else if (event.key === "+" || event.key === "-") {
        this.zoom(event.key === "+" ? 1.15 : 1 / 1.15);
      }
    });
    window.addEventListener("resize", () => this.frame && this.show());
  }

  clear() {
    this.leave();
    this.frame = this.bond = null;
    this.scene.hidden = true;
  }
}
