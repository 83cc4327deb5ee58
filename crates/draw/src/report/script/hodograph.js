// A vector over a motion: its tail at the origin, its tip along a curve, some tips named by the drive.
const FAR = 10, USUAL = 0.75, TIPS = 8;

// The values to show: all but outliers, and the origin; and the largest vector when some are left out.
function shownVectors(spec) {
  const pairs = spec.curves.flatMap((c) => Array.from(c.x, (x, k) => [x, c.y[k]])).filter(([x, y]) => known(x) && known(y));
  const sizes = pairs.map(([x, y]) => Math.hypot(x, y)).filter((s) => s > 0).sort((a, b) => a - b);
  const largest = sizes.at(-1) ?? 0, full = Math.min(largest, FAR * (sizes[Math.floor(USUAL * (sizes.length - 1))] ?? 0));
  const near = pairs.filter(([x, y]) => Math.hypot(x, y) <= full).concat([[0, 0]]);
  return { shown: [near.map((p) => p[0]), near.map((p) => p[1])], outside: largest > full ? largest : null };
}

function crossing(parent, { top, bottom }, x) {
  const at = x.at(0);
  if (at != null) element("path", { d: `M${round(at)} ${bottom}V${top}`, stroke: "var(--muted)" }, parent);
}

// Dots at some tips, each with the coordinate of the drive where it has room.
function nameTips(svg, spec, { outside }, { left, right, top, bottom }, x, y, drawn) {
  const taken = [], group = element("g", {}, svg), muted = { ...halo, fill: "var(--muted)" };
  const clear = (box) => !covered(drawn, box) && box[0] >= left && box[2] <= right && box[1] >= top && box[3] <= bottom && taken.every((b) => box[2] < b[0] || b[2] < box[0] || box[3] < b[1] || b[3] < box[1]);
  if (outside != null) {
    const told = `up to ${withUnit(outside, spec.x.unit, 3)} outside`;
    taken.push([right - 4 - wide(told), bottom - LINE - 2, right, bottom]);
    words(group, told, right - 4, bottom - 6, { ...muted, "text-anchor": "end" });
  }
  const drive = spec.hodograph.drive;
  // another design has rows of its own: its tips are of other places
  for (const curve of spec.curves.filter((c) => !c.against)) {
    const tips = Array.from(curve.x, (v, k) => [x.at(v), y.at(curve.y[k])]), marked = [];
    const there = tips.filter(([px, py]) => px != null && py != null);
    const middle = [0, 1].map((k) => there.reduce((sum, p) => sum + p[k], 0) / Math.max(1, there.length));
    for (let k = 0; k <= TIPS; k++) {
      const row = Math.floor(k * Math.max(0, tips.length - 1) / TIPS), [px, py] = tips[row] ?? [null, null];
      if (px == null || py == null || px < left || px > right || py < top || py > bottom) continue;
      // a motion that closes comes back to its first tip
      if (marked.some((p) => Math.hypot(p[0] - px, p[1] - py) < 8)) continue;
      marked.push([px, py]);
      element("circle", { cx: round(px), cy: round(py), r: 3, fill: curve.color }, group);
      if (!known(drive[row])) continue;
      const told = withUnit(drive[row], spec.hodograph.unit, 3), half = [wide(told) / 2 + 1, FONT / 2];
      const far = Math.max(1e-9, Math.hypot(px - middle[0], py - middle[1])), along = [(px - middle[0]) / far, (py - middle[1]) / far];
      for (const [c, s] of [[1, 0], [0.6, 0.8], [0.6, -0.8], [0, 1], [0, -1], [-1, 0]]) {
        const away = [along[0] * c - along[1] * s, along[0] * s + along[1] * c];
        const at = [px + away[0] * (half[0] + 6), py + away[1] * (half[1] + 6)];
        const box = [at[0] - half[0], at[1] - half[1], at[0] + half[0], at[1] + half[1]];
        if (!clear(box)) continue;
        taken.push(box);
        words(group, told, at[0], at[1] + FONT * 0.36, { ...muted, "text-anchor": "middle" });
        break;
      }
    }
  }
}
