"use strict";

/**
 * Each point is a point of the graphics processor, or a square of four corners where it is larger than such points may be; what lies
 * within its circle is lit as a sphere or drawn as a disk.
 */
const POINT_VERTICES = `
in vec2 corner;
in float x, y, z, radius, share;
uniform vec3 low, span, middle;
uniform vec2 radii, offset, scale;
uniform mat3 turn;
uniform float depth, pixels;
out vec2 place;
out float colour;
void main() {
  vec3 at = turn * (low + vec3(x, y, z) * span - middle);
  float size = radii.x + radius * radii.y;
  colour = share;
#ifdef SQUARES
  place = corner;
  gl_Position = vec4((at.xy + offset + corner * size) * scale, -at.z * depth, 1.0);
#else
  gl_PointSize = max(2.0 * size * pixels, 1.5);
  gl_Position = vec4((at.xy + offset) * scale, -at.z * depth, 1.0);
#endif
}`;
const POINT_COLOURS = `
precision mediump float;
in vec2 place;
in float colour;
uniform sampler2D map;
uniform float lit;
out vec4 shown;
void main() {
#ifdef SQUARES
  vec2 at = place;
#else
  vec2 at = vec2(2.0, -2.0) * (gl_PointCoord - 0.5);
#endif
  float away = dot(at, at);
  float edge = min(fwidth(away), 0.9);
  float there = 1.0 - smoothstep(1.0 - edge, 1.0, away);
  if (there <= 0.0) discard;
  vec4 own = texture(map, vec2((colour * 255.0 + 0.5) / 256.0, 0.5));
  float sphere = 0.62 + 0.45 * sqrt(max(0.0, 1.0 - away)) + 0.16 * (at.y - 0.6 * at.x);
  float shade = mix(mix(1.0, 0.72, smoothstep(0.6, 1.0, away)), sphere, lit);
  shown = vec4(min(own.rgb * shade, 1.0) * there, there);
}`;
const POINT_NUMBERS = ["corner", "x", "y", "z", "radius", "share"];
/** Pixels up to which points of the graphics processor are taken: such points vanish as soon as their centres leave the picture. */
const LARGEST_POINT = 60;
/** More points than this are never drawn as squares, of which some processors draw one at a time. */
const MOST_SQUARES = 20000;

function compiled(gl, kind, text) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
}

function linked(gl, how) {
  const program = gl.createProgram();
  const head = `#version 300 es\n#define ${how}\n`;
  gl.attachShader(program, compiled(gl, gl.VERTEX_SHADER, head + POINT_VERTICES));
  gl.attachShader(program, compiled(gl, gl.FRAGMENT_SHADER, head + POINT_COLOURS));
  POINT_NUMBERS.forEach((name, place) => gl.bindAttribLocation(program, place, name));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  return program;
}

/** Draws points on a graphics processor. */
class PointsOnGraphics {
  constructor(canvas, gl) {
    Object.assign(this, { canvas, gl, buffers: new Map(), held: new Map() });
    this.programs = { squares: linked(gl, "SQUARES"), points: linked(gl, "POINTS") };
    this.largest = Math.min(LARGEST_POINT, gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE)[1]);
    this.fill("corner", new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), 2, gl.FLOAT);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    gl.enable(gl.DEPTH_TEST);
    // Edges are smooth: colours come multiplied by how much of a pixel they cover.
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.clearColor(0, 0, 0, 0);
  }

  /** Fills the numbers of an attribute, unless they are there already. */
  fill(name, values, size, kind) {
    const { gl } = this;
    if (this.held.get(name) === values) return;
    this.held.set(name, values);
    if (!this.buffers.has(name)) this.buffers.set(name, gl.createBuffer());
    const place = POINT_NUMBERS.indexOf(name);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.get(name));
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, kind, kind !== gl.FLOAT, 0, 0);
  }

  /** A number that all points share. */
  same(name, value) {
    const place = POINT_NUMBERS.indexOf(name);
    this.held.delete(name);
    this.gl.disableVertexAttribArray(place);
    this.gl.vertexAttrib1f(place, value);
  }

  set(name, ...values) {
    this.gl[`uniform${values.length}f`](this.gl.getUniformLocation(this.program, name), ...values);
  }

  clear() {
    this.gl.clear(this.gl.COLOR_BUFFER_BIT | this.gl.DEPTH_BUFFER_BIT);
  }

  draw(movie, frame, { colours, shares: own, camera }) {
    const { gl } = this;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    this.clear();
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, colours);
    const fill = (name, channel) => (channel ? this.fill(name, movie.raw(channel, frame), 1, gl.UNSIGNED_SHORT) : this.same(name, 0));
    ["x", "y", "z"].forEach((name, k) => fill(name, movie.places[k]));
    fill("radius", movie.radius);
    if (own) this.fill("share", own, 1, gl.UNSIGNED_BYTE);
    else this.same("share", 1);
    const count = movie.counts[frame];
    const pixels = (camera.scale * this.canvas.width) / camera.width;
    const areSquares = 2 * movie.largestRadius() * pixels > this.largest && count <= MOST_SQUARES;
    this.program = this.programs[areSquares ? "squares" : "points"];
    gl.useProgram(this.program);
    this.setView(movie, camera, pixels);
    POINT_NUMBERS.forEach((name, place) => gl.vertexAttribDivisor(place, areSquares && place ? 1 : 0));
    if (areSquares) return gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    gl.disableVertexAttribArray(0);
    gl.drawArrays(gl.POINTS, 0, count);
    return gl.enableVertexAttribArray(0);
  }

  setView(movie, camera, pixels) {
    const { gl } = this;
    const three = (of) => [0, 1, 2].map((k) => (movie.places[k] ? of(movie.places[k]) : 0));
    this.set("low", ...three((place) => place.low));
    this.set("span", ...three((place) => place.step * 65535));
    const { radius } = movie;
    this.set("radii", ...(radius ? [radius.low, radius.step * 65535] : [movie.guessedRadius(), 0]));
    this.set("middle", ...camera.middle);
    this.set("offset", ...camera.offset);
    gl.uniformMatrix3fv(gl.getUniformLocation(this.program, "turn"), false, camera.turn);
    this.set("scale", (2 * camera.scale) / camera.width, (2 * camera.scale) / camera.height);
    this.set("depth", movie.inSpace ? 1 / camera.depth : 0);
    this.set("pixels", pixels);
    this.set("lit", movie.inSpace ? 1 : 0);
    gl.depthFunc(movie.inSpace ? gl.LESS : gl.ALWAYS);
  }
}

/** Draws points without a graphics processor: slower, and without light. */
class PointsOnCanvas {
  constructor(canvas) {
    this.context = canvas.getContext("2d");
  }

  clear() {
    this.context.setTransform(1, 0, 0, 1, 0, 0);
    this.context.clearRect(0, 0, this.context.canvas.width, this.context.canvas.height);
  }

  draw(movie, frame, { colours, shares: own, camera }) {
    const { context } = this;
    const ratio = context.canvas.width / camera.width;
    this.clear();
    const places = projected(movie, frame, camera);
    const order = Array.from(places.keys());
    if (movie.inSpace) order.sort((a, b) => places[a][2] - places[b][2]);
    for (const k of order) {
      const [x, y, , size] = places[k];
      const at = 4 * (own ? own[k] : 255);
      context.fillStyle = `rgb(${colours[at]},${colours[at + 1]},${colours[at + 2]})`;
      context.beginPath();
      context.arc(x * ratio, y * ratio, Math.max(size * ratio, 0.7), 0, 7);
      context.fill();
    }
  }
}

/** Pixels from the left and the top, depth, and radius in pixels of all points. */
function projected(movie, frame, camera) {
  const places = movie.places.map((place) => movie.decoded(place, frame));
  const radii = movie.radius ? movie.decoded(movie.radius, frame) : null;
  const guess = movie.radius ? 0 : movie.guessedRadius();
  return Array.from({ length: movie.counts[frame] }, (_, k) => {
    const [x, y, depth] = camera.project(places.map((axis) => axis[k]));
    return [x, y, depth, (radii ? radii[k] : guess) * camera.scale];
  });
}

/** What draws points on a canvas, as good as the browser can. */
function pointsOn(canvas) {
  try {
    const gl = canvas.getContext("webgl2", { antialias: false });
    if (gl) return new PointsOnGraphics(canvas, gl);
  } catch (error) {
    console.warn(`points are drawn without a graphics processor: ${error.message}`);
    const other = canvas.cloneNode();
    canvas.replaceWith(other);
    return new PointsOnCanvas(other);
  }
  return new PointsOnCanvas(canvas);
}
