// A straight arrow on paper, in mm with y up: shaft, head, and the two ticks that say that it is shorter than it should be.
function arrow(motion, from, vector, broken) {
  const { head, half, gap } = motion.arrow, high = motion.size[1], long = Math.hypot(vector[0], vector[1]);
  const c = vector[0] / long, s = vector[1] / long;
  const at = (x, y) => [from[0] + c * x - s * y, from[1] + s * x + c * y];
  const path = (points, close) => points.map(([x, y], k) => `${k ? "L" : "M"}${round(x)} ${round(high - y)}`).join("") + (close ? "Z" : "");
  const end = long - 0.8 * head, a = long / 2 - gap, b = long / 2 + gap;
  return {
    tip: at(long, 0),
    along: [c, s],
    shaft: broken ? path([at(0, 0), at(a, 0)]) + path([at(b, 0), at(end, 0)]) : end > 0 ? path([at(0, 0), at(end, 0)]) : "",
    ticks: broken ? [a, b].map((x) => path([at(x - 0.5, -1.4), at(x + 0.5, 1.4)])).join("") : "",
    head: path([at(long, 0), at(long - head, half), at(long - head, -half)], true),
  };
}
