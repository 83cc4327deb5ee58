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
    named(plot, "Enlarge", "Show this plot as large as the window");
  };
  large.showModal();
  named(plot, "Close", "Back to the page");
}

function named(plot, name, title) {
  plot.enlarge.textContent = name;
  plot.enlarge.title = title;
  plot.enlarge.setAttribute("aria-label", `${title}: ${plot.what}`);
  plot.fit();
  plot.enlarge.focus();
}

large.addEventListener("close", () => { returning?.(); returning = null; });
large.addEventListener("click", (event) => { if (event.target === large) large.close(); });
