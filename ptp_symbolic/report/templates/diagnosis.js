"use strict";
// One cursor through all runs at the same time, and figures that can be enlarged.
const plots = [...document.querySelectorAll(".plot")].map((box) => {
  const svg = box.querySelector("svg[data-time]");
  const [first, last] = svg.dataset.time.split(" ").map(Number);
  const [left, right] = svg.dataset.span.split(" ").map(Number);
  const line = box.appendChild(document.createElement("i"));
  line.className = "cursor";
  const shown = box.closest("figure").querySelector(".at");
  return { box, svg, first, last, left, right, line, shown, zoom: 1 };
});

function timeAt(plot, event) {
  const frame = plot.svg.getBoundingClientRect();
  const share = (event.clientX - frame.left) / frame.width;
  const along = (share - plot.left) / (plot.right - plot.left);
  return plot.first + along * (plot.last - plot.first);
}

function place(plot, time) {
  const along = (time - plot.first) / (plot.last - plot.first);
  const inside = along >= 0 && along <= 1;
  plot.line.style.display = inside ? "block" : "none";
  plot.shown.textContent = inside ? ` · t = ${time.toFixed(3)} s` : "";
  plot.line.style.left = `${(plot.left + along * (plot.right - plot.left)) * plot.svg.clientWidth}px`;
}

function enlarge(factor) {
  for (const plot of plots) {
    const middle = (plot.box.scrollLeft + plot.box.clientWidth / 2) / plot.svg.clientWidth;
    plot.zoom = Math.min(Math.max(plot.zoom * factor, 1), 8);
    plot.svg.style.width = `${100 * plot.zoom}%`;
    plot.box.scrollLeft = middle * plot.svg.clientWidth - plot.box.clientWidth / 2;
  }
}

for (const plot of plots) {
  plot.box.addEventListener("pointermove", (event) => {
    const time = timeAt(plot, event);
    plots.forEach((other) => place(other, time));
  });
  plot.box.addEventListener("pointerleave", () => plots.forEach((other) => place(other, NaN)));
  plot.box.addEventListener("scroll", () => {
    const share = plot.box.scrollLeft / plot.svg.clientWidth;
    for (const other of plots) {
      const target = share * other.svg.clientWidth;
      if (other !== plot && Math.abs(other.box.scrollLeft - target) > 1) other.box.scrollLeft = target;
    }
  });
}
for (const button of document.querySelectorAll("button[data-zoom]")) {
  button.addEventListener("click", () => enlarge(Number(button.dataset.zoom)));
}
// On a narrow screen a table is shown as cards: every cell then says what its column is.
for (const table of document.querySelectorAll(".wide table")) {
  const heads = [...table.querySelectorAll("thead th")].map((head) => head.innerHTML.replace(/<[^>]+>/g, " ").trim());
  for (const row of table.querySelectorAll("tbody tr")) {
    [...row.cells].forEach((cell, place) => {
      if (cell.tagName === "TD" && cell.colSpan === 1 && heads[place]) cell.dataset.head = heads[place];
    });
  }
}
document.documentElement.classList.add("scripted");
