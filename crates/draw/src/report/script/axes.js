// Axes: from values to pixels, and the round numbers to write beside them.
const STEPS = [1, 2, 5, 10], DEGREES = [1, 2, 5, 10, 15, 30, 45, 90, 180];
const SUPERSCRIPT = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
const decade = (v) => v === 0 || !known(v) ? 0 : Number(v.toExponential().split("e")[1]);
const usable = (v, log) => Math.abs(v) < 1e290 && (!log || v > 1e-290);

// A linear or logarithmic map; `at` is null where a value cannot be drawn.
function scale([low, high], from, to, log) {
  const share = (v) => log ? Math.log(v / low) / Math.log(high / low) : (v - low) / (high - low);
  const at = (v) => usable(v, log) && Math.abs(share(v)) < 1e4 ? from + share(v) * (to - from) : null;
  return { low, high, from, to, log, at };
}

// The range to show for some values, at least a little wide, with a margin as a share of it.
function range(values, log, margin) {
  let low = Infinity, high = -Infinity;
  for (const v of values) if (usable(v, log)) { low = Math.min(low, v); high = Math.max(high, v); }
  if (low > high) [low, high] = log ? [1, 10] : [0, 1];
  if (log) return high / low < 1.0001 ? [low / 2, high * 2] : [low, high];
  const size = Math.max(Math.abs(low), Math.abs(high)), middle = (low + high) / 2;
  // a constant with rounding noise shows as a constant
  if (high - low <= 1e-9 * size) return [middle - (size > 0 ? 0.1 * size : 1), middle + (size > 0 ? 0.1 * size : 1)];
  return [low - margin * (high - low), high + margin * (high - low)];
}

// About so many round ticks: values with their texts, and the power of ten that these leave to the title of the axis.
function ticks(axis, wanted, unit) {
  if (axis.log) return logTicks(axis, wanted);
  const raw = (axis.high - axis.low) / Math.max(1, wanted);
  let step = 10 ** decade(raw);
  if (unit === "deg" && raw > 0.5 && raw <= 180) step = DEGREES.find((s) => s >= raw * 0.9999);
  else step *= STEPS.find((s) => s * step >= raw * 0.9999) ?? 10;
  const magnitude = decade(Math.max(Math.abs(axis.low), Math.abs(axis.high)));
  const power = magnitude >= -3 && magnitude < 5 ? 0 : 3 * Math.floor(magnitude / 3);
  const decimals = Math.min(12, Math.max(0, power - decade(step * 1.0000001))), marks = [];
  const first = Math.ceil(axis.low / step - 1e-9), last = Math.floor(axis.high / step + 1e-9);
  for (let k = first; k <= Math.min(last, first + 50); k++) marks.push([k * step, String(Number((k * step / 10 ** power).toFixed(decimals)) + 0)]);
  return { marks, power };
}

function logTicks(axis, wanted) {
  const first = decade(axis.low), last = decade(axis.high), every = Math.max(1, Math.ceil((last - first) / Math.max(1, wanted))), marks = [];
  for (let power = first; power <= last; power++) for (let digit = 1; digit < 10; digit++) {
    const value = digit * 10 ** power;
    const told = (power - first) % every === 0 && (digit === 1 || (last - first <= 1 && (digit === 2 || digit === 5)));
    if (value >= axis.low * 0.9999 && value <= axis.high * 1.0001 && (told || every === 1)) marks.push([value, told ? text(value, 3) : ""]);
  }
  return { marks, power: 0 };
}

const powerText = (power) => power ? ` × 10${[...String(power)].map((c) => SUPERSCRIPT[c]).join("")}` : "";
