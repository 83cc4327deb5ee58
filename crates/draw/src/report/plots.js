// Plots: a cursor that follows the playhead, values under the pointer, and the same values as a table.
const text = (v) => v == null ? "n/a" : Number(v.toPrecision(6)).toString();

function place(scale, value) {
  const [low, high, from, to, log] = scale;
  if (value == null || (log && !(value > 0))) return null;
  const share = log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return share < -1e-6 || share > 1 + 1e-6 ? null : from + share * (to - from);
}

function element(name, attributes, parent) {
  const e = document.createElementNS(SVG, name);
  for (const key in attributes) e.setAttribute(key, attributes[key]);
  parent.append(e);
  return e;
}

class Plot {
  constructor(motion, spec, figure, seek) {
    this.motion = motion;
    this.spec = spec;
    this.svg = figure.querySelector("svg");
    this.tip = figure.querySelector(".tip");
    const named = (v) => v === "drive" ? motion.drive.v : v === "time" ? motion.time : typeof v === "number" ? motion.cols[v].v : v;
    this.curves = spec.curves.map((c) => ({ label: c.label, color: c.c, x: named(c.x), y: named(c.y) })).filter((c) => c.x && c.y);
    // one abscissa for all curves that runs one way is a cursor line; a path in the plane has dots only
    const x = this.curves.length ? this.curves[0].x : null;
    this.x = x && !spec.path && this.curves.every((c) => c.x === x) && monotone(x) ? x : null;
    const line = { y1: spec.h - spec.y[2], y2: spec.h - spec.y[3] };
    this.ghost = element("line", { class: "ghost-cursor", visibility: "hidden", ...line }, this.svg);
    this.cursor = element("line", { class: "cursor", visibility: "hidden", ...line }, this.svg);
    // the vector to the tip takes the place of the one that is drawn
    if (spec.vector) this.svg.querySelectorAll(".vector").forEach((g) => g.remove());
    this.arrows = spec.vector ? this.curves.map((c) => ["path", "path"].map((name, k) => element(name, k ? { fill: c.color } : { stroke: c.color, "stroke-width": 0.6 }, this.svg))) : [];
    this.dots = this.curves.map((c) => element("circle", { class: "dot", r: 1.1, fill: c.color, visibility: "hidden" }, this.svg));
    let down = false;
    const row = (event) => this.nearest(event);
    this.svg.addEventListener("pointermove", (event) => { this.hover(row(event), event); if (down && event.buttons) seek(row(event)); });
    this.svg.addEventListener("pointerdown", (event) => { down = true; const r = row(event); if (r != null) seek(r); });
    this.svg.addEventListener("pointerup", () => { down = false; });
    this.svg.addEventListener("pointerleave", () => { down = false; this.hover(null); });
    const details = figure.querySelector("details");
    if (!this.curves.length) details.remove();
    else details.addEventListener("toggle", () => this.table(details.querySelector(".scroll")), { once: true });
  }

  // The row nearest to the pointer.
  nearest(event) {
    const box = this.svg.getBoundingClientRect();
    const px = (event.clientX - box.left) / box.width * this.spec.w;
    const py = this.spec.h - (event.clientY - box.top) / box.height * this.spec.h;
    let best = null, least = Infinity;
    for (const c of this.curves) for (let r = 0; r < c.x.length; r++) {
      const x = place(this.spec.x, c.x[r]);
      if (x == null) continue;
      const y = this.x ? py : place(this.spec.y, c.y[r]);
      if (y == null) continue;
      const far = Math.hypot(x - px, y - py);
      if (far < least) { least = far; best = r; }
    }
    return best;
  }

  hover(row, event) {
    this.tip.hidden = row == null;
    const x = row != null && this.x ? place(this.spec.x, this.x[row]) : null;
    this.ghost.setAttribute("visibility", x == null ? "hidden" : "visible");
    if (x != null) { this.ghost.setAttribute("x1", x); this.ghost.setAttribute("x2", x); }
    if (row == null) return;
    const drive = this.motion.drive;
    const lines = [`${drive.name} = ${text(drive.v[row])} ${drive.unit}`];
    for (const c of this.curves) lines.push(this.x ? `${c.label || "value"}: ${text(c.y[row])}` : `${c.label || "path"}: (${text(c.x[row])}, ${text(c.y[row])})`);
    this.tip.replaceChildren(...lines.map((l) => { const d = document.createElement("div"); d.textContent = l; return d; }));
    const box = this.svg.parentElement.getBoundingClientRect();
    const left = event.clientX - box.left;
    this.tip.style.left = `${left + this.tip.offsetWidth + 24 > box.width ? Math.max(0, left - this.tip.offsetWidth - 12) : left + 14}px`;
    this.tip.style.top = `${Math.max(0, event.clientY - box.top - this.tip.offsetHeight - 8)}px`;
  }

  // Moves the cursor to a row, or a share of the way to the next.
  show(row, share) {
    const spec = this.spec;
    const at = (values) => {
      const a = values[row], b = values[row + 1];
      return a == null || share === 0 || b == null ? a : a + share * (b - a);
    };
    const x = this.x ? place(this.spec.x, at(this.x)) : null;
    this.cursor.setAttribute("visibility", x == null ? "hidden" : "visible");
    if (x != null) { this.cursor.setAttribute("x1", x); this.cursor.setAttribute("x2", x); }
    this.curves.forEach((c, k) => {
      const px = place(this.spec.x, at(c.x)), py = place(this.spec.y, at(c.y));
      this.dots[k].setAttribute("visibility", spec.vector || px == null || py == null ? "hidden" : "visible");
      if (px != null && py != null) { this.dots[k].setAttribute("cx", px); this.dots[k].setAttribute("cy", this.spec.h - py); }
      if (this.arrows[k]) this.vector(this.arrows[k], px, py);
    });
  }

  // An arrow from the origin to a tip.
  vector([shaft, head], px, py) {
    const x = place(this.spec.x, 0), y = place(this.spec.y, 0), long = px == null || py == null ? 0 : Math.hypot(px - x, py - y);
    const c = (px - x) / long, s = (py - y) / long;
    const at = (a, b) => `${round(px + c * a - s * b)} ${round(this.spec.h - (py + s * a + c * b))}`;
    shaft.setAttribute("d", long > 2.4 ? `M${round(x)} ${round(this.spec.h - y)}L${at(-1.9, 0)}` : "");
    head.setAttribute("d", long > 2.4 ? `M${at(0, 0)}L${at(-2.4, 0.95)}L${at(-2.4, -0.95)}Z` : "");
  }

  table(holder) {
    const table = document.createElement("table");
    const row = (cells, kind) => {
      const tr = document.createElement("tr");
      for (const cell of cells) {
        const td = document.createElement(kind);
        td.textContent = cell;
        td.className = "number";
        if (kind === "th") td.scope = "col";
        tr.append(td);
      }
      return tr;
    };
    const heads = this.curves.flatMap((c) => this.x ? [c.label || "value"] : [`${c.label || "path"}: x`, `${c.label || "path"}: y`]);
    const head = document.createElement("thead"), body = document.createElement("tbody");
    const drive = this.motion.drive;
    head.append(row([drive.unit ? `${drive.name} [${drive.unit}]` : drive.name, ...heads], "th"));
    drive.v.forEach((v, r) => body.append(row([text(v), ...this.curves.flatMap((c) => this.x ? [text(c.y[r])] : [text(c.x[r]), text(c.y[r])])], "td")));
    table.append(head, body);
    holder.replaceChildren(table);
  }
}

function monotone(values) {
  let up = true, down = true, first = null, last = null;
  for (const v of values) {
    if (v == null) continue;
    if (first == null) first = v;
    if (last != null) { up = up && v >= last; down = down && v <= last; }
    last = v;
  }
  return (up || down) && first !== last;
}
