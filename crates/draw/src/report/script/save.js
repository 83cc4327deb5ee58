// What the page keeps for people: a plot as SVG or PNG, a table as CSV. Nothing leaves the computer.
const PIXELS = 2; // pixels of a picture for each of the page

function keep(name, blob) {
  const link = tag("a", { download: name, href: URL.createObjectURL(blob) });
  link.click();
  // the browser may still be reading it
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

// The parts of a text that a file name takes.
const fileName = (...parts) => parts.map((p) => p.split(/[^\p{L}\p{N}_]+/u).filter(Boolean).join("-").slice(0, 60)).filter(Boolean).join("-") || "plot";

// A plot as a file of its own: on paper, in the colours of light paper, without what follows the pointer.
function standalone(svg) {
  const [, , width, height] = svg.getAttribute("viewBox").split(" ");
  const copy = svg.cloneNode(true);
  copy.querySelectorAll(".live").forEach((e) => e.remove());
  for (const name of ["class", "style", "tabindex"]) copy.removeAttribute(name);
  for (const [name, value] of Object.entries({ xmlns: SVG, width, height, "font-family": getComputedStyle(document.documentElement).fontFamily })) copy.setAttribute(name, value);
  copy.setAttribute("role", "img");
  copy.prepend(element("rect", { width, height, fill: "var(--background)" }));
  const title = element("title", {});
  title.textContent = svg.getAttribute("aria-label");
  copy.prepend(title);
  const light = document.styleSheets[0].cssRules[0].style;
  return new XMLSerializer().serializeToString(copy).replace(/var\((--[\w-]+)\)/g, (_, name) => light.getPropertyValue(name).trim());
}

function saveSvg(svg, name) {
  keep(`${name}.svg`, new Blob([standalone(svg), "\n"], { type: "image/svg+xml" }));
}

function savePng(svg, name) {
  const picture = new Image();
  picture.onload = () => {
    const canvas = tag("canvas", { width: PIXELS * picture.width, height: PIXELS * picture.height });
    canvas.getContext("2d").drawImage(picture, 0, 0, canvas.width, canvas.height);
    canvas.toBlob((blob) => keep(`${name}.png`, blob), "image/png");
  };
  picture.src = `data:image/svg+xml,${encodeURIComponent(standalone(svg))}`;
}

// The table as the run's own CSV file has it; behind its columns those that are plotted besides.
function csv(motion) {
  const own = motion.cols.slice(0, motion.own), more = motion.cols.slice(motion.own, motion.own + motion.more), tests = motion.cols.slice(motion.own + motion.more);
  const quoted = (t) => /[,"\n\r]/.test(t) ? `"${t.replaceAll('"', '""')}"` : t;
  const heads = (list) => list.map((c) => quoted(`${c.name} [${c.unit || 1}]`));
  const lines = [[...heads(own), ...heads(tests), "note", ...heads(more)]];
  motion.row.forEach((row, k) => {
    const note = motion.notes.find(([first, last]) => row >= first && row <= last);
    const values = (list) => list.map((c) => exact(c.v[k]));
    lines.push([...values(own), ...values(tests), quoted(note ? note[2] : ""), ...values(more)]);
  });
  return (motion.mark ? `${motion.mark}\n` : "") + lines.map((l) => `${l.join(",")}\n`).join("");
}

function saveCsv(motion) {
  keep(`${motion.name}${motion.mark ? ".partial" : ""}.csv`, new Blob([csv(motion)], { type: "text/csv" }));
}
