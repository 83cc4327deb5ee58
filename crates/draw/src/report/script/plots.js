// Plots: drawn for the width they have, with a line where the player stands, values under the pointer, and tools.
class Plot {
  constructor(player, spec, figure) {
    this.player = player;
    this.motion = player.motion;
    this.figure = figure;
    this.svg = element("svg", { role: "img", tabindex: "0" });
    this.tip = tag("div", { class: "tip" });
    this.tip.hidden = true;
    this.sheet = tag("div", { class: "sheet" }, this.svg, this.tip);
    this.table = tag("details", {}, tag("summary", {}, "Values as a table"), tag("div", { class: "scroll", tabindex: "0" }));
    this.table.addEventListener("toggle", () => this.tabulate());
    const button = (name, label, act) => {
      const b = tag("button", { type: "button", "data-tool": name.toLowerCase() }, name);
      b.addEventListener("click", act);
      b.title = label;
      return b;
    };
    this.enlarge = button("Enlarge", "Show this plot as large as the window", () => enlarged(this));
    this.tools = tag("div", { class: "tools" }, this.enlarge,
      button("SVG", "Save this plot as SVG", () => saveSvg(this.svg, this.name())),
      button("PNG", "Save this plot as PNG", () => savePng(this.svg, this.name())));
    figure.replaceChildren(this.sheet, tag("div", { class: "below" }, this.table, this.tools));
    this.listen();
    this.set(spec);
    new ResizeObserver(() => this.fit()).observe(this.sheet);
  }

  // Takes a plot to show.
  set(spec) {
    this.spec = spec;
    this.own = spec.curves.filter((c) => c.own);
    // one abscissa for all curves that runs one way is a line at the player's place; a path in the plane has dots only
    const x = this.own[0]?.x;
    this.x = x && !spec.plane && this.own.every((c) => c.x === x) && monotone(x) ? x : null;
    const what = spec.title || [...new Set(spec.curves.filter((c) => !c.against).map((c) => c.names[1]))].join(", ");
    this.svg.setAttribute("aria-label", spec.title || `${what} over ${spec.x.label}`);
    this.table.hidden = !this.own.length;
    for (const b of this.tools.children) b.setAttribute("aria-label", `${b.title}: ${what}`);
    this.what = what;
    this.size = null;
    this.fit();
    if (this.table.open) this.tabulate();
  }

  name() { return fileName(this.motion.name, this.what); }

  // Draws it again where its room has changed.
  fit() {
    const width = Math.round(this.sheet.clientWidth), large = this.figure.closest("dialog");
    const high = large ? Math.max(200, innerHeight - 190) : this.spec.plane ? Math.min(460, 0.8 * width) : Math.min(360, Math.max(220, 0.56 * width));
    const size = `${width} ${Math.round(high)}`;
    if (!width || size === this.size) return;
    this.size = size;
    this.svg.replaceChildren();
    this.at = chart(this.svg, this.spec, width, Math.round(high));
    const { top, bottom } = this.at, live = element("g", { class: "live" }, this.svg), upright = (name) => element("line", { class: name, y1: top, y2: bottom, visibility: "hidden" }, live);
    [this.ghost, this.cursor] = [upright("ghost-cursor"), upright("cursor")];
    // the vector of a hodograph stays in a picture that is saved
    this.arrows = this.spec.hodograph ? this.own.map((c) => ["path", "path"].map((name, k) => element(name, k ? { fill: c.color } : { stroke: c.color, "stroke-width": 2 }, this.svg))) : [];
    const dots = (name, r) => this.own.map((c) => element("circle", { class: name, r, fill: c.color, visibility: "hidden" }, live));
    [this.dots, this.rings] = [dots("dot", 4.5), dots("ring", 5)];
    if (this.shown) this.show(...this.shown);
  }

  listen() {
    let down = false;
    const row = (event) => this.nearest(event);
    const seek = (event) => { const r = row(event); if (r != null) this.player.seek(r); };
    this.svg.addEventListener("pointermove", (event) => { this.hover(row(event), event); if (down && event.buttons) seek(event); });
    this.svg.addEventListener("pointerdown", (event) => { down = true; this.hover(row(event), event); seek(event); });
    for (const end of ["pointerup", "pointercancel"]) this.svg.addEventListener(end, () => { down = false; });
    // a finger leaves as soon as it is lifted: what it asked for stays until the next touch
    this.svg.addEventListener("pointerleave", (event) => { down = false; if (event.pointerType !== "touch") this.hover(null); });
    // who comes by keys reads the player's place
    this.svg.addEventListener("focus", () => { if (this.shown) this.show(...this.shown); });
    this.svg.addEventListener("blur", () => this.hover(null));
    document.addEventListener("pointerdown", (event) => { if (!this.svg.contains(event.target)) this.hover(null); });
  }

  // The row nearest to the pointer.
  nearest(event) {
    if (!this.at) return null;
    const box = this.svg.getBoundingClientRect(), [, , width, height] = this.svg.getAttribute("viewBox").split(" ");
    const px = (event.clientX - box.left) / box.width * width, py = (event.clientY - box.top) / box.height * height;
    let best = null, least = Infinity;
    for (const c of this.own) for (let r = 0; r < c.x.length; r++) {
      const x = this.at.x.at(c.x[r]), y = this.x ? py : this.at.y.at(c.y[r]);
      if (x == null || y == null) continue;
      const far = Math.hypot(x - px, y - py);
      if (far < least) { least = far; best = r; }
    }
    return best;
  }

  // What a curve says of a row: its name, and its value or values.
  said(curve, row) {
    const { x, y } = this.spec, [along, name] = curve.names, value = withUnit(curve.y[row], y.unit);
    return this.x ? [[name, value]] : [[along, withUnit(curve.x[row], x.unit)], [name, value]];
  }

  hover(row, event) {
    this.tip.hidden = row == null;
    const x = row != null && this.x ? this.at.x.at(this.x[row]) : null;
    upright(this.ghost, x);
    this.own.forEach((c, k) => place(this.rings?.[k], row == null ? null : this.at.x.at(c.x[row]), row == null ? null : this.at.y.at(c.y[row])));
    if (row == null) return;
    const drive = this.motion.cols[this.motion.drive], along = this.spec.x, lines = [];
    if (drive) lines.push([null, drive.name, withUnit(drive.v[row], drive.unit)]);
    if (this.x && this.x !== drive?.v) lines.push([null, along.label, withUnit(this.x[row], along.unit)]);
    for (const c of this.own) for (const [name, value] of this.said(c, row)) lines.push([c.color, name, value]);
    this.tip.replaceChildren(...lines.map(([swatch, name, value]) => {
      const mark = tag("i", {});
      if (swatch) mark.style.background = swatch;
      return tag("div", {}, mark, `${name} = ${value}`);
    }));
    const box = this.sheet.getBoundingClientRect(), left = event.clientX - box.left, room = box.width - this.tip.offsetWidth;
    this.tip.style.left = `${Math.max(0, left + 16 > room ? Math.min(room, left - this.tip.offsetWidth - 12) : left + 14)}px`;
    this.tip.style.top = `${Math.max(0, event.clientY - box.top - this.tip.offsetHeight - 10)}px`;
  }

  // Moves the line and the dots to a row, or a share of the way to the next.
  show(row, share) {
    this.shown = [row, share];
    if (!this.at) return;
    upright(this.cursor, this.x ? this.at.x.at(between(this.x, row, share)) : null);
    this.own.forEach((c, k) => {
      const px = this.at.x.at(between(c.x, row, share)), py = this.at.y.at(between(c.y, row, share));
      place(this.dots[k], this.arrows[k] ? null : px, py);
      if (this.arrows[k]) this.vector(this.arrows[k], px, py);
    });
    if (this.svg.matches(":focus-visible")) this.hover(Math.round(row + share), this.center());
  }

  // The middle of the plot, as an event of a pointer tells it.
  center() {
    const box = this.svg.getBoundingClientRect();
    return { clientX: box.x + box.width / 2, clientY: box.y + box.height / 2 };
  }

  // An arrow from the origin to a tip.
  vector([shaft, tip], px, py) {
    const x = this.at.x.at(0), y = this.at.y.at(0), long = px == null || py == null ? 0 : Math.hypot(px - x, py - y);
    const c = (px - x) / long, s = (py - y) / long, at = (a, b) => `${round(px + c * a - s * b)} ${round(py + s * a + c * b)}`;
    shaft.setAttribute("d", long > 9 ? `M${round(x)} ${round(y)}L${at(-7, 0)}` : "");
    tip.setAttribute("d", long > 9 ? `M${at(0, 0)}L${at(-9, 3.6)}L${at(-9, -3.6)}Z` : "");
  }

  // All values, where somebody looks.
  tabulate() {
    if (!this.table.open) return;
    const { x, y } = this.spec, drive = this.motion.cols[this.motion.drive];
    const columns = this.x ? [[head(x.label, x.unit), this.x]] : drive ? [[head(drive.name, drive.unit), drive.v]] : [];
    for (const c of this.own) {
      if (!this.x) columns.push([head(c.names[0], x.unit), c.x]);
      columns.push([head(c.names[1], y.unit), c.y]);
    }
    const rows = this.motion.row.map((_, r) => cells("td", columns.map(([, v]) => text(v[r]))));
    const table = tag("table", {}, tag("thead", {}, cells("th", columns.map(([name]) => name))), tag("tbody", {}, ...rows));
    this.table.querySelector(".scroll").replaceChildren(table);
  }
}

function upright(line, x) {
  line?.setAttribute("visibility", x == null ? "hidden" : "visible");
  if (x != null) for (const end of ["x1", "x2"]) line.setAttribute(end, round(x));
}

function place(dot, x, y) {
  const there = x != null && y != null;
  dot?.setAttribute("visibility", there ? "visible" : "hidden");
  if (there) { dot.setAttribute("cx", round(x)); dot.setAttribute("cy", round(y)); }
}

// An abscissa of another design: this one's own list where both are the same up to rounding, so that they share the player's place.
function shared(own, other) {
  let far = 0, size = 0;
  own.forEach((v, k) => { if (known(v) && known(other[k])) { far = Math.max(far, Math.abs(v - other[k])); size = Math.max(size, Math.abs(v)); } });
  return own.length === other.length && far <= 1e-9 * size ? own : other;
}

// A plot of the run with its columns in place of their numbers.
function plotOfRun(motion, spec) {
  const column = (v) => typeof v === "number" ? motion.cols[v] : { v: unpacked(v) };
  const first = spec.curves[0] && column(spec.curves[0].x);
  const curves = spec.curves.map((c) => {
    const [x, y] = [column(c.x), column(c.y)], against = c.name != null;
    return { ...c, against, color: color(c.color), x: against ? shared(first.v, x.v) : x.v, y: y.v, fine: c.fine?.map((v) => unpacked(v)), names: [against ? `${first.name ?? spec.x.label}, against` : x.name ?? spec.x.label, c.name ?? y.name ?? (c.label || spec.y.label)] };
  });
  const list = (v) => [].concat(v).map((x) => x ?? NaN), limits = spec.limits.map((l) => ({ ...l, x: l.x && list(l.x), y: list(l.y) }));
  return { ...spec, curves, limits, hodograph: spec.hodograph && { ...spec.hodograph, drive: column(spec.hodograph.drive).v } };
}
