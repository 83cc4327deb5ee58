// Poses: from the rows of a motion to the transforms of the drawing's parts. Paper millimetres, y up, as the data has them.

// A link's place between two rows: x, y, angle; null where a row was not reached.
function linkPose(motion, link, row, share) {
  const v = motion.links[link], a = v && v.length === 3 ? 0 : 3 * row;
  if (!v || v[a] == null) return null;
  if (share === 0 || v[a + 3] == null) return [v[a], v[a + 1], v[a + 2]];
  const turn = v[a + 5] - v[a + 2];
  const short = turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI));
  return [v[a] + share * (v[a + 3] - v[a]), v[a + 1] + share * (v[a + 4] - v[a + 1]), v[a + 2] + share * short];
}

// Whether poses may be drawn between a row and the next: bodies are moved one by one, and where one of them turns more
// than this their pins would be seen to part.
const SMALL_TURN = 0.1;
function isSmooth(motion, row) {
  return motion.links.every((v, link) => {
    if (!v || v.length === 3) return true;
    const from = linkPose(motion, link, row, 0), to = linkPose(motion, link, row + 1, 0);
    if (!from || !to) return false;
    const turn = to[2] - from[2];
    return Math.abs(turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI))) <= SMALL_TURN;
  });
}

function pointAt(motion, poses, index) {
  const p = motion.points[index];
  const pose = p && poses[p[0]];
  if (!pose) return null;
  const c = Math.cos(pose[2]), s = Math.sin(pose[2]);
  return [pose[0] + c * p[1] - s * p[2], pose[1] + s * p[1] + c * p[2]];
}

function transform(motion, poses, anchor) {
  const [kind, first, second, extra] = anchor;
  const at = pointAt(motion, poses, first);
  if (!at) return null;
  let angle = 0, stretch = "";
  if (kind === "o") {
    if (!poses[second]) return null;
    angle = poses[second][2] + extra;
  } else if (kind !== "p") {
    const to = pointAt(motion, poses, second);
    if (!to) return null;
    angle = Math.atan2(to[1] - at[1], to[0] - at[0]);
    if (kind === "b") stretch = ` scale(${round(Math.hypot(to[0] - at[0], to[1] - at[1]) / (extra || 1))} 1)`;
  }
  const turn = angle ? ` rotate(${round(-angle * 180 / Math.PI)})` : "";
  return `translate(${round(at[0])} ${round(motion.size[1] - at[1])})${turn}${stretch}`;
}

// The outline of another design, which moves with the rows of this one.
class Other {
  constructor(against, svg) {
    this.against = against;
    this.parts = against ? [...svg.querySelectorAll(".other[data-part]")].map((g) => [g, against.anchors[+g.dataset.part]]) : [];
  }

  // A part without a place in this row is not shown.
  show(row, share) {
    if (!this.parts.length) return;
    const at = share > 0 && !isSmooth(this.against, row) ? [row + Math.round(share), 0] : [row, share];
    const poses = this.against.links.map((_, link) => linkPose(this.against, link, ...at));
    for (const [group, anchor] of this.parts) {
      const t = anchor && transform(this.against, poses, anchor);
      group.setAttribute("visibility", t ? "visible" : "hidden");
      if (t) group.setAttribute("transform", t);
    }
  }
}

class Drawing {
  constructor(motion, svg, section) {
    this.motion = motion;
    this.svg = svg;
    this.parts = [...svg.querySelectorAll("[data-part]:not(.other)")].map((g) => [g, motion.anchors[+g.dataset.part]]);
    this.other = new Other(motion.against, svg);
    svg.querySelectorAll(".trace-past").forEach((g) => g.remove());
    this.loads = new Loads(motion, svg, section);
    this.vectors = new Vectors(motion, svg, section);
    this.contacts = new Contacts(motion, svg);
    const count = motion.row.length;
    const before = svg.querySelector(".joint");
    this.trails = motion.traces.map((trace) => {
      const path = element("path", { class: "trail", fill: "none", stroke: trace.c, "stroke-width": 0.55, "stroke-linecap": "round", "stroke-linejoin": "round" });
      svg.insertBefore(path, before);
      const pieces = [];
      let fresh = true;
      for (let row = 0; row < count; row++) {
        const p = pointAt(motion, motion.links.map((_, link) => linkPose(motion, link, row, 0)), trace.p);
        pieces.push(p ? `${fresh ? "M" : "L"}${round(p[0])} ${round(motion.size[1] - p[1])}` : "");
        fresh = !p;
      }
      return { path, pieces };
    });
  }

  // Shows the pose at a row, or a share of the way to the next, and what happened from one row to another; false where it was not
  // reached.
  show(row, share, passed = [row, row]) {
    const motion = this.motion;
    const poses = motion.links.map((_, link) => linkPose(motion, link, row, share));
    let reached = motion.row.length > 0;
    for (const [group, anchor] of this.parts) {
      const t = anchor && transform(motion, poses, anchor);
      if (t) group.setAttribute("transform", t);
      else reached = false;
    }
    this.svg.classList.toggle("stale", !reached);
    this.other.show(row, share);
    this.loads.show(row, share);
    this.vectors.show(row, share, poses);
    this.near = this.contacts.show(...passed, poses);
    for (const { path, pieces } of this.trails) path.setAttribute("d", pieces.slice(0, row + 1).join(""));
    return reached;
  }
}
