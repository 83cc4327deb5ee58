// Lines that a curve should not cross, and the part of it beyond them.
function limitAt(limit, value) {
  if (!limit.x) return limit.y[0];
  const after = limit.x.findIndex((v) => v >= value);
  if (after < 0) return NaN;
  if (limit.x[after] === value) return limit.y[after];
  if (after === 0) return NaN;
  const share = (value - limit.x[after - 1]) / (limit.x[after] - limit.x[after - 1]);
  return limit.y[after - 1] + share * (limit.y[after] - limit.y[after - 1]);
}

// Shades between each curve and the limit, on the side beyond.
function shade(parent, limit, curves, x, y) {
  if (!limit.beyond) return;
  let path = "";
  for (const curve of curves) {
    const [xs, ys] = finite(curve);
    let forth = [], back = [], last = null;
    const close = () => {
      if (forth.length > 1) path += `M${forth.concat(back.reverse()).map((p) => `${p[0].toFixed(2)} ${p[1].toFixed(2)}`).join("L")}Z`;
      [forth, back] = [[], []];
    };
    for (let row = 0; row < xs.length; row++) {
      const px = x.at(xs[row]), py = y.at(ys[row]), edge = y.at(limitAt(limit, xs[row]));
      if (px == null || py == null || edge == null) { close(); last = null; continue; }
      const far = limit.beyond * (edge - py), here = { px, py, edge, far };
      if (last && last.far > 0 !== far > 0) {
        const share = last.far / (last.far - far), at = [last.px + share * (px - last.px), last.py + share * (py - last.py)];
        forth.push(at);
        back.push(at);
      }
      if (far > 0) { forth.push([px, py]); back.push([px, edge]); }
      else close();
      last = here;
    }
    close();
  }
  element("path", { d: path, fill: "var(--error)", "fill-opacity": 0.16 }, parent);
}

// Draws the line, and its name at the end where the curves are farther from it.
function drawLimit(svg, inside, limit, drawn, { left, right, top, bottom }, x, y) {
  const own = limit.x ? [limit.x, limit.y] : [[x.low, x.high], [limit.y[0], limit.y[0]]];
  element("path", { d: line(own, x, y), fill: "none", stroke: "var(--error)", "stroke-width": 1.6, "stroke-dasharray": "8 4 2 4" }, inside);
  if (!limit.label) return;
  const label = fitting(limit.label, right - left - 8), long = wide(label);
  const places = [];
  for (const from of [left + 4, right - 4 - long, (left + right - long) / 2]) {
    const values = own[0].filter((v) => x.at(v) >= from - 20 && x.at(v) <= from + long + 20), near = values.length ? values : own[0];
    const edges = near.map((v) => y.at(limitAt(limit, v))).filter((v) => v != null);
    if (!edges.length) continue;
    for (const base of [Math.min(...edges) - 6, Math.max(...edges) + FONT + 3]) {
      if (base - FONT < top || base > bottom) continue;
      places.push([covered(drawn, [from - 3, base - FONT - 3, from + long + 3, base + 4]), from, base]);
    }
  }
  places.sort((a, b) => a[0] - b[0]);
  if (places.length) words(svg, label, places[0][1], places[0][2], { ...halo, fill: "var(--error)" });
}
