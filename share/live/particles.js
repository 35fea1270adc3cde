// SPDX-License-Identifier: GPL-3.0-or-later
// The particles as points of WebGL, turned by mouse, touch and keys.
import { ask } from "/server.js";

const head = 64, mostTypes = 8, nameSize = 16;
// Those of figures, by types (plots/style.gp).
const typeColours = ["#0072b2", "#d55e00", "#009e73", "#aa4499", "#e69f00", "#56b4e9", "#882255", "#7a7a1f"];
const colours = typeColours.map((hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255));

const vertexProgram = `
attribute vec3 place; attribute float shade;
uniform mat3 turn; uniform vec3 box; uniform float scale, aspect, bead, coloured, slice, sliceAt, height;
uniform vec3 colours[8];
varying vec3 colour; varying float depth;
void main() {
  float largest = max(box.x, max(box.y, box.z));
  vec3 p = turn * ((place - 0.5 * box) / largest);
  float z = p.z + 0.9;
  float near = 1.0 / (2.6 - p.z);
  gl_Position = vec4(p.x * scale * near * 2.6 / aspect, p.y * scale * near * 2.6, -p.z * 0.3, 1.0);
  gl_PointSize = max(1.5, bead * scale * height * near / largest);
  depth = clamp(z / 1.8, 0.0, 1.0);
  if (box.z > 0.0 && abs(place.z / box.z - sliceAt) > 0.5 * slice) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if (coloured < 0.5) {
    colour = colours[0];
    for (int k = 1; k < 8; k++) if (abs(shade - float(k)) < 0.5) colour = colours[k];
  } else if (coloured < 1.5) {
    float t = clamp(shade, 0.0, 1.0);
    colour = vec3(0.15 + 0.85 * t * t, 0.2 + 0.7 * t, 0.9 - 0.7 * t);
  } else {
    colour = 0.55 + 0.45 * cos(6.2831853 * (shade + vec3(0.0, 0.33, 0.67)));
  }
}`;
const fragmentProgram = `
precision mediump float; varying vec3 colour; varying float depth;
void main() {
  vec2 p = 2.0 * gl_PointCoord - 1.0; float r = dot(p, p);
  if (r > 1.0) discard;
  float light = 0.45 + 0.55 * sqrt(1.0 - r);
  gl_FragColor = vec4(colour * light * (0.35 + 0.65 * depth), 1.0);
}`;

function compile(gl, kind, text) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
    throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

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
  const text = new TextDecoder();
  frame.names = types.map((_, k) => text.decode(new Uint8Array(buffer, at + nameSize * k, nameSize)).replace(/\0.*/s, ""));
  return frame;
}

export class Particles {
  constructor(canvas, { scene, frames, colours, types }) {
    Object.assign(this, { canvas, scene, frames, colours, types, hidden: new Set(), range: "", turn: [1, 0, 0, 0, 1, 0, 0, 0, 1], scale: 1, serial: 0, frame: null, drawn: 0, since: 0, wanted: false });
    this.choice = { colour: "type", slice: 1, sliceAt: 0.5, bead: 1 };
    // Beads are cut out of squares, whose edges are all that smoothing by the browser would see, at four times the work.
    this.gl = canvas.getContext("webgl", { antialias: false, alpha: false });
    if (this.gl)
      this.prepare();
    this.listen();
  }

  prepare() {
    const gl = this.gl, program = gl.createProgram();
    gl.attachShader(program, compile(gl, gl.VERTEX_SHADER, vertexProgram));
    gl.attachShader(program, compile(gl, gl.FRAGMENT_SHADER, fragmentProgram));
    gl.linkProgram(program);
    gl.useProgram(program);
    const uniforms = new Map();
    this.uniform = (name) => uniforms.get(name) || uniforms.set(name, gl.getUniformLocation(program, name)).get(name);
    this.buffers = [["place", 3], ["shade", 1]].map(([name, size]) => {
      const buffer = gl.createBuffer(), at = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(at);
      return { buffer, at, size };
    });
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0.05, 0.063, 0.078, 1);
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
    [frame.places, this.shades].forEach((data, k) => {
      const { buffer, at, size } = this.buffers[k];
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.STREAM_DRAW);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
    });
    gl.uniformMatrix3fv(this.uniform("turn"), false, this.turn);
    gl.uniform3fv(this.uniform("box"), frame.box);
    gl.uniform3fv(this.uniform("colours"), colours.flat());
    for (const [name, value] of Object.entries({ scale: (frame.dimensions === 2 ? 1.7 : 1.25) * this.scale, aspect: width / height, bead: this.findBead(), coloured: this.coloured,
      slice: this.choice.slice >= 1 ? 2 : this.choice.slice, sliceAt: this.choice.sliceAt, height }))
      gl.uniform1f(this.uniform(name), value);
    let first = 0; // ids of a type follow each other
    frame.types.forEach((number, type) => {
      if (number > 0 && !this.hidden.has(type))
        gl.drawArrays(gl.POINTS, first, number);
      first += number;
    });
    this.countFrame();
  }

  // Beads fill about a quarter of the box, however many there are.
  findBead() {
    const { box, count, dimensions } = this.frame, volume = dimensions === 3 ? box[0] * box[1] * box[2] : box[0] * box[1];
    return this.choice.bead * 0.9 * Math.pow(volume / Math.max(1, count), 1 / dimensions);
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
    this.frame = null;
    this.scene.hidden = true;
  }
}
