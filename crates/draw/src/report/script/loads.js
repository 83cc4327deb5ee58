// Forces at any row: the same arrows as in the picture, between two rows by shares of both.
class Loads {
  constructor(motion, svg, section) {
    this.motion = motion;
    const data = this.data = motion.loads || { tracks: [] };
    svg.querySelectorAll(".load").forEach((g) => g.remove());
    const below = svg.querySelector(".joint"), above = svg.querySelector(".load-legend");
    this.arrows = data.tracks.map((track) => {
      const group = document.createElementNS(SVG, "g"), text = document.createElementNS(SVG, "g");
      group.setAttribute("class", `load load-${track.role}`);
      text.setAttribute("class", `load label load-${track.role}`);
      svg.insertBefore(group, below);
      svg.insertBefore(text, above);
      const line = { fill: "none", stroke: track.c, "stroke-linecap": "round" };
      const label = track.label ? element("text", { "font-size": data.text, "text-anchor": "middle", fill: track.c, stroke: "var(--background)", "stroke-width": data.text * 0.28, "stroke-linejoin": "round", "paint-order": "stroke" }, text) : null;
      if (label) label.textContent = track.label;
      return {
        track, label, broken: new Set(track.broken),
        shaft: element("path", { ...line, "stroke-width": track.w, "stroke-dasharray": track.dash || "none" }, group),
        ticks: element("path", { ...line, "stroke-width": 0.35 }, group),
        head: element("path", track.open ? { fill: "var(--background)", stroke: track.c, "stroke-width": 0.4, "stroke-linejoin": "round" } : { fill: track.c }, group),
        groups: [group, text],
      };
    });
    for (const box of section.querySelectorAll("[data-role]")) box.addEventListener("change", () => {
      for (const a of this.arrows) if (a.track.role === box.dataset.role) a.groups.forEach((g) => { g.style.display = box.checked ? "" : "none"; });
    });
  }

  show(row, share) {
    for (const load of this.arrows) this.draw(load, row, share);
  }

  draw(load, row, share) {
    const { track, label } = load, data = this.data, high = this.motion.size[1];
    // one row of so many numbers; between two rows where both have them
    const at = (v, n) => {
      if (v.length === n) return v[0] == null ? null : v;
      const a = v.slice(n * row, n * row + n), b = v.slice(n * row + n, n * row + 2 * n);
      if (a[0] == null) return null;
      return share === 0 || b[0] == null ? a : a.map((x, k) => x + share * (b[k] - x));
    };
    const p = at(track.p, 2), f = p && at(track.f, 2), m = p && at(track.m, 1);
    const long = f ? Math.hypot(f[0], f[1]) : 0, off = load.broken.has(row);
    const on = ([x, y]) => `${round(x)} ${round(high - y)}`;
    const { head: headLong, half: headHalf, gap } = this.motion.arrow;
    let shaft = "", ticks = "", head = "", tip = null, along = null;
    if (m) {
      const r = track.r, sweep = m[0], sense = Math.sign(sweep) || 1;
      const q = (angle, radius = r) => [p[0] - radius * Math.sin(angle), p[1] + radius * Math.cos(angle)];
      const arc = (a, b) => `M${on(q(a))}A${r} ${r} 0 ${Math.abs(b - a) > Math.PI ? 1 : 0} ${sense > 0 ? 0 : 1} ${on(q(b))}`;
      const end = sweep - sense * 0.8 * headLong / r, middle = sweep / 2, half = sense * gap / r;
      shaft += off ? arc(0, middle - half) + arc(middle + half, end) : arc(0, end);
      if (off) for (const a of [middle - half, middle + half]) ticks += `M${on(q(a, r - 1.3))}L${on(q(a, r + 1.3))}`;
      const a = q(sweep - sense * headLong / r), b = q(sweep), chord = Math.hypot(b[0] - a[0], b[1] - a[1]);
      const c = (b[0] - a[0]) / chord, s = (b[1] - a[1]) / chord;
      const corner = (side) => [b[0] - c * headLong - s * side * headHalf, b[1] - s * headLong + c * side * headHalf];
      head += `M${on(b)}L${on(corner(1))}L${on(corner(-1))}Z`;
      tip = [p[0], p[1] + r + 0.6];
      along = [0, 1];
    }
    if (long > 1e-9) {
      const straight = arrow(this.motion, [p[0] + data.rim * f[0] / long, p[1] + data.rim * f[1] / long], f, off);
      shaft += straight.shaft;
      ticks += straight.ticks;
      head += straight.head;
      ({ tip, along } = straight);
    }
    load.shaft.setAttribute("d", shaft);
    load.ticks.setAttribute("d", ticks);
    load.head.setAttribute("d", head);
    if (!label) return;
    label.setAttribute("visibility", tip ? "visible" : "hidden");
    if (!tip) return;
    // as the picture stands it: away from a place of the arrow, in a direction turned from its own
    const [turn, far, part] = track.stands, [half, up, rise] = track.room;
    const angle = Math.atan2(along[1], along[0]) + turn, away = [Math.cos(angle), Math.sin(angle)];
    const back = long > 1e-9 ? f.map((v) => v * (1 - part)) : [0, 0];
    const edge = (v) => Math.sign(v) * Math.min(1, Math.abs(v) / 0.7);
    label.setAttribute("x", round(tip[0] - back[0] + half * edge(away[0]) + far * away[0]));
    label.setAttribute("y", round(high - (tip[1] - back[1] + up * edge(away[1]) + far * away[1]) + rise));
  }
}
