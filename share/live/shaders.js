// SPDX-License-Identifier: GPL-3.0-or-later
// Programs of WebGL: what beads and bonds have in common, and the beads.

// Those of figures, by types (plots/style.gp).
export const typeColours = ["#0072b2", "#d55e00", "#009e73", "#aa4499", "#e69f00", "#56b4e9", "#882255", "#7a7a1f"];
const colours = typeColours.flatMap((hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255));

// From the box to the picture. `bead` is the diameter of beads, of which a point shows a part, `shown`.
const common = `
uniform mat3 turn; uniform vec3 box; uniform float scale, aspect, bead, coloured, slice, sliceAt, height;
uniform vec3 colours[8];
varying vec3 colour; varying float depth;
const float shown = 1.0 / 1.3;
float largest() { return max(box.x, max(box.y, box.z)); }
vec4 project(vec3 p) {
  float near = 2.6 / (2.6 - p.z);
  depth = box.z > 0.0 ? clamp(0.64 + p.z / 1.4, 0.0, 1.0) : 1.0; // 1 in front: the colours of figures
  return vec4(p.x * scale * near / aspect, p.y * scale * near, -p.z * 0.3, 1.0);
}
bool isCut(vec3 place) { return box.z > 0.0 && abs(place.z / box.z - sliceAt) > 0.5 * slice; }
const vec4 nowhere = vec4(2.0, 2.0, 2.0, 1.0);
vec3 paint(float shade) {
  if (coloured < 0.5) {
    for (int k = 1; k < 8; k++) if (abs(shade - float(k)) < 0.5) return colours[k];
    return colours[0];
  }
  if (coloured < 1.5) {
    float t = clamp(shade, 0.0, 1.0);
    return vec3(0.15 + 0.85 * t * t, 0.2 + 0.7 * t, 0.9 - 0.7 * t);
  }
  return 0.55 + 0.45 * cos(6.2831853 * (shade + vec3(0.0, 0.33, 0.67)));
}`;

const beadVertex = `
attribute vec3 place; attribute float shade;
void main() {
  vec3 p = turn * ((place - 0.5 * box) / largest());
  gl_Position = isCut(place) ? nowhere : project(p);
  gl_PointSize = max(1.5, bead * scale * height / (2.6 - p.z) / largest());
  colour = paint(shade);
}`;
const beadFragment = `
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

// A program with attributes of its own, of so many numbers each.
export class Program {
  constructor(gl, vertex, fragment, attributes) {
    this.gl = gl;
    this.program = gl.createProgram();
    gl.attachShader(this.program, compile(gl, gl.VERTEX_SHADER, common + vertex));
    gl.attachShader(this.program, compile(gl, gl.FRAGMENT_SHADER, fragment));
    gl.linkProgram(this.program);
    this.uniforms = new Map();
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    this.attributes = Object.entries(attributes).map(([name, size]) => {
      const at = gl.getAttribLocation(this.program, name);
      gl.enableVertexAttribArray(at);
      return { at, size, buffer: gl.createBuffer() };
    });
  }

  uniform(name) {
    if (!this.uniforms.has(name))
      this.uniforms.set(name, this.gl.getUniformLocation(this.program, name));
    return this.uniforms.get(name);
  }

  // Use it, with what the view has and a list of numbers for each attribute.
  begin({ turn, box, ...numbers }, lists) {
    const { gl } = this;
    gl.useProgram(this.program);
    gl.bindVertexArray(this.array);
    gl.uniformMatrix3fv(this.uniform("turn"), false, turn);
    gl.uniform3fv(this.uniform("box"), box);
    gl.uniform3fv(this.uniform("colours"), colours);
    for (const [name, value] of Object.entries(numbers))
      gl.uniform1f(this.uniform(name), value);
    lists.forEach((list, k) => {
      const { at, size, buffer } = this.attributes[k];
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, list, gl.STREAM_DRAW);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
    });
  }
}

export class Beads extends Program {
  constructor(gl) {
    super(gl, beadVertex, beadFragment, { place: 3, shade: 1 });
  }

  // Ids of a type follow each other.
  draw(view, frame, shades, hidden) {
    let first = 0;
    this.begin(view, [frame.places, shades]);
    frame.types.forEach((number, type) => {
      if (number > 0 && !hidden.has(type))
        this.gl.drawArrays(this.gl.POINTS, first, number);
      first += number;
    });
  }
}
