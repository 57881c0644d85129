// Tables that are sorted by a click on a head, and whose rows are chosen by what stands in the
// columns that say so: <table class="sortable"><thead>… <th data-choose> …. Without a script they are
// tables as others.

(() => {
"use strict";

function textIn(row, column) {
  const cell = row.cells[column];
  return cell.dataset.value ?? cell.textContent.trim();
}

/** Numbers by size, before texts by letters; what is empty last. */
function compareTexts(a, b) {
  if (a === "" || b === "") return (a === "") - (b === "");
  const [x, y] = [parseFloat(a), parseFloat(b)], [isX, isY] = [!Number.isNaN(x), !Number.isNaN(y)];
  if (isX && isY && x !== y) return x - y;
  return isX !== isY ? isY - isX : a.localeCompare(b, "en", {numeric: true});
}

function sortBy(table, column) {
  const heads = [...table.tHead.rows[0].cells], head = heads[column], body = table.tBodies[0];
  const sign = head.ariaSort === "ascending" ? -1 : 1;
  for (const one of heads) one.removeAttribute("aria-sort");
  head.ariaSort = sign > 0 ? "ascending" : "descending";
  const keyed = [...body.rows].map((row) => [textIn(row, column), row]);
  const isEmpty = ([text]) => text === "";
  keyed.sort((a, b) => (isEmpty(a) || isEmpty(b) ? 1 : sign) * compareTexts(a[0], b[0]));
  body.append(...keyed.map(([, row]) => row));
}

function makeSortable(table) {
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    button.addEventListener("click", () => sortBy(table, column));
    head.append(button);
  });
}

/** Boxes for each text of a column; a row is shown while its box is checked. */
function addChoice(table, column) {
  const counts = new Map(), rows = [...table.tBodies[0].rows], set = document.createElement("fieldset");
  for (const row of rows) counts.set(textIn(row, column), (counts.get(textIn(row, column)) ?? 0) + 1);
  const legend = document.createElement("legend");
  legend.textContent = table.tHead.rows[0].cells[column].textContent;
  set.className = "choice";
  set.append(legend);
  for (const [text, count] of counts) {
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = true;
    box.addEventListener("change", () => {
      for (const row of rows) if (textIn(row, column) === text) row.hidden = !box.checked;
    });
    label.append(box, ` ${text} (${count})`);
    set.append(label);
  }
  table.before(set);
}

function start() {
  for (const table of document.querySelectorAll("table.sortable")) {
    [...table.tHead.rows[0].cells].forEach((head, column) => "choose" in head.dataset && addChoice(table, column));
    makeSortable(table);
  }
}

start();
})();
