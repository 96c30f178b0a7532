"use strict";

const SUPERSCRIPTS = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

/** A number as people read it, to some digits: 0.0123, 1.23 × 10⁻⁵. */
function shown(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) {
    const [front, power] = value.toExponential(digits - 1).split("e");
    const raised = [...power.replace("+", "")].map((sign) => SUPERSCRIPTS[sign]).join("");
    const plain = front.includes(".") ? front.replace(/\.?0+$/, "") : front;
    return `${plain} × 10${raised}`.replace(/^-/, "−");
  }
  return String(Number(value.toPrecision(digits))).replace("-", "−");
}

/** A whole number with thin spaces between thousands. */
function counted(value) {
  return Number.isFinite(value) ? String(Math.round(value)).replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f") : "–";
}

/** A unit to write behind a number; nothing for plain numbers. */
function unitText(unit) {
  return !unit || unit === "1" || unit === "-" ? "" : unit;
}

/** A number with its unit. */
function quantity(value, unit, digits) {
  const text = unitText(unit);
  return shown(value, digits) + (text && Number.isFinite(value) ? `\u00a0${text}` : "");
}

/** A duration as people read it. */
function duration(seconds) {
  if (!Number.isFinite(seconds)) return "–";
  if (seconds < 120) return `${shown(seconds, 3)}\u00a0s`;
  if (seconds < 7200) return `${shown(seconds / 60, 3)}\u00a0min`;
  return `${shown(seconds / 3600, 3)}\u00a0h`;
}

/** A name as words. */
function words(name) {
  return name.replaceAll("_", " ");
}

/** The title of an axis: name and unit. */
function axisTitle(name, unit) {
  return `${words(name)} [${unitText(unit) || "–"}]`;
}

/** Round numbers between two ends, about `count` of them. */
function ticks(low, high, count) {
  const span = high - low;
  if (!(span > 0) || !Number.isFinite(span)) return [low];
  const rough = span / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5].find((factor) => factor * power >= rough * 0.999) || 10);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && found.length < 100; k += 1) found.push(k * step);
  return found;
}

/** The largest round number that is not above a number. */
function roundBelow(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * [5, 2, 1].find((factor) => factor * power <= value * (1 + 1e-9) || factor === 1);
}

/** Powers of ten between two ends, and 2 and 5 between them where few. */
function logTicks(low, high) {
  const [first, last] = [Math.floor(Math.log10(low)), Math.ceil(Math.log10(high))];
  const every = Math.max(1, Math.ceil((last - first) / 8));
  const factors = last - first <= 2 ? [1, 2, 5] : [1];
  const found = [];
  for (let power = first; power <= last; power += every) {
    for (const factor of factors) found.push(factor * 10 ** power);
  }
  return found.filter((value) => value >= low * 0.999 && value <= high * 1.001);
}

/** Texts of ticks, all with as many digits as their distance needs. */
function tickTexts(values) {
  if (values.length < 2) return values.map((value) => shown(value));
  const step = Math.abs(values[1] - values[0]);
  const largest = Math.max(...values.map(Math.abs));
  const digits = Math.max(1, Math.ceil(Math.log10(largest / step) + 1));
  return values.map((value) => shown(Math.abs(value) < step * 1e-6 ? 0 : value, Math.min(digits, 9)));
}

/** Ends of the finite numbers of some arrays. */
function extent(arrays, isUsed = Number.isFinite) {
  let [low, high] = [Infinity, -Infinity];
  for (const values of arrays) {
    for (const value of values) {
      if (!isUsed(value) || !Number.isFinite(value)) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return low <= high ? [low, high] : null;
}
