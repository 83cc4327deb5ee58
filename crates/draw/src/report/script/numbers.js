// Numbers: unpacked as the run had them, and written for people and for files.
const known = Number.isFinite;

// Values of a column or of a vector: an array, or the bytes of numbers in base 64.
function unpacked(v, size = 8) {
  if (typeof v !== "string") return Float64Array.from(v, (x) => x ?? NaN);
  const raw = atob(v), bytes = new DataView(Uint8Array.from(raw, (c) => c.charCodeAt(0)).buffer);
  return Float64Array.from({ length: raw.length / size }, (_, k) => size === 8 ? bytes.getFloat64(8 * k, true) : bytes.getFloat32(4 * k, true));
}

// A number for people.
const text = (v, digits = 6) => known(v) ? Number(v.toPrecision(digits)).toString() : v === Infinity ? "infinite" : v === -Infinity ? "-infinite" : "n/a";
const withUnit = (v, unit, digits) => `${text(v, digits)} ${known(v) ? unit : ""}`.trimEnd();
const head = (name, unit) => unit ? `${name} [${unit}]` : name;

// A number with 17 significant digits, as the run's own CSV file has it: it reads back as the same number. Where the digits
// left out are just half of the last one, that one becomes even.
function exact(v) {
  if (Number.isNaN(v)) return "";
  if (v === 0) return "0";
  if (!known(v)) return v > 0 ? "inf" : "-inf";
  const [digits, power] = v.toExponential(60).split("e");
  let shown = v.toExponential(16);
  const half = /^-?\d\.\d{15}(\d)50*$/.exec(digits);
  if (half && half[1] % 2 === 0) shown = `${digits.slice(0, digits.indexOf(".") + 17)}e${power}`;
  const [mantissa, exponent] = shown.split("e"), size = Math.abs(v);
  if (size < 1e-4 || size >= 1e15) return `${mantissa}e${Number(exponent)}`;
  // the same digits, with the point where it belongs
  const sign = v < 0 ? "-" : "", all = mantissa.replace(/[-.]/g, ""), at = Number(exponent);
  if (at < 0) return `${sign}0.${"0".repeat(-at - 1)}${all}`;
  return `${sign}${all.slice(0, at + 1)}.${all.slice(at + 1)}`;
}

// Whether values go one way only, gaps aside, and not nowhere.
function monotone(values) {
  let up = true, down = true, first = null, last = null;
  for (const v of values) {
    if (!known(v)) continue;
    first ??= v;
    if (last != null) { up = up && v >= last; down = down && v <= last; }
    last = v;
  }
  return (up || down) && first !== last;
}

// A value at a row, or a share of the way to the next.
function between(values, row, share) {
  const a = values[row], b = values[row + 1];
  return !known(a) || share === 0 || !known(b) ? a : a + share * (b - a);
}
