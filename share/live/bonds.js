// SPDX-License-Identifier: GPL-3.0-or-later
// Bonds as sticks: each half in the colour of its bead, from its rim to the middle of the nearest image.
import { Program } from "/shaders.js";

const vertex = `
attribute vec3 place, way; attribute float shade; attribute vec2 corner;
varying float across;
void main() {
  vec3 p = turn * ((place - 0.5 * box) / largest()), d = turn * way / largest();
  float radius = 0.5 * bead * shown / largest(), rim = radius / max(length(d), 1e-9);
  vec2 side = vec2(-d.y, d.x) / max(length(d.xy), 1e-9);
  p += mix(rim, 1.0, corner.x) * d;
  p.xy += 0.45 * radius * corner.y * side;
  gl_Position = isCut(place) || rim >= 1.0 ? nowhere : project(p);
  colour = paint(shade);
  across = corner.y;
}`;
const fragment = `
precision mediump float; varying vec3 colour; varying float depth, across;
void main() {
  float light = 0.45 + 0.55 * sqrt(1.0 - min(1.0, across * across));
  gl_FragColor = vec4(colour * light * (0.35 + 0.65 * depth), 1.0);
}`;

// Way of a bond to its nearest image.
function wayOf({ places, box }, a, b, way) {
  for (let d = 0; d < 3; d++) {
    way[d] = places[3 * b + d] - places[3 * a + d];
    way[d] -= box[d] > 0 ? box[d] * Math.round(way[d] / box[d]) : 0;
  }
  return way;
}

export function meanBond(frame) {
  const { bonds } = frame, way = [0, 0, 0];
  let sum = 0;
  for (let n = 0; n < bonds.length; n += 2)
    sum += Math.hypot(...wayOf(frame, bonds[n], bonds[n + 1], way));
  return sum / (bonds.length / 2);
}

export class Bonds extends Program {
  constructor(gl) {
    super(gl, vertex, fragment, { place: 3, way: 3, shade: 1, corner: 2 });
    for (const { at } of this.attributes.slice(0, 3))
      gl.vertexAttribDivisor(at, 1);
  }

  draw(view, frame, shades, hidden) {
    const { bonds, types, places } = frame, shown = new Uint8Array(frame.count), way = [0, 0, 0];
    const from = new Float32Array(3 * bonds.length), ways = new Float32Array(3 * bonds.length), shade = new Float32Array(bonds.length);
    let first = 0, halves = 0;
    types.forEach((number, type) => { shown.fill(hidden.has(type) ? 0 : 1, first, first += number); });
    for (let n = 0; n < bonds.length; n += 2) {
      if (!shown[bonds[n]] || !shown[bonds[n + 1]])
        continue;
      wayOf(frame, bonds[n], bonds[n + 1], way);
      for (let end = 0; end < 2; end++, halves++) {
        const id = bonds[n + end];
        for (let d = 0; d < 3; d++) {
          from[3 * halves + d] = places[3 * id + d];
          ways[3 * halves + d] = (end === 0 ? 0.5 : -0.5) * way[d];
        }
        shade[halves] = shades[id];
      }
    }
    this.begin(view, [from, ways, shade, new Float32Array([0, -1, 0, 1, 1, -1, 1, 1])]);
    this.gl.drawArraysInstanced(this.gl.TRIANGLE_STRIP, 0, 4, halves);
  }
}
