// Velocities and accelerations: arrows at the points, and their values in a table, for those that are switched on.
class Vectors {
  constructor(motion, svg, section) {
    this.motion = motion;
    this.holder = section.querySelector(".moving");
    const below = svg.querySelector(".load") || svg.querySelector(".joint");
    this.kinds = motion.vectors.map((data) => {
      const group = element("g", { class: `vector-${data.kind}`, "data-shown": "false" });
      svg.insertBefore(group, below);
      group.style.display = "none";
      const line = { fill: "none", stroke: data.c, "stroke-linecap": "round" };
      const tracks = data.tracks.map((t) => ({
        point: t.p, v: unpacked(t.v, 4),
        shaft: element("path", { ...line, "stroke-width": 0.6 }, group),
        ticks: element("path", { ...line, "stroke-width": 0.35 }, group),
        head: element("path", { fill: data.c }, group),
      }));
      return { data, group, tracks, on: false };
    });
    for (const box of section.querySelectorAll("[data-vector]")) box.addEventListener("change", () => {
      const kind = this.kinds.find((k) => k.data.kind === box.dataset.vector);
      kind.on = box.checked;
      kind.group.style.display = kind.on ? "" : "none";
      if (this.last) this.show(...this.last);
    });
  }

  show(row, share, poses) {
    this.last = [row, share, poses];
    for (const kind of this.kinds) if (kind.on) for (const track of kind.tracks) this.draw(kind.data, track, row, share, poses);
    this.tell(row + Math.round(share));
  }

  draw(data, track, row, share, poses) {
    const at = pointAt(this.motion, poses, track.point), one = (k) => {
      const a = track.v[2 * row + k], b = track.v[2 * row + 2 + k];
      return share === 0 || !known(b) ? a : a + share * (b - a);
    };
    const v = [one(0), one(1)], size = Math.hypot(v[0], v[1]);
    const long = data.mm * Math.min(1, size / data.full);
    const drawn = at && long > 0.3 ? arrow(this.motion, at, v.map((x) => x / size * long), size > data.full * 1.000001) : { shaft: "", ticks: "", head: "" };
    for (const part of ["shaft", "ticks", "head"]) track[part].setAttribute("d", drawn[part]);
  }

  // Sizes and directions at a row.
  tell(row) {
    const on = this.kinds.filter((kind) => kind.on);
    this.holder.hidden = !on.length;
    const now = `${row} ${on.map((kind) => kind.data.kind)}`;
    if (!on.length || now === this.told) return;
    this.told = now;
    const rows = on.flatMap(({ data, tracks }) => tracks.map((track) => {
      const [x, y] = [track.v[2 * row], track.v[2 * row + 1]], size = Math.hypot(x, y);
      const line = cells("td", [text(size, 5), data.unit, size > 0 ? `at ${text(Math.atan2(y, x) * 180 / Math.PI, 4)} deg` : ""]);
      line.prepend(tag("th", { scope: "row" }, `${data.kind} of ${this.motion.named[track.point]}`));
      return line;
    }));
    const heads = cells("th", ["Value", "Unit", "Direction"]);
    heads.prepend(tag("th", { scope: "col" }, "Of a point"));
    const table = tag("table", {}, tag("thead", {}, heads), tag("tbody", {}, ...rows));
    this.holder.replaceChildren(tag("div", { class: "scroll", tabindex: "0" }, table));
  }
}
