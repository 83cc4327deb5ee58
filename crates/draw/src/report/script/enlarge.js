// One plot as large as the window. Escape, the button or a touch beside it bring it back to its place.
const large = tag("dialog", { class: "large", "aria-label": "Enlarged plot" });
document.body.append(large);
let returning = null;

function enlarged(plot) {
  if (large.open) { large.close(); return; }
  const place = tag("div", { class: "card plot" });
  plot.figure.replaceWith(place);
  large.replaceChildren(plot.figure);
  returning = () => {
    place.replaceWith(plot.figure);
    plot.enlarge.textContent = "Enlarge";
    plot.fit();
    plot.enlarge.focus();
  };
  large.showModal();
  plot.enlarge.textContent = "Close";
  plot.enlarge.focus();
  plot.fit();
}
large.addEventListener("close", () => { returning?.(); returning = null; });
large.addEventListener("click", (event) => { if (event.target === large) large.close(); });
