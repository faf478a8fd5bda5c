// A sweep's page: the chosen axes, the selected point, and all panels.

const SIGNS = "bands: certified bounds, 95 % for shares; \u25cb no trap; ^ caged, proved; \u00d7 impossible";

function legend(series) {
  const key = make("p", "", "legend");
  if (series.length > 1) {
    series.forEach(({ name }, k) => {
      const entry = make("span", name, "series");
      const mark = make("canvas");
      entry.prepend(mark);
      key.append(entry);
      mark.width = 28;
      mark.height = 10;
      const pen = mark.getContext("2d");
      pen.strokeStyle = seriesColour(k);
      pen.lineWidth = 4;
      pen.setLineDash(seriesDashes(k));
      line(pen, [[0, 5], [28, 5]]);
    });
  }
  key.append(make("span", SIGNS, "note"));
  return key;
}

/** A list to choose from, with its name. */
function chooser(id, name, entries) {
  const label = make("label", `${name} `, "choice");
  const list = make("select");
  list.id = id;
  list.append(...entries.map((entry, k) => new Option(entry, k)));
  label.append(list);
  return [label, list];
}

/** The tiles of a point, bound. */
function drawThumbnail(canvas, point) {
  const tiles = charts.tiles[charts.points[point].tiles ?? -1];
  const { pen, width, height } = fresh(canvas, 0.56, 60);
  if (!tiles) return;
  const corners = [...tiles.fixed.outline, ...tiles.moving.outline.map((p) => placed(p, tiles.bound))];
  const [xs, ys] = [0, 1].map((k) => corners.map((p) => p[k]));
  const box = [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
  const { at } = fitting(box, width, height, 3);
  drawTile(pen, tiles.fixed, [0, 0, 0], at, theme.fixed);
  drawTile(pen, tiles.moving, tiles.bound, at, theme.moving);
}

/** The selected point: its tiles, its figures, and links to its complete results. */
function showPoint() {
  const card = element("point"), point = hovered ?? pinned;
  const [canvas, text] = card.children;
  text.replaceChildren();
  if (point === null) {
    text.textContent = "Point at a dot, a cell or a row to see its tiles and figures; click to keep it.";
    canvas.hidden = true;
    return;
  }
  const { readout, design } = charts.points[point];
  text.append(make("span", readout, "readout"));
  if (design) {
    const folder = design.replace(/\.toml$/, "");
    const link = make("a", "its page");
    link.href = `${folder}/report.html`;
    text.append(make("br"), "Full analysis: ", make("code", `tilebind analyse ${design} --out ${folder}`), ", then ", link, ".");
  }
  canvas.hidden = !charts.tiles.length;
  if (!canvas.hidden) drawThumbnail(canvas, point);
}

/** A panel with chosen axes: a varied number or a figure to the right, a figure upwards. */
function chosenGroup(x) {
  const isAxis = x < charts.axes.length;
  const series = new Map();
  charts.points.forEach((point, k) => {
    const value = isAxis ? point.places[x] : point.figures[x - charts.axes.length]?.[0] ?? null;
    if (value === null || value === undefined) return;
    // Curves join points that differ only in this number.
    const others = charts.axes.map((name, axis) => axis === x || point.places[axis] === null ? "" : `${name} ${point.places[axis]}`);
    const name = [point.series, ...(isAxis ? others : [])].filter(Boolean).join(", ");
    series.set(name, [...series.get(name) ?? [], [value, k]]);
  });
  const sorted = [...series].map(([name, points]) => ({ name, points: points.sort((a, b) => a[0] - b[0]) }));
  const figure = charts.figures[x - charts.axes.length];
  return { axis: isAxis ? charts.axes[x] : figure.unit ? `${figure.label} (${figure.unit})` : figure.label, series: sorted };
}

function showCharts() {
  readTheme();
  const section = element("charts");
  section.hidden = false;
  const rows = [...document.querySelectorAll("#tables table")[0].tBodies[0].rows];
  const panels = [];
  let waiting = false;
  const drawAll = () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      for (const panel of panels) panel.draw();
    });
  };
  const mark = () => {
    const isHere = (point) => point === hovered || point === pinned;
    rows.forEach((row, point) => row.classList.toggle("chosen", isHere(point)));
    for (const spot of spots) spot.classList.toggle("chosen", isHere(Number(spot.dataset.point)));
  };
  const hover = (point) => {
    if (point === hovered) return;
    hovered = point;
    mark();
    showPoint();
    drawAll();
  };
  const pin = (point) => {
    pinned = point === pinned ? null : point;
    mark();
    showPoint();
    drawAll();
  };
  const watch = (panel) => {
    panels.push(panel);
    const under = (event) => panel.under(pointer(panel.canvas, event));
    panel.canvas.addEventListener("pointermove", (event) => hover(under(event)));
    panel.canvas.addEventListener("pointerdown", (event) => hover(under(event)));
    panel.canvas.addEventListener("click", (event) => pin(under(event)));
    panel.canvas.addEventListener("pointerleave", () => hover(null));
  };
  const spots = [...document.querySelectorAll("#pictures [data-point]")];
  for (const spot of spots) {
    const point = Number(spot.dataset.point);
    spot.addEventListener("pointerenter", () => hover(point));
    spot.addEventListener("pointerleave", () => hover(null));
    spot.addEventListener("click", () => pin(point));
  }

  const names = charts.points.map(({ name }) => name);
  const [against, baselines] = chooser("baseline", "baseline", ["none", ...names]);
  baseline = charts.baseline;
  baselines.value = baseline === null ? 0 : baseline + 1;
  baselines.addEventListener("change", () => {
    baseline = Number(baselines.value) ? Number(baselines.value) - 1 : null;
    drawAll();
  });
  const card = make("div");
  card.id = "point";
  card.append(make("canvas"), make("p"));
  // The pictures above the chosen axes, with the selected point.
  section.append(card, element("pictures"));
  addChosen(section, against, panels, watch, drawAll);
  rows.forEach((row, point) => {
    row.addEventListener("pointerenter", () => hover(point));
    row.addEventListener("pointerleave", () => hover(null));
    row.addEventListener("focus", () => hover(point));
    row.addEventListener("blur", () => hover(null));
    choosable(row, () => {
      pin(point);
      bring("point");
    });
    if (!charts.tiles.length) return;
    row.cells[0].prepend(make("canvas"));
  });
  followPage(() => {
    for (const panel of panels) panel.draw();
    rows.forEach((row, point) => charts.tiles.length && drawThumbnail(row.cells[0].firstChild, point));
    showPoint();
  });
}

/** The panel with the chosen axes. */
function addChosen(section, against, panels, watch, drawAll) {
  const figures = charts.figures.map(({ label }) => label);
  const [across, xs] = chooser("across", "x axis", [...charts.axes, ...figures]);
  const [upwards, ys] = chooser("upwards", "y axis", figures);
  const choices = make("p", "", "legend");
  choices.id = "controls";
  choices.append(across, upwards, against);
  const key = make("div");
  const grid = make("div", "", "panels");
  section.append(make("h2", "Plot of any two quantities"), choices, key, grid);
  const build = () => {
    const old = panels.findIndex((panel) => panel.isChosen);
    if (old >= 0) panels.splice(old, 1);
    grid.replaceChildren();
    const group = chosenGroup(Number(xs.value));
    const { label, unit } = charts.figures[Number(ys.value)];
    const panel = new CurvePanel(grid, group, { heading: label, unit, figures: [Number(ys.value)] });
    panel.isChosen = true;
    key.replaceChildren(legend(group.series.length > 3 * COUNT ? [] : group.series));
    watch(panel);
    drawAll();
  };
  ys.value = Math.max(0, charts.figures.findIndex(({ label }) => label === "selectivity"));
  xs.addEventListener("change", build);
  ys.addEventListener("change", build);
  build();
}
