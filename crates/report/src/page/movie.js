"use strict";

/** Frames over time of one collection: when they are, and the numbers in them. */
class Movie {
  constructor(data) {
    Object.assign(this, data);
    this.places = this.channels.filter((channel) => channel.place);
    this.inSpace = this.places.length === 3;
    this.radius = this.channels.find((channel) => channel.field === "radius");
    this.choices = this.scalars();
    this.ranges = new Map();
  }

  /** The frame that is shown at a time: the last that is not later. */
  at(time) {
    let [low, high] = [0, this.times.length - 1];
    while (low < high) {
      const middle = Math.ceil((low + high) / 2);
      if (this.times[middle] <= time * (1 + 1e-12) + 1e-300) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  /** Raw numbers of a channel: 0 up to the largest, which stands for what is missing. */
  raw(channel, frame) {
    return numbersOf(channel.arrays[frame], channel.bytes === 1 ? Uint8Array : Uint16Array);
  }

  /** What can be shown by colour: fields, lengths of vectors, and components. */
  scalars() {
    const fields = new Map();
    for (const channel of this.channels.filter((other) => !other.place)) {
      fields.set(channel.field, [...(fields.get(channel.field) || []), channel]);
    }
    return [...fields].flatMap(([field, channels]) => {
      const { unit } = channels[0];
      const isVector = channels.every((channel) => ["x", "y", "z"].includes(channel.component));
      const parts = channels.map((channel) => ({ name: [field, channel.component].filter((text) => text).join("_"), unit, channels: [channel], isLength: false }));
      return isVector && !fields.has("speed") ? [{ name: `${field} (length)`, unit, channels, isLength: true }, ...parts] : parts;
    });
  }

  /** Values of a choice in a frame; NaN where missing. */
  values(choice, frame) {
    const parts = choice.channels.map((channel) => this.decoded(channel, frame));
    if (!choice.isLength) return parts[0];
    return parts[0].map((_, k) => Math.hypot(...parts.map((part) => part[k])));
  }

  decoded(channel, frame) {
    const raw = this.raw(channel, frame);
    const missing = channel.bytes === 1 ? 255 : 65535;
    const values = new Float32Array(raw.length);
    for (let k = 0; k < raw.length; k += 1) values[k] = raw[k] === missing ? NaN : channel.low + raw[k] * channel.step;
    return values;
  }

  /** Ends between which colours lie: of nearly all values of the run, so that few extreme ones do not take all colours. */
  range(choice) {
    if (!this.ranges.has(choice.name)) this.ranges.set(choice.name, this.commonRange(choice));
    return this.ranges.get(choice.name);
  }

  commonRange(choice) {
    const frames = new Set(Array.from({ length: 9 }, (_, k) => Math.round((k * (this.times.length - 1)) / 8)));
    const sample = [];
    for (const frame of frames) {
      const values = this.values(choice, frame);
      const every = Math.max(1, Math.floor(values.length / 4000));
      for (let k = 0; k < values.length; k += every) if (values[k] === values[k]) sample.push(values[k]);
    }
    sample.sort((a, b) => a - b);
    if (!sample.length) return [0, 1];
    return [sample[Math.floor(0.005 * (sample.length - 1))], sample[Math.ceil(0.995 * (sample.length - 1))]];
  }

  /** How far values on the page may be from those of the run. */
  error(choice) {
    return Math.max(...choice.channels.map((channel) => channel.error));
  }

  /** Lower and upper corner of all that is ever there, with the sizes of grains. */
  box() {
    if (this.plane) return this.plane.corners;
    const top = (channel) => channel.low + 65534 * channel.step;
    const around = (margin) => [this.places.map((place) => place.low - margin), this.places.map((place) => top(place) + margin)];
    return around(this.radius ? top(this.radius) : radiusFor(around(0), this.counts[0]));
  }

  largestRadius() {
    return this.radius ? this.radius.low + 65534 * this.radius.step : this.guessedRadius();
  }

  guessedRadius() {
    const [low, high] = this.box();
    return radiusFor([low, high], this.counts[0]) / 1.5;
  }
}

/** Radius to draw points with that have none: half of their distance, were they even in a box. */
function radiusFor([low, high], count) {
  const sizes = low.map((from, k) => high[k] - from);
  const largest = Math.max(...sizes);
  const volume = sizes.reduce((product, size) => product * Math.max(size, 1e-3 * largest), 1);
  return 0.5 * (volume / Math.max(1, count)) ** (1 / low.length);
}

/** Which map and which ends colours have for values between two ends: about zero where they go to both sides. */
function colouring([low, high]) {
  const largest = Math.max(Math.abs(low), Math.abs(high));
  const isSigned = low < 0 && high > 0 && Math.min(-low, high) > 0.05 * largest;
  return isSigned ? { map: "signed", ends: [-largest, largest] } : { map: "viridis", ends: [low, high] };
}
