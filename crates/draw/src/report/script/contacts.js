// Contacts: rings at the places of the drawing where bodies touch, strike each other or are held by friction.
const RING = 2.2; // radius, mm on paper: round a pin, inside the block of a slider
class Contacts {
  constructor(motion, svg) {
    this.motion = motion;
    this.all = (motion.happenings ?? []).map((it) => {
      const near = new Uint8Array(motion.row.length);
      for (let k = 0; k < it.rows.length; k += 2) near.fill(1, it.rows[k], it.rows[k + 1] + 1);
      return { ...it, near };
    });
    this.rings = [];
    for (const it of this.all) {
      if (it.p == null) continue;
      const held = it.kind === "held";
      let ring = this.rings.find((r) => r.p === it.p && r.held === held);
      if (!ring) {
        const group = element("g", { class: held ? "touch held" : "touch", "data-point": motion.named[it.p] }, svg), r = held ? RING + 0.9 : RING;
        element("circle", { class: "halo", r }, group);
        element("circle", { class: "ring", r }, group);
        ring = { p: it.p, held, group, of: [] };
        this.rings.push(ring);
      }
      ring.of.push(it);
    }
  }

  // What is near in any row from one to another.
  near(first, last) { return this.all.filter((it) => it.near.subarray(first, last + 1).includes(1)); }

  // Lights up what was passed on the way from a row to another.
  show(first, last, poses) {
    const near = this.near(first, last);
    for (const { p, group, of } of this.rings) {
      const at = pointAt(this.motion, poses, p), on = at && of.some((it) => near.includes(it));
      group.classList.toggle("on", !!on);
      if (at) group.setAttribute("transform", `translate(${round(at[0])} ${round(this.motion.size[1] - at[1])})`);
    }
    return near;
  }
}
