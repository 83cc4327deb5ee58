// Forces at any row: the same arrows as in the picture, between two rows by shares of both.
class Loads {
  constructor(motion, svg, section) {
    this.motion = motion;
    const data = this.data = motion.loads || { tracks: [] };
    svg.querySelectorAll(".load").forEach((g) => g.remove());
    const below = svg.querySelector(".joint"), above = svg.querySelector(".load-legend");
    const make = (name, attributes, parent) => {
      const e = document.createElementNS(SVG, name);
      for (const key in attributes) e.setAttribute(key, attributes[key]);
      parent.append(e);
      return e;
    };
    this.arrows = data.tracks.map((track) => {
      const group = document.createElementNS(SVG, "g"), text = document.createElementNS(SVG, "g");
      group.setAttribute("class", `load load-${track.role}`);
      text.setAttribute("class", `load label load-${track.role}`);
      svg.insertBefore(group, below);
      svg.insertBefore(text, above);
      const line = { fill: "none", stroke: track.c, "stroke-linecap": "round" };
      const label = track.label ? make("text", { "font-size": data.text, "text-anchor": "middle", fill: track.c, stroke: "var(--background)", "stroke-width": data.text * 0.28, "stroke-linejoin": "round", "paint-order": "stroke" }, text) : null;
      if (label) label.textContent = track.label;
      return {
        track, label, broken: new Set(track.broken),
        shaft: make("path", { ...line, "stroke-width": track.w, "stroke-dasharray": track.dash || "none" }, group),
        ticks: make("path", { ...line, "stroke-width": 0.35 }, group),
        head: make("path", track.open ? { fill: "var(--background)", stroke: track.c, "stroke-width": 0.4, "stroke-linejoin": "round" } : { fill: track.c }, group),
        groups: [group, text],
      };
    });
    for (const box of section.querySelectorAll("[data-role]")) box.addEventListener("change", () => {
      for (const a of this.arrows) if (a.track.role === box.dataset.role) a.groups.forEach((g) => { g.style.display = box.checked ? "" : "none"; });
    });
  }

  show(row, share) {
    for (const arrow of this.arrows) this.draw(arrow, row, share);
  }

  draw(arrow, row, share) {
    const { track, label } = arrow, data = this.data, high = this.motion.size[1];
    // one row of so many numbers; between two rows where both have them
    const at = (v, n) => {
      if (v.length === n) return v[0] == null ? null : v;
      const a = v.slice(n * row, n * row + n), b = v.slice(n * row + n, n * row + 2 * n);
      if (a[0] == null) return null;
      return share === 0 || b[0] == null ? a : a.map((x, k) => x + share * (b[k] - x));
    };
    const p = at(track.p, 2), f = p && at(track.f, 2), m = p && at(track.m, 1);
    const long = f ? Math.hypot(f[0], f[1]) : 0, off = arrow.broken.has(row);
    const on = ([x, y]) => `${round(x)} ${round(high - y)}`;
    const path = (points, close) => points.map((q, k) => (k ? "L" : "M") + on(q)).join("") + (close ? "Z" : "");
    let shaft = "", ticks = "", head = "", tip = null, along = null;
    const point = (end, [c, s]) => {
      const q = (x, y) => [end[0] + c * x - s * y, end[1] + s * x + c * y];
      head += path([q(0, 0), q(-data.head, data.half), q(-data.head, -data.half)], true);
    };
    if (m) {
      const r = track.r, sweep = m[0], sense = Math.sign(sweep) || 1;
      const q = (angle, radius = r) => [p[0] - radius * Math.sin(angle), p[1] + radius * Math.cos(angle)];
      const arc = (a, b) => `M${on(q(a))}A${r} ${r} 0 ${Math.abs(b - a) > Math.PI ? 1 : 0} ${sense > 0 ? 0 : 1} ${on(q(b))}`;
      const end = sweep - sense * 0.8 * data.head / r, middle = sweep / 2, half = sense * data.gap / r;
      shaft += off ? arc(0, middle - half) + arc(middle + half, end) : arc(0, end);
      if (off) for (const a of [middle - half, middle + half]) ticks += path([q(a, r - 1.3), q(a, r + 1.3)]);
      const a = q(sweep - sense * data.head / r), b = q(sweep), chord = Math.hypot(b[0] - a[0], b[1] - a[1]);
      point(b, [(b[0] - a[0]) / chord, (b[1] - a[1]) / chord]);
      tip = [p[0], p[1] + r + 0.6];
      along = [0, 1];
    }
    if (long > 1e-9) {
      const u = along = [f[0] / long, f[1] / long];
      const q = (x, y) => [p[0] + u[0] * (x + data.rim) - u[1] * y, p[1] + u[1] * (x + data.rim) + u[0] * y];
      const end = long - 0.8 * data.head, a = long / 2 - data.gap, b = long / 2 + data.gap;
      shaft += off ? path([q(0, 0), q(a, 0)]) + path([q(b, 0), q(end, 0)]) : path([q(0, 0), q(end, 0)]);
      if (off) for (const x of [a, b]) ticks += path([q(x - 0.5, -1.4), q(x + 0.5, 1.4)]);
      tip = q(long, 0);
      point(tip, u);
    }
    arrow.shaft.setAttribute("d", shaft);
    arrow.ticks.setAttribute("d", ticks);
    arrow.head.setAttribute("d", head);
    if (!label) return;
    label.setAttribute("visibility", tip ? "visible" : "hidden");
    if (!tip) return;
    const [c, s] = track.away;
    label.setAttribute("x", round(tip[0] + (along[0] * c - along[1] * s) * (track.wide / 2 + 1)));
    label.setAttribute("y", round(high - tip[1] - (along[0] * s + along[1] * c) * (data.text / 2 + 1) + data.text * 0.36));
  }
}
