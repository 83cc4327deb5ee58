// A plot of what the reader chooses: any column over any other, or over the row.
class Chosen {
  constructor(player, holder) {
    this.motion = player.motion;
    this.rows = { name: "row", unit: "", v: Float64Array.from(this.motion.row, (r) => r + 1) };
    const figure = tag("figure", { class: "card plot" });
    const select = (label, name) => {
      const list = tag("select", { "data-choose": name });
      list.addEventListener("change", () => this.choose());
      return [list, tag("label", {}, label, list)];
    };
    const [y, ofY] = select("Plot", "y"), [with_, ofWith] = select("and", "with"), [x, ofX] = select("over", "x");
    this.lists = { y, with: with_, x };
    this.log = tag("input", { type: "checkbox", "data-choose": "log" });
    this.log.addEventListener("change", () => this.choose());
    const cols = this.motion.cols, name = (c) => head(c.name, c.unit);
    const own = this.motion.own + this.motion.more, drives = Math.max(1, this.motion.drive + 1);
    cols.forEach((c, k) => y.append(tag("option", { value: k }, name(c))));
    y.value = Math.min(drives, cols.length - 1);
    x.append(tag("option", { value: -1 }, "row"), ...cols.map((c, k) => tag("option", { value: k }, name(c))));
    x.value = this.motion.plots.length && typeof this.motion.plots[0].curves[0]?.x === "number" && !this.motion.plots[0].plane ? this.motion.plots[0].curves[0].x : this.motion.drive;
    // what nobody has seen yet comes first
    const seen = new Set(this.motion.plots.flatMap((p) => p.curves.map((c) => c.y)));
    const fresh = cols.findIndex((_, k) => k >= drives && k < own && !seen.has(k));
    if (fresh >= 0) y.value = fresh;
    const another = tag("button", { type: "button", "data-choose": "another" }, "Another plot");
    another.addEventListener("click", () => { player.choose(holder).lists.y.focus(); });
    const bar = tag("div", { class: "row choose" }, ofY, ofWith, ofX, tag("label", {}, this.log, "log"), another);
    const box = tag("div", {});
    figure.append(bar, box);
    holder.append(figure);
    this.offer();
    this.plot = new Plot(player, this.spec(), box);
    this.plot.figure = figure;
  }

  // The columns that may share the axis: those of one unit.
  offer() {
    const { y, with: list } = this.lists, cols = this.motion.cols, before = list.value;
    const fit = cols.flatMap((c, k) => k !== +y.value && c.unit === cols[+y.value]?.unit ? [tag("option", { value: k }, c.name)] : []);
    list.replaceChildren(tag("option", { value: -1 }, "nothing else"), ...fit);
    list.value = fit.some((o) => o.value === before) ? before : -1;
  }

  // The values that the other design has of a column.
  other(column) {
    return this.motion.against?.values[this.motion.cols.indexOf(column)];
  }

  choose() {
    this.offer();
    this.plot.set(this.spec());
  }

  spec() {
    const { y, with: list, x } = this.lists, { cols, events } = this.motion;
    const along = cols[+x.value] ?? this.rows, chosen = [y, list].map((l) => cols[+l.value]).filter(Boolean);
    // a point's two coordinates are its path
    const point = /^x\((.*)\)$/.exec(along.name), plane = chosen.length === 1 && !this.log.checked && !!point && chosen[0].name === `y(${point[1]})`;
    const compared = chosen.some((c) => this.other(c));
    const label = (c) => chosen.length > 1 ? c.name : compared ? "this" : "";
    const curves = chosen.map((c, k) => ({ label: label(c), dashed: k > 0 && !compared, own: true, color: color(k), x: along.v, y: c.v, names: [along.name, c.name] }));
    // the other design's by the colour of its quantity; a lone quantity leaves a colour for it
    chosen.forEach((c, k) => {
      const y = this.other(c), own = along === this.rows ? along.v : this.other(along);
      if (y && own) curves.push({ label: chosen.length > 1 ? `${c.name}, against` : "against", dashed: true, own: true, against: true, color: color(chosen.length > 1 ? k : 1), x: shared(along.v, own), y, names: [`${along.name}, against`, `${c.name}, against`] });
    });
    const marks = monotone(along.v) ? events.map((e) => ({ at: along.v[e.row], label: e.kind === "dead" ? "limit" : "change point", kind: e.kind })) : [];
    const axis = (c, log) => ({ label: c.name, unit: c.unit, log, limits: null });
    const upright = axis(chosen[0] ?? this.rows, this.log.checked);
    if (chosen.length > 1) upright.label = "";
    return { title: plane ? `Path of ${point[1]}` : "", x: axis(along, false), y: upright, curves, markers: plane ? [] : marks, limits: [], plane, hodograph: null };
  }
}
