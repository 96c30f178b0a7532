"use strict";

/** Draws the cells of a plane as a map of colours. */
class PlaneLayer {
  constructor(canvas) {
    this.context = canvas.getContext("2d");
    this.cells = document.createElement("canvas");
  }

  clear() {
    const { context } = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, context.canvas.width, context.canvas.height);
  }

  draw(movie, { colours, shares: own, camera }) {
    const { context } = this;
    const [columns, rows] = movie.plane.cells;
    const small = this.cells.getContext("2d");
    Object.assign(this.cells, { width: columns, height: rows });
    const image = small.createImageData(columns, rows);
    const pixels = new Uint32Array(image.data.buffer);
    const palette = new Uint32Array(colours.buffer);
    // Rows of an image go down, those of cells up.
    for (let k = 0; k < own.length; k += 1) pixels[(rows - 1 - Math.floor(k / columns)) * columns + (k % columns)] = palette[own[k]];
    small.putImageData(image, 0, 0);
    this.clear();
    const ratio = context.canvas.width / camera.width;
    const [low, high] = movie.plane.corners;
    const [left, bottom] = camera.project(low);
    const [right, top] = camera.project(high);
    context.imageSmoothingEnabled = false;
    context.drawImage(this.cells, left * ratio, top * ratio, (right - left) * ratio, (bottom - top) * ratio);
  }
}

/** The cell below a pixel; none outside. */
function cellAt(movie, camera, [x, y]) {
  const [columns, rows] = movie.plane.cells;
  const [low, high] = movie.plane.corners;
  const at = camera.unproject([x, y]);
  const [i, j] = [0, 1].map((k) => Math.floor(((at[k] - low[k]) / (high[k] - low[k])) * movie.plane.cells[k]));
  return i >= 0 && j >= 0 && i < columns && j < rows ? j * columns + i : -1;
}
