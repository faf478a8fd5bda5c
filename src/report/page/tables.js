// Tables that sort.

/** The sort key of a cell: a pair is the key and the displayed text. */
const valueOf = (cell) => Array.isArray(cell) ? cell[0] : cell;

const isNumeric = (rows, k) => rows.every((row) => valueOf(row[k]) === null || typeof valueOf(row[k]) === "number");

function make(name, text = "", className = "") {
  const made = document.createElement(name);
  // Names of keys and options stand between backticks.
  const parts = `${text}`.split(/`([^`]+)`/);
  made.append(...parts.map((part, k) => (k % 2 ? make("code", part) : part)));
  if (className) made.className = className;
  return made;
}

/** Indicates that a box scrolls, if it does. */
function hintScroll(box, what) {
  const hint = make("p", `the ${what} continues: scroll sideways \u2192`, "more");
  hint.hidden = true;
  box.before(hint);
  const look = () => {
    const scrolls = box.scrollWidth > box.clientWidth + 1;
    hint.hidden = !scrolls;
    box.classList.toggle("scrolls", scrolls);
    // A scrolling box must be reachable without a pointer.
    if (scrolls) box.tabIndex = 0;
    else box.removeAttribute("tabindex");
  };
  new ResizeObserver(look).observe(box);
  for (const inner of box.children) new ResizeObserver(look).observe(inner);
}

/** Lets a row or a part of a picture be chosen by a click, or by Enter or the space bar. */
function choosable(row, chosen) {
  row.classList.add("shows");
  row.setAttribute("tabindex", 0);
  row.addEventListener("click", chosen);
  row.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    chosen();
  });
}

function buildTable(table, choose, choosePath) {
  const numeric = table.columns.map((_, k) => isNumeric(table.rows, k));
  const rows = table.rows.map((cells, index) => {
    const row = make("tr");
    cells.forEach((value, k) => {
      const shown = Array.isArray(value) ? value[1] : value === null ? "\u2013" : String(value);
      row.append(make("td", shown, numeric[k] ? "" : "text"));
    });
    const state = table.states[index];
    if (state !== undefined) {
      row.dataset.state = state;
      choosable(row, () => choose(state));
    }
    const path = table.paths[index] ?? null;
    if (path !== null) {
      row.dataset.path = path;
      choosable(row, () => choosePath(path));
    }
    return { row, cells };
  });
  const body = make("tbody");
  const head = make("tr");
  table.columns.forEach((column, k) => {
    const cell = make("th", "", numeric[k] ? "" : "text");
    cell.scope = "col";
    const button = make("button", column.name);
    button.type = "button";
    button.title = column.meaning;
    button.addEventListener("click", () => sort(k));
    cell.append(button);
    head.append(cell);
  });
  const sort = (k) => {
    const was = head.cells[k].getAttribute("aria-sort");
    const sign = was === "ascending" ? -1 : 1;
    for (const cell of head.cells) cell.removeAttribute("aria-sort");
    head.cells[k].setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
    const compare = (a, b) => {
      const [x, y] = [valueOf(a.cells[k]), valueOf(b.cells[k])];
      // Missing values come last in both orders.
      if (x === null || y === null) return (x === null) - (y === null);
      return sign * (numeric[k] ? x - y : String(x).localeCompare(String(y), "en", { numeric: true }));
    };
    body.append(...[...rows].sort(compare).map(({ row }) => row));
  };
  body.append(...rows.map(({ row }) => row));
  const whole = make("table");
  const top = make("thead");
  top.append(head);
  whole.append(top, body);
  const scroll = make("div", "", "scroll");
  scroll.append(whole);
  const parts = [make("h2", table.title), ...(table.note ? [make("p", table.note)] : []), scroll];
  element("tables").append(...parts);
  hintScroll(scroll, "table");
}
