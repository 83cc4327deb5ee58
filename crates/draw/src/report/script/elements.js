// Elements of pictures and of the page.
const SVG = "http://www.w3.org/2000/svg";
const round = (v) => Math.round(v * 1000) / 1000;

function element(name, attributes, parent) {
  const e = document.createElementNS(SVG, name);
  for (const key in attributes) e.setAttribute(key, attributes[key]);
  parent?.append(e);
  return e;
}

function tag(name, attributes = {}, ...inside) {
  const e = document.createElement(name);
  for (const key in attributes) e.setAttribute(key, attributes[key]);
  e.append(...inside);
  return e;
}

const cells = (kind, texts) => {
  const scope = kind === "th" ? { scope: "col" } : {};
  return tag("tr", {}, ...texts.map((t) => tag(kind, { class: "number", ...scope }, t)));
};

// How wide a text of the plots is, in pixels.
const FONT = 12;
const ruler = document.createElement("canvas").getContext("2d");
ruler.font = `${FONT}px ${getComputedStyle(document.documentElement).fontFamily}`;
const wide = (words) => ruler.measureText(words).width;

// A text that is cut where it has no room.
function fitting(words, room) {
  if (wide(words) <= room) return words;
  const letters = [...words];
  while (letters.length && wide(letters.join("") + "…") > room) letters.pop();
  return letters.join("") + "…";
}
