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
  float shade = mix(mix(1.0, 0.72, smoothstep(0.78, 1.0, away)), sphere, lit);
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

/** Draws points without a graphics processor: writes the pixels of their circles, the nearest last. */
class PointsOnCanvas {
  constructor(canvas) {
    Object.assign(this, { canvas, context: canvas.getContext("2d") });
  }

  clear() {
    this.context.clearRect(0, 0, this.canvas.width, this.canvas.height);
  }

  /** An image as large as the canvas, with nothing in it. */
  fresh() {
    const { width, height } = this.canvas;
    if (!this.image || this.image.width !== width || this.image.height !== height) {
      this.image = this.context.createImageData(width, height);
      this.pixels = new Uint32Array(this.image.data.buffer);
      this.depths = new Float32Array(width * height);
    }
    this.pixels.fill(0);
    this.depths.fill(-Infinity);
  }

  draw(movie, frame, { colours, shares: own, camera }) {
    this.fresh();
    const ratio = this.canvas.width / camera.width;
    const palette = new Uint32Array(colours.buffer);
    const { x, y, depth, size } = projected(movie, frame, camera);
    for (let k = 0; k < x.length; k += 1) {
      this.disk(x[k] * ratio, y[k] * ratio, Math.max(size[k] * ratio, 0.7), depth[k], palette[own ? own[k] : 255]);
    }
    this.context.putImageData(this.image, 0, 0);
  }

  /** Writes the pixels whose middles lie in a circle and that nothing nearer has. */
  disk(x, y, radius, depth, colour) {
    const { depths, pixels, image: { width, height } } = this;
    const [first, last] = [Math.max(0, Math.ceil(y - radius - 0.5)), Math.min(height - 1, Math.floor(y + radius - 0.5))];
    for (let row = first; row <= last; row += 1) {
      const half = Math.sqrt(Math.max(0, radius * radius - (row + 0.5 - y) ** 2));
      const end = row * width + Math.min(width - 1, Math.floor(x + half - 0.5));
      for (let at = row * width + Math.max(0, Math.ceil(x - half - 0.5)); at <= end; at += 1) {
        if (depths[at] > depth) continue;
        depths[at] = depth;
        pixels[at] = colour;
      }
    }
  }
}

/** Pixels from the left and the top, depths, and radii in pixels of all points. */
function projected(movie, frame, camera) {
  const count = movie.counts[frame];
  const [x, y, depth, size] = [0, 1, 2, 3].map(() => new Float32Array(count));
  const places = movie.places.map((place) => movie.decoded(place, frame));
  const radii = movie.radius ? movie.decoded(movie.radius, frame) : null;
  const guess = movie.radius ? 0 : movie.guessedRadius();
  // Along the screen a place changes what is seen by the same numbers everywhere: the camera has no perspective.
  const zero = camera.project(places.map(() => 0));
  const along = places.map((_, axis) => camera.project(places.map((__, other) => (axis === other ? 1 : 0))).map((end, k) => end - zero[k]));
  x.fill(zero[0]);
  y.fill(zero[1]);
  depth.fill(zero[2]);
  places.forEach((values, axis) => {
    const [dx, dy, away] = along[axis];
    for (let k = 0; k < count; k += 1) {
      x[k] += dx * values[k];
      y[k] += dy * values[k];
      depth[k] += away * values[k];
    }
  });
  for (let k = 0; k < count; k += 1) size[k] = (radii ? radii[k] : guess) * camera.scale;
  return { x, y, depth, size };
}

/** More points than this are too many for a graphics processor that is only imitated. */
const MOST_IMITATED = 20000;

function isImitated(gl) {
  const about = gl.getExtension("WEBGL_debug_renderer_info");
  const name = gl.getParameter(about ? about.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

/** What draws up to so many points on a canvas, as good as the browser can. */
function pointsOn(canvas, most) {
  try {
    const gl = canvas.getContext("webgl2", { antialias: false });
    if (gl && !(most > MOST_IMITATED && isImitated(gl))) return new PointsOnGraphics(canvas, gl);
  } catch (error) {
    console.info(`points are drawn without a graphics processor: ${error.message}`);
  }
  // A canvas keeps the kind of drawing it was first asked for.
  const other = canvas.cloneNode();
  canvas.replaceWith(other);
  return new PointsOnCanvas(other);
}
