// A plot drawn for the width it has, with text of one size whatever that is.
const LINE = 16; // height of a line of text, pixels
const EDGE = 8;
const MARKS = { dead: ["--error", "6 4"], change: ["--warning", "2 4"], limit: ["--error", "none"], event: ["--muted", "2 4"] };
const color = (k) => `var(--series-${k % 6 + 1})`;
const finite = (curve) => curve.fine ?? [curve.x, curve.y];

// Writes a text; `more` are further attributes.
function words(parent, string, x, y, more = {}) {
  const e = element("text", { x: round(x), y: round(y), "font-size": FONT, fill: "var(--ink)", ...more }, parent);
  e.textContent = string;
  return e;
}
const halo = { stroke: "var(--background)", "stroke-width": 3, "stroke-linejoin": "round", "paint-order": "stroke" };

// Draws a plot into an empty svg element and returns where values lie.
function chart(svg, spec, width, height) {
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  const captions = element("g", {}), named = spec.curves.map((c) => [c.label, c.color, c.dashed, c.dots]).filter(([label]) => label);
  let top = EDGE;
  if (spec.title) { words(captions, fitting(spec.title, width - 2 * EDGE), EDGE, top + FONT, { "font-weight": 600 }); top += LINE + 4; }
  if (named.length > 1) top = legend(captions, named, width, top, height * 0.4);
  const bottom = height - 2 * LINE - 12, vectors = spec.hodograph ? shownVectors(spec) : null;
  top = Math.min(top + 4, bottom - 40);
  const shown = (axis, values, margin) => {
    const given = axis.limits && axis.limits[0] < axis.limits[1] && (!axis.log || axis.limits[0] > 0) ? axis.limits : null;
    return given ?? range(values, axis.log, vectors ? 0.12 : spec.plane ? 0.05 : margin);
  };
  const all = (k) => vectors ? vectors.shown[k] : spec.curves.flatMap((c) => [...finite(c)[k]]).concat(k ? spec.limits.flatMap((l) => l.y) : []);
  let y = scale(shown(spec.y, all(1), 0.05), bottom, top, spec.y.log);
  const count = (long, each, least, most) => Math.min(most, Math.max(least, long / each));
  const upright = () => ticks(y, count(bottom - top, 30, 3, 9), spec.y.unit);
  const left = Math.min(Math.max(12, ...upright().marks.map(([, t]) => wide(t))) + LINE + 16, width * 0.4), right = width - 16;
  let x = scale(shown(spec.x, all(0), 0), left, right, spec.x.log);
  if (spec.plane && !x.log && !y.log) [x, y] = equalized(x, y);
  const xTicks = ticks(x, count(right - left, 55, 2, 12), spec.x.unit), yTicks = upright();
  const frame = { left, right, top, bottom };
  furniture(svg, frame, x, y, xTicks, yTicks);
  const drawn = spec.curves.flatMap((c) => { const [xs, ys] = finite(c); return Array.from(xs, (v, k) => [x.at(v), y.at(ys[k])]); });
  markers(svg, spec.markers, frame, x, drawn);
  const clip = `clip-${chart.drawn = (chart.drawn ?? 0) + 1}`;
  element("rect", { x: left - 2, y: top - 2, width: right - left + 4, height: bottom - top + 4 }, element("clipPath", { id: clip }, svg));
  const inside = element("g", { "clip-path": `url(#${clip})` }, svg);
  for (const limit of spec.limits) shade(inside, limit, spec.curves, x, y);
  if (vectors) crossing(inside, frame, x);
  for (const c of spec.curves) if (c.dots) dots(inside, c, x, y); else element("path", { d: line(finite(c), x, y), fill: "none", stroke: c.color, "stroke-width": 2, "stroke-linejoin": "round", "stroke-linecap": "round", "stroke-dasharray": c.dashed ? "7 5" : "none" }, inside);
  for (const limit of spec.limits) drawLimit(svg, inside, limit, drawn, frame, x, y);
  if (vectors) nameTips(svg, spec, vectors, frame, x, y, drawn);
  const middle = [(left + right) / 2, (top + bottom) / 2], center = { "text-anchor": "middle" };
  words(captions, fitting(head(spec.x.label, spec.x.unit) + powerText(xTicks.power), right - left), middle[0], height - EDGE, center);
  words(captions, fitting(head(spec.y.label, spec.y.unit) + powerText(yTicks.power), bottom - top), 0, 0, { ...center, transform: `translate(${LINE} ${round(middle[1])}) rotate(-90)` });
  svg.append(captions);
  return { x, y, ...frame };
}

// The names of the curves in lines below `top`, at most so high; returns where they end.
function legend(parent, named, width, top, room) {
  let x = EDGE, y = top + FONT;
  for (const [label, stroke, dashed, loose] of named) {
    const name = fitting(label, width - 60), needed = 28 + wide(name) + 16;
    if (x + needed > width && x > EDGE) {
      [x, y] = [EDGE, y + LINE + 2];
      if (y - top > room) { words(parent, "…", x, y); break; }
    }
    if (loose) element("circle", { cx: x + 11, cy: y - 4, ...dotted(stroke, dashed) }, parent);
    else element("path", { d: `M${x} ${y - 4}h22`, stroke, "stroke-width": 2.5, "stroke-dasharray": dashed ? "7 5" : "none" }, parent);
    words(parent, name, x + 28, y);
    x += needed;
  }
  return y + 6;
}

// One unit as long on both axes.
function equalized(x, y) {
  const coarse = Math.max(...[x, y].map((s) => (s.high - s.low) / Math.abs(s.to - s.from)));
  return [x, y].map((s) => {
    const middle = (s.low + s.high) / 2, half = coarse * Math.abs(s.to - s.from) / 2;
    return scale([middle - half, middle + half], s.from, s.to, false);
  });
}

function furniture(svg, { left, right, top, bottom }, x, y, xTicks, yTicks) {
  const group = element("g", {}, svg), muted = { fill: "var(--muted)" };
  let grid = "";
  for (const [value, told] of xTicks.marks) {
    const at = x.at(value);
    grid += `M${round(at)} ${bottom}V${top}`;
    // a number at the edge stays on the sheet
    const half = wide(told) / 2, room = right + 14 - half;
    words(group, told, Math.min(at, room), bottom + LINE, { ...muted, "text-anchor": "middle" });
  }
  for (const [value, told] of yTicks.marks) {
    const at = y.at(value);
    grid += `M${left} ${round(at)}H${right}`;
    words(group, told, left - 6, at + FONT * 0.35, { ...muted, "text-anchor": "end" });
  }
  group.prepend(element("path", { d: grid, fill: "none", stroke: "var(--grid)" }));
  const zero = y.log ? null : y.at(0);
  if (zero != null && zero > top && zero < bottom) element("path", { d: `M${left} ${round(zero)}H${right}`, stroke: "var(--muted)" }, group);
  element("path", { d: `M${left} ${top}V${bottom}H${right}`, fill: "none", stroke: "var(--muted)", "stroke-width": 1.4 }, group);
}

// How many of some points lie in a box: left, top, right, bottom.
const covered = (points, [left, top, right, bottom]) => points.reduce((sum, [x, y]) => sum + (x > left && x < right && y > top && y < bottom), 0);

// Lines at dead and change points. Their names stand beside them, at the top or at the bottom, where they hide less of the
// curves and do not run into each other.
function markers(svg, marks, { left, right, top, bottom }, x, drawn) {
  let free = -Infinity;
  for (const mark of marks) {
    const at = x.at(mark.at), [token, dash] = MARKS[mark.kind];
    if (at == null || at < left - 0.01 || at > right + 0.01) continue;
    element("path", { d: `M${round(at)} ${bottom}V${top}`, stroke: `var(${token})`, "stroke-width": 1.4, "stroke-dasharray": dash }, svg);
    if (at <= free) continue;
    const beside = at + LINE > right ? at - 4 : at + FONT;
    const label = fitting(mark.label, bottom - top - 8), room = (from) => covered(drawn, [beside - FONT, from, beside + 3, from + wide(label) + 4]);
    const low = room(bottom - wide(label) - 4) < room(top);
    words(svg, label, 0, 0, { ...halo, fill: `var(${token})`, "text-anchor": low ? "start" : "end", transform: `translate(${round(beside)} ${low ? bottom - 5 : top + 4}) rotate(-90)` });
    free = at + LINE;
  }
}

// How a dot looks: full, or empty of what is dashed.
const dotted = (color, dashed) => ({ r: 4, fill: dashed ? "none" : color, stroke: color, "stroke-width": 1.6 });

// The values of a curve as dots that nothing joins.
function dots(parent, curve, x, y) {
  const [xs, ys] = finite(curve);
  xs.forEach((v, k) => {
    const px = x.at(v), py = y.at(ys[k]);
    if (px != null && py != null) element("circle", { cx: round(px), cy: round(py), ...dotted(curve.color, curve.dashed) }, parent);
  });
}

// A curve as a path; it breaks where a value is missing, and a lone value between two gaps is a dot.
function line([xs, ys], x, y) {
  let path = "", last = null, alone = false;
  const dot = () => alone ? "h0" : "";
  for (let row = 0; row < Math.min(xs.length, ys.length); row++) {
    const px = x.at(xs[row]), py = y.at(ys[row]);
    if (px == null || py == null) { path += dot(); last = null; alone = false; continue; }
    if (last && Math.hypot(px - last[0], py - last[1]) < 0.1) continue;
    path += `${last ? "L" : "M"}${px.toFixed(2)} ${py.toFixed(2)}`;
    alone = !last;
    last = [px, py];
  }
  return path + dot();
}
