// Playback: one clock per motion drives the drawing, the plots and the read-out.
const still = matchMedia("(prefers-reduced-motion: reduce)");

class Player {
  constructor(motion, section) {
    this.motion = motion;
    this.section = section;
    this.count = motion.row.length;
    this.known = [];
    this.at = motion.row.indexOf(motion.shown);
    if (this.at < 0) this.at = 0;
    this.playing = false;
    this.sense = 1;
    for (const c of motion.cols) c.v = unpacked(c.v);
    if (motion.against) motion.against.values = motion.against.values.map((v) => v && unpacked(v));
    this.drive = motion.cols[motion.drive] ?? { name: "", unit: "", v: [] };
    this.clock = motion.cols[0] ?? this.drive;
    this.drawing = new Drawing(motion, section.querySelector(".drawing"), section);
    this.plots = [...section.querySelectorAll(".plot")].map((f) => new Plot(this, plotOfRun(motion, motion.plots[+f.dataset.plot]), f));
    if (this.count && motion.cols.length) this.choose(section.querySelector(".plots"));
    this.cells = [...section.querySelectorAll(".readout [data-column]")].flatMap((line) => {
      const column = +line.dataset.column, other = line.querySelector("[data-other]"), values = motion.against?.values[column];
      return [[line.querySelector(".number"), motion.cols[column].v], ...other && values ? [[other, values]] : []];
    });
    this.status = section.querySelector(".status");
    this.input = {};
    for (const e of section.querySelectorAll("[data-in]")) this.input[e.dataset.in] = e;
    const t = this.clock.v;
    this.timed = this.count > 1 && t.every((v, k) => known(v) && (k === 0 || v >= t[k - 1])) && t[this.count - 1] > t[0];
    // what runs in time is played in time: the speed is a part of it, not of a pass
    this.real = this.timed && this.clock.unit === "s";
    if (this.real) offerPaces(this.input.speed, t[this.count - 1] - t[0]);
    this.listen();
    this.note();
    this.show();
  }

  // One more plot of what the reader wants.
  choose(holder) {
    const chosen = new Chosen(this, holder);
    this.plots.push(chosen.plot);
    if (this.shown) chosen.plot.show(...this.shown);
    return chosen;
  }

  listen() {
    const on = { csv: () => saveCsv(this.motion), first: () => this.seek(0), back: () => this.step(-1), play: () => this.toggle(), on: () => this.step(1), last: () => this.seek(this.count - 1) };
    for (const b of this.section.querySelectorAll("[data-do]")) b.addEventListener("click", on[b.dataset.do]);
    this.playButton = this.section.querySelector("[data-do=play]");
    const { row, drive, time, labels, traces, other, speed, mode } = this.input;
    row.addEventListener("input", () => this.seek(+row.value));
    const nearest = (values, v) => values.reduce((best, x, k) => known(x) && !(Math.abs(x - v) >= Math.abs(values[best] - v)) ? k : best, 0);
    const typed = (input, values) => input?.addEventListener("change", () => { if (input.value !== "") this.seek(nearest(values, +input.value)); });
    typed(drive, this.drive.v);
    typed(time, this.clock.v);
    labels.addEventListener("change", () => this.section.classList.toggle("no-labels", !labels.checked));
    traces.addEventListener("change", () => this.section.classList.toggle("no-traces", !traces.checked));
    other?.addEventListener("change", () => this.section.classList.toggle("no-other", !other.checked));
    speed.addEventListener("change", () => this.note());
    // a motion that does not end where it began goes back by itself
    const v = this.motion.links.map((l) => l.length > 3 ? Math.hypot(l[0] - l[l.length - 3], l[1] - l[l.length - 2]) + Math.abs(Math.sin((l[2] - l[l.length - 1]) / 2)) * 20 : 0);
    if (v.some((far) => far > 1)) mode.value = "pingpong";
  }

  note() {
    const t = this.clock.v, line = this.section.querySelector(".rate");
    if (!this.timed) { line.textContent = "Played row by row"; return; }
    const rate = +this.input.speed.value, long = t[this.count - 1] - t[0];
    line.textContent = !this.real ? `Played along the ${this.clock.name}` : `1 s on screen is ${text(rate, 3)} s of the motion; a pass takes ${text(long / rate, 2)} s`;
  }

  // The share of a pass that passes in a second on screen.
  pace() {
    const speed = +this.input.speed.value, t = this.clock.v;
    return this.real ? speed / (t[this.count - 1] - t[0]) : speed / PASS;
  }

  toggle(play = !this.playing) {
    this.playing = play && this.count > 1;
    if (this.playing && this.input.mode.value === "once" && this.at >= this.count - 1) this.at = 0;
    this.playButton.setAttribute("aria-pressed", this.playing);
    this.playButton.querySelector("path").setAttribute("d", this.playing ? "M4 3h3v10H4zM9 3h3v10H9z" : "M4 2.5v11L13 8z");
    if (this.playing) { this.last = null; this.passed = this.toClock(this.at); requestAnimationFrame((now) => this.tick(now)); }
    else { this.at = Math.round(this.at); this.show(); }
  }

  // Share of the pass at a row, and back; by time where there is one.
  toClock(at) {
    if (!this.timed) return at / (this.count - 1);
    const t = this.clock.v, k = Math.min(Math.floor(at), this.count - 2);
    return (t[k] + (at - k) * (t[k + 1] - t[k]) - t[0]) / (t[this.count - 1] - t[0]);
  }
  toRow(clock) {
    if (!this.timed) return clock * (this.count - 1);
    const t = this.clock.v, want = t[0] + clock * (t[this.count - 1] - t[0]);
    let low = 0, high = this.count - 1;
    while (high - low > 1) { const mid = (low + high) >> 1; if (t[mid] <= want) low = mid; else high = mid; }
    return low + (t[high] > t[low] ? Math.min(1, (want - t[low]) / (t[high] - t[low])) : 0);
  }

  tick(now) {
    if (!this.playing) return;
    const passed = this.last == null ? 0 : Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    const mode = this.input.mode.value;
    if (mode !== "pingpong") this.sense = 1;
    const before = this.at;
    this.passed += this.sense * passed * this.pace();
    if (this.passed > 1 || this.passed < 0) {
      if (mode === "pingpong") { this.sense = this.passed > 1 ? -1 : 1; this.passed = Math.min(1, Math.max(0, this.passed)); }
      else if (mode === "loop") this.passed -= Math.floor(this.passed);
      else { this.at = this.count - 1; this.toggle(false); return; }
    }
    this.at = this.toRow(this.passed);
    // what was passed since the last picture lights up in this one
    this.show(this.sense * (this.at - before) > 0 ? before : this.at);
    requestAnimationFrame((n) => this.tick(n));
  }

  smooth(row) {
    if (this.known[row] === undefined) this.known[row] = isSmooth(this.motion, row);
    return this.known[row];
  }

  seek(row) {
    if (row == null || !this.count) return;
    this.at = Math.min(this.count - 1, Math.max(0, row));
    if (this.playing) this.passed = this.toClock(this.at);
    this.show();
  }
  step(by) { if (this.playing) this.toggle(false); this.seek(Math.round(this.at) + by); }

  show(since = this.at) {
    const motion = this.motion;
    let row = Math.min(this.count - 1, Math.floor(this.at)), share = row < 0 ? 0 : this.at - row;
    // rows that lie far apart are shown one after the other
    if (share > 0 && !this.smooth(row)) { row = Math.round(this.at); share = 0; }
    if (row < 0) { this.status.textContent = "No row was reached"; return; }
    const passed = [since, this.at].map(Math.round).sort((a, b) => a - b);
    const reached = this.drawing.show(row, share, passed);
    this.shown = [row, share];
    for (const plot of this.plots) plot.show(row, share);
    const near = Math.round(this.at);
    this.input.row.value = near;
    const put = (input, v, digits) => { if (input && document.activeElement !== input) input.value = known(v) ? Number(v.toPrecision(digits)) : ""; };
    const drive = this.drive.v[near], time = this.clock.v[near];
    put(this.input.drive, drive, 6);
    put(this.input.time, time, 5);
    for (const [cell, v] of this.cells) cell.textContent = text(v[near]);
    this.input.row.setAttribute("aria-valuetext", `${this.drive.name} ${withUnit(drive, this.drive.unit)}, ${withUnit(time, this.clock.unit)}`);
    const event = motion.events.find((e) => e.row === near);
    const gap = motion.gaps.find(([a, b]) => motion.row[near] >= a && motion.row[near] <= b);
    const bad = !reached || !!gap;
    this.status.classList.toggle("bad", bad);
    const said = bad ? `Row ${motion.row[near] + 1} was not reached${gap ? ": " + gap[2] : ""}` : event ? event.label : this.playing ? "" : `Row ${motion.row[near] + 1} of ${motion.all}${this.drawing.near.map((it) => `, ${it.label}`).join("")}`;
    if (this.status.textContent !== said) this.status.textContent = said;
  }
}

const data = JSON.parse(document.getElementById("data").textContent);
const sections = [...document.querySelectorAll(".motion")];
const players = sections.map((section, k) => new Player(data[k], section));
const tabs = [...document.querySelectorAll("[role=tab]")];
let current = 0;
function select(index, focus) {
  players.forEach((p) => p.toggle(false));
  current = index;
  sections.forEach((s, k) => s.classList.toggle("hidden", k !== index));
  tabs.forEach((t, k) => { t.setAttribute("aria-selected", k === index); t.tabIndex = k === index ? 0 : -1; });
  if (focus) tabs[index].focus();
  if (players[index] && !still.matches) players[index].toggle(true);
}
tabs.forEach((tab, k) => {
  tab.addEventListener("click", () => select(k));
  tab.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (by) { event.preventDefault(); event.stopPropagation(); select((k + by + tabs.length) % tabs.length, true); }
  });
});
document.addEventListener("keydown", (event) => {
  const player = players[current], tag = event.target.tagName;
  if (!player || event.ctrlKey || event.metaKey || event.altKey) return;
  if (tag === "SELECT" || (tag === "INPUT" && event.target.type === "number") || event.target.closest(".scroll")) return;
  if (event.key === " " && (tag === "BUTTON" || tag === "SUMMARY" || event.target.type === "checkbox")) return;
  const boxes = (selector) => [...player.section.querySelectorAll(selector)];
  const flip = (list) => { const on = !list.every((box) => box.checked); for (const box of list) { box.checked = on; box.dispatchEvent(new Event("change")); } };
  const by = event.shiftKey ? 10 : 1;
  const act = { " ": () => player.toggle(), ArrowLeft: () => player.step(-by), ArrowRight: () => player.step(by), Home: () => player.seek(0), End: () => player.seek(player.count - 1), l: () => flip(boxes("[data-in=labels]")), t: () => flip(boxes("[data-in=traces]")), o: () => flip(boxes("[data-in=other]")), v: () => flip(boxes("[data-vector=velocity]")), a: () => flip(boxes("[data-vector=acceleration]")), f: () => flip(boxes("[data-role]")) }[event.key];
  if (act) { event.preventDefault(); act(); }
});
if (players.length) select(0);
