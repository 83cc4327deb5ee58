// A front of designs: a point of its picture or a row of its table chooses one, whose numbers, file and mechanism are shown.
class Front {
  constructor(front, card) {
    this.front = front;
    this.card = card;
    for (const c of front.cols) c.v = Float64Array.from(c.v, (v) => v ?? NaN);
    this.axes = [front.goals[0], front.goals[1]];
    this.svg = element("svg", { role: "radiogroup", "aria-label": `Designs of ${front.name}` });
    this.sheet = tag("div", { class: "sheet" }, this.svg);
    card.querySelector(".plot").replaceChildren(this.sheet, tag("div", { class: "below" }, this.choice(), this.tools()));
    this.panel = card.querySelector(".chosen");
    this.scroll = card.querySelector(".scroll");
    this.rows = [...card.querySelectorAll("tbody tr")];
    this.rows.forEach((row, k) => {
      row.dataset.design = k;
      row.addEventListener("click", () => this.pick(k));
    });
    new ResizeObserver(() => this.fit()).observe(this.sheet);
    this.pick(0);
  }

  // Which goals are drawn, where there are more than two.
  choice() {
    const { goals, cols } = this.front, bar = tag("div", { class: "row choose" });
    if (goals.length < 3) return bar;
    ["over", "Plot"].forEach((label, axis) => {
      const list = tag("select", {}, ...goals.map((g) => tag("option", { value: g }, cols[g].name)));
      list.value = this.axes[axis];
      list.addEventListener("change", () => { this.axes[axis] = +list.value; this.size = null; this.fit(); });
      bar.prepend(tag("label", {}, label, list));
    });
    return bar;
  }

  tools() {
    const name = () => fileName(this.front.name, "front"), save = (label, act) => {
      const b = tag("button", { type: "button", "data-tool": label.toLowerCase(), "aria-label": `Save the picture of ${this.front.name} as ${label}` }, label);
      b.addEventListener("click", act);
      return b;
    };
    return tag("div", { class: "tools" }, save("SVG", () => saveSvg(this.svg, name())), save("PNG", () => savePng(this.svg, name())));
  }

  // Draws the picture for the width it has, with a place to click on at every design.
  fit() {
    const width = Math.round(this.sheet.clientWidth);
    if (!width || width === this.size) return;
    this.size = width;
    const high = Math.round(Math.min(440, Math.max(240, 0.62 * width))), { cols, own, goals, designs } = this.front;
    const [x, y] = this.axes.map((k) => cols[k]), mine = this.axes.map((k) => own ? [own[goals.indexOf(k)] ?? NaN] : []);
    const axis = (c, more) => ({ label: c.name, unit: c.unit, log: false, limits: range([...c.v, ...more], false, 0.05) });
    const curve = (label, k, x, y) => ({ label: own ? label : "", dots: true, dashed: k > 0, color: color(k), x, y });
    const curves = [curve("the front", 0, x.v, y.v)];
    if (own) curves.push(curve("the file's own", 1, ...mine));
    const focused = this.hits?.includes(document.activeElement);
    this.svg.replaceChildren();
    this.at = chart(this.svg, { title: "", x: axis(x, mine[0]), y: axis(y, mine[1]), curves, markers: [], limits: [], plane: false, hodograph: null }, width, high);
    const live = element("g", { class: "live" }, this.svg);
    this.ring = element("circle", { class: "picked", r: 8, visibility: "hidden" }, live);
    this.hits = designs.map((design, k) => {
      const px = this.at.x.at(x.v[k]), py = this.at.y.at(y.v[k]), said = [x, y].map((c) => `${c.name} = ${withUnit(c.v[k], c.unit)}`).join(", ");
      const hit = element("circle", { class: "hit", r: 9, cx: round(px ?? 0), cy: round(py ?? 0), role: "radio", "aria-label": `Design ${design.name}: ${said}`, visibility: px == null || py == null ? "hidden" : "visible" }, live);
      element("title", {}, hit).textContent = `${design.name}: ${said}`;
      hit.addEventListener("click", () => { this.pick(k); hit.focus({ preventScroll: true }); });
      hit.addEventListener("keydown", (event) => this.key(event, k));
      return hit;
    });
    this.mark();
    if (focused) this.hits[this.picked].focus({ preventScroll: true });
  }

  // Keys go along the front, in the order of its abscissa.
  key(event, k) {
    const x = this.front.cols[this.axes[0]].v, order = [...x.keys()].filter((k) => known(x[k])).sort((a, b) => x[a] - x[b] || a - b), at = order.indexOf(k);
    const to = { ArrowRight: at + 1, ArrowDown: at + 1, ArrowLeft: at - 1, ArrowUp: at - 1, Home: 0, End: order.length - 1, " ": at, Enter: at }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    const next = order[Math.min(order.length - 1, Math.max(0, to))];
    this.pick(next);
    this.hits[next].focus({ preventScroll: true });
  }

  pick(k) {
    if (!this.front.designs[k]) return;
    this.picked = k;
    this.mark();
    this.tell();
  }

  // Marks the chosen one in the picture and in the table, and brings its row into sight.
  mark() {
    this.hits?.forEach((hit, k) => { hit.setAttribute("aria-checked", k === this.picked); hit.setAttribute("tabindex", k === this.picked ? 0 : -1); });
    const hit = this.hits?.[this.picked];
    if (hit) place(this.ring, +hit.getAttribute("cx"), +hit.getAttribute("cy"));
    this.rows.forEach((row, k) => k === this.picked ? row.setAttribute("aria-current", "true") : row.removeAttribute("aria-current"));
    const row = this.rows[this.picked], box = this.scroll;
    if (!row || !box) return;
    const head = box.querySelector("thead")?.offsetHeight ?? 0, above = row.offsetTop - head, below = row.offsetTop + row.offsetHeight - box.clientHeight;
    if (box.scrollTop > above) box.scrollTop = above;
    else if (box.scrollTop < below) box.scrollTop = below;
  }

  // What is known of the chosen design.
  tell() {
    const { cols, goals, designs } = this.front, k = this.picked, design = designs[k];
    const fact = (c, n) => tag("div", goals.includes(n) ? { class: "goal" } : {}, tag("dt", {}, c.name), tag("dd", {}, withUnit(c.v[k], c.unit)));
    const title = tag("h3", {}, `Design ${design.name}`), inside = [title];
    if (design.file) title.append(" ", tag("code", {}, design.file));
    this.moved?.stop();
    this.moved = null;
    if (design.stage) {
      const figure = tag("figure", { class: "stage" });
      figure.innerHTML = design.stage.svg;
      this.moved = new Moved(design.stage, figure.querySelector("svg"));
      inside.push(figure, tag("p", { class: "tools" }, this.moved.button, ...this.tab(design)));
    }
    inside.push(tag("dl", { class: "facts" }, ...cols.map(fact).slice(1)));
    this.panel.replaceChildren(...inside);
  }

  // The way to its motion with all plots, where the page has that.
  tab(design) {
    if (design.tab == null || !players[design.tab]) return [];
    const b = tag("button", { type: "button", "data-do": "motion" }, "Its motion and plots");
    b.addEventListener("click", () => { select(design.tab); sections[design.tab].scrollIntoView({ behavior: still.matches ? "auto" : "smooth" }); });
    return [b];
  }
}

// A mechanism that goes through its poses, on and on.
class Moved {
  constructor(stage, svg) {
    this.stage = stage;
    svg.querySelectorAll(".trace-past").forEach((g) => g.remove());
    this.parts = [...svg.querySelectorAll("[data-part]")].map((g) => [g, stage.anchors[+g.dataset.part]]);
    const gap = (l) => l.length > 3 ? Math.hypot(l[0] - l[l.length - 3], l[1] - l[l.length - 2]) + Math.abs(Math.sin((l[2] - l[l.length - 1]) / 2)) * 20 : 0;
    this.back = stage.links.some((l) => gap(l) > 1);
    this.passed = 0;
    this.button = tag("button", { type: "button", "data-do": "move" }, "");
    this.button.addEventListener("click", () => this.toggle(!this.playing));
    this.toggle(!still.matches && stage.poses > 1);
  }

  stop() { this.playing = false; }

  toggle(playing) {
    this.playing = playing;
    this.button.textContent = playing ? "Stop" : "Move";
    this.last = null;
    this.show();
    if (playing) requestAnimationFrame((now) => this.tick(now));
  }

  tick(now) {
    if (!this.playing) return;
    this.passed = (this.passed + Math.min(0.1, this.last == null ? 0 : (now - this.last) / 1000) / PASS) % 2;
    this.last = now;
    this.show();
    requestAnimationFrame((n) => this.tick(n));
  }

  show() {
    const part = this.back ? 1 - Math.abs(1 - this.passed) : this.passed % 1, at = part * (this.stage.poses - 1), row = Math.floor(at);
    const poses = this.stage.links.map((_, link) => linkPose(this.stage, link, row, at - row));
    for (const [group, anchor] of this.parts) {
      const t = anchor && transform(this.stage, poses, anchor);
      if (t) group.setAttribute("transform", t);
    }
  }
}

const fronts = JSON.parse(document.getElementById("fronts").textContent);
document.querySelectorAll(".front").forEach((card, k) => new Front(fronts[k], card));
