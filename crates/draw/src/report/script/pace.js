// Pace: how much of a motion passes in a second on screen. What runs in time does so in real time, or so much slower or faster as is told.
const PASS = 6; // seconds on screen for one pass where it is not real time
const WATCHED = [2, 60]; // a pass of so many seconds is watched in real time

// Round paces, each 2 to 2.5 times the one before.
const rounds = (low, high) => {
  const all = [];
  for (let power = decade(low) - 1; power <= decade(high) + 1; power++) for (const digit of [1, 2, 4]) all.push(Number(`${digit}e${power}`));
  return all.filter((v) => v >= low * 0.999 && v <= high * 1.001);
};

// What a pace is called: "250 × slower".
const paceText = (pace) => pace === 1 ? "real time" : pace > 1 ? `${text(pace, 4)} × faster` : `${text(1 / pace, 4)} × slower`;

// The paces to choose from of a motion of so many seconds, the slowest first, and the one that it begins with.
function paces(long) {
  const first = long >= WATCHED[0] && long <= WATCHED[1] ? 1 : rounds(1e-30, 1e30).reduce((best, v) => Math.abs(Math.log(v * PASS / long)) < Math.abs(Math.log(best * PASS / long)) ? v : best, 1);
  const all = new Set([first, 1, ...rounds(first / 10, first * 10)]);
  return [[...all].sort((a, b) => a - b), first];
}

// The control of the speed of a motion in time: its paces in the place of multiples of a pass.
function offerPaces(select, long) {
  const [all, first] = paces(long);
  select.replaceChildren(...all.map((pace) => tag("option", { value: pace }, paceText(pace))));
  select.value = first;
}
