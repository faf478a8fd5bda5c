// A sweep: its points as curves over one varied number or maps over two, linked with the table.

const charts = page.charts;
/** Okabe and Ito's colours, those of the pictures; the last one is the ink's. */
const SERIES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const seriesColour = (k) => SERIES[k] ?? theme.ink;
/** Colours of a map from nothing to the most. */
const RAMP = ["#440154", "#414487", "#2a788e", "#22a884", "#7ad151", "#fde725"];
/** The point under the pointer, by its place in the sweep. */
let hovered = null;

const figureOf = (point, figure) => charts.points[point].figures[figure];

/** Ticks of a figure's axis and its name. */
function figureTicks(range, unit, count) {
  if (unit === "%") {
    const { ticks, decimals } = roundTicks(100 * range[0], 100 * range[1], count);
    return { ticks: ticks.map((t) => [t / 100, minus(t.toFixed(decimals))]), name: "%" };
  }
  if (unit) {
    const { ticks, unit: name } = quantityTicks(range, unit, count);
    return { ticks, name };
  }
  const { ticks, decimals } = roundTicks(...range, count);
  return { ticks: ticks.map((t) => [t, minus(t.toFixed(decimals))]), name: "" };
}

function blended(colour, other, share) {
  const parts = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));
  const [a, b] = [parts(colour), parts(other)];
  return `rgb(${a.map((value, k) => Math.round(value + (b[k] - value) * share)).join(" ")})`;
}

function rampColour(share) {
  const at = Math.max(0, Math.min(1, share)) * (RAMP.length - 1);
  const below = Math.min(Math.floor(at), RAMP.length - 2);
  return blended(RAMP[below], RAMP[below + 1], at - below);
}

/** A canvas with a heading, in a grid of them. */
function panelCanvas(grid, heading) {
  const box = make("figure");
  const canvas = make("canvas");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", heading);
  const caption = make("figcaption");
  caption.append(make("strong", heading));
  box.append(caption, canvas);
  grid.append(box);
  return canvas;
}

/** One figure, a curve a series. */
class CurvePanel {
  constructor(grid, group, panel) {
    Object.assign(this, { group, panel, canvas: panelCanvas(grid, panel.heading) });
    this.values = this.range();
  }

  /** From zero, or from below it, to a little above the highest value. */
  range() {
    const all = this.group.series.flatMap(({ points }) => points.flatMap(([, point]) =>
      this.panel.figures.flatMap((figure) => (figureOf(point, figure) ?? []).filter((v) => v !== null))));
    if (this.panel.unit === "%") return [0, 1];
    const [low, high] = [Math.min(0, ...all), Math.max(0, ...all)];
    if (high - low === 0) return [0, this.panel.unit === "J" ? 2e-3 : 1];
    return [low < 0 ? low - 0.08 * (high - low) : 0, high + 0.08 * (high - low)];
  }

  draw() {
    const { pen, width, height } = fresh(this.canvas, 0.68);
    const xs = this.group.series.flatMap(({ points }) => points.map(([x]) => x));
    const [first, last] = [Math.min(...xs), Math.max(...xs)];
    const room = 0.03 * (last - first || 1);
    const plot = this.plot = new Plot([62, 8, width - 10, height - 44], [first - room, last + room], this.values);
    const y = figureTicks(this.values, this.panel.unit, 5);
    const x = roundTicks(first, last, 5);
    axes(pen, plot, { ticks: x.ticks.map((t) => [t, minus(t.toFixed(x.decimals))]), name: this.group.axis }, y);
    this.dots = [];
    let any = false;
    pen.save();
    plot.clip(pen);
    this.group.series.forEach((series, number) => {
      for (const figure of this.panel.figures) any = this.curve(pen, series, number, figure) || any;
      this.crosses(pen, series, number);
    });
    pen.restore();
    if (!any) {
      pen.fillStyle = theme.soft;
      pen.textAlign = "center";
      pen.fillText("none", (plot.box[0] + plot.box[2]) / 2, (plot.box[1] + plot.box[3]) / 2);
    }
    for (const { point, at, colour } of this.dots) {
      const here = point === hovered;
      pen.beginPath();
      pen.arc(...at, here ? 6 : 3.2, 0, 2 * Math.PI);
      pen.fillStyle = here ? theme.here : colour;
      pen.fill();
      pen.strokeStyle = theme.page;
      pen.lineWidth = 1.2;
      pen.stroke();
    }
  }

  /** Whether there was anything to draw. */
  curve(pen, series, number, figure) {
    const colour = seriesColour(number);
    const known = series.points.map(([x, point]) => ({ x, point, estimate: figureOf(point, figure) }));
    const pieces = [[]];
    for (const place of known) {
      if (place.estimate && place.estimate[0] !== null) pieces.at(-1).push(place);
      else pieces.push([]);
    }
    for (const piece of pieces) {
      const bounded = piece.filter(({ estimate }) => estimate[1] !== null && estimate[2] !== null);
      if (bounded.length === piece.length && piece.length > 1) {
        pen.beginPath();
        for (const { x, estimate } of piece) pen.lineTo(...this.plot.at(x, estimate[1]));
        for (const { x, estimate } of [...piece].reverse()) pen.lineTo(...this.plot.at(x, estimate[2]));
        pen.closePath();
        pen.globalAlpha = 0.25;
        pen.fillStyle = colour;
        pen.fill();
        pen.globalAlpha = 1;
      }
      pen.strokeStyle = colour;
      // Later curves are thinner, so that an earlier one can be seen beneath.
      pen.lineWidth = 1.6 + 2.4 * (this.group.series.length - 1 - number) / this.group.series.length;
      line(pen, piece.map(({ x, estimate }) => this.plot.at(x, estimate[0])));
      for (const { x, point, estimate } of piece) this.dots.push({ point, at: this.plot.at(x, estimate[0]), colour });
    }
    for (const { x, estimate } of known) {
      if (!estimate || estimate[0] !== null) continue;
      // No way at all, proved: beyond any scale.
      const [px] = this.plot.at(x, this.values[1]);
      pen.strokeStyle = colour;
      pen.lineWidth = 2;
      line(pen, [[px - 5, this.plot.box[1] + 12], [px, this.plot.box[1] + 4], [px + 5, this.plot.box[1] + 12]]);
    }
    return known.some(({ estimate }) => estimate);
  }

  /** Impossible designs. */
  crosses(pen, series, number) {
    const y = this.plot.box[3] - 8 - 9 * number;
    pen.strokeStyle = seriesColour(number);
    pen.lineWidth = 1.6;
    for (const [x, point] of series.points) {
      if (charts.points[point].figures.length) continue;
      const [px] = this.plot.at(x, this.values[0]);
      line(pen, [[px - 3.5, y - 3.5], [px + 3.5, y + 3.5]]);
      line(pen, [[px - 3.5, y + 3.5], [px + 3.5, y - 3.5]]);
      this.dots.push({ point, at: [px, y], colour: seriesColour(number) });
    }
  }

  /** The point whose dot is nearest, within reach of the pointer. */
  under([px, py]) {
    let best = [null, 30];
    for (const { point, at: [x, y] } of this.dots ?? []) {
      const distance = Math.hypot(x - px, y - py);
      if (distance < best[1]) best = [point, distance];
    }
    return best[0];
  }
}

/** One figure over two varied numbers, a cell a point. */
class MapPanel {
  constructor(grid, map, panel) {
    Object.assign(this, { map, panel, canvas: panelCanvas(grid, panel.heading) });
  }

  draw() {
    const { pen, width, height } = fresh(this.canvas, 0.9);
    const [columns, rows] = [this.map.x.length, this.map.y.length];
    const [left, top, right, bottom] = this.box = [62, 8, width - 10, height - 44];
    const figure = this.panel.figures[0];
    const value = (point) => point === null ? null : figureOf(point, figure)?.[0] ?? null;
    const values = this.map.cells.map(value).filter((v) => v !== null);
    // Of nothing but zeros, the largest is no measure.
    const most = Math.max(0, ...values) || 1;
    const [scale, name] = this.panel.unit === "%" ? [0.01, "%"]
      : this.panel.unit ? (([s, p]) => [s, p + this.panel.unit])(prefixOf(most, 3)) : [1, ""];
    const [w, h] = [(right - left) / columns, (bottom - top) / rows];
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    this.map.cells.forEach((point, k) => {
      const [x, y] = [left + (k % columns) * w, bottom - (Math.floor(k / columns) + 1) * h];
      const estimate = point === null ? null : figureOf(point, figure);
      pen.fillStyle = theme.panel;
      if (estimate?.[0] !== null && estimate?.[0] !== undefined) pen.fillStyle = rampColour(estimate[0] / most);
      pen.fillRect(x, y, w + 0.5, h + 0.5);
      if (w < 38 || h < 17) return;
      const text = !estimate ? (point === null || !charts.points[point].figures.length ? "\u00d7" : "\u2013")
        : estimate[0] === null ? "\u221e" : minus(String(Number((estimate[0] / scale).toPrecision(3))));
      pen.fillStyle = !estimate ? theme.soft : estimate[0] / most > 0.6 ? "#000" : "#fff";
      if (estimate?.[0] === null) pen.fillStyle = theme.ink;
      pen.fillText(text, x + w / 2, y + h / 2);
    });
    this.map.cells.forEach((point, k) => {
      if (point === null || point !== hovered) return;
      pen.strokeStyle = theme.here;
      pen.lineWidth = 3;
      pen.strokeRect(left + (k % columns) * w, bottom - (Math.floor(k / columns) + 1) * h, w, h);
    });
    const plot = new Plot(this.box, [0, columns], [0, rows]);
    const ticks = (all, most) => {
      const every = Math.ceil(all.length / most);
      return all.flatMap((v, k) => k % every ? [] : [[k + 0.5, minus(String(Number(v.toPrecision(4))))]]);
    };
    axes(pen, plot, { ticks: ticks(this.map.x, Math.floor((right - left) / 46)), name: this.map.axes[0] },
      { ticks: ticks(this.map.y, Math.floor((bottom - top) / 20)), name: this.map.axes[1] });
    this.canvas.previousElementSibling.textContent = "";
    this.canvas.previousElementSibling.append(make("strong", this.panel.heading), name ? `(${name})` : "");
  }

  under([px, py]) {
    const [left, top, right, bottom] = this.box;
    const column = Math.floor((px - left) / (right - left) * this.map.x.length);
    const row = Math.floor((bottom - py) / (bottom - top) * this.map.y.length);
    const inside = column >= 0 && column < this.map.x.length && row >= 0 && row < this.map.y.length;
    return inside ? this.map.cells[row * this.map.x.length + column] : null;
  }
}

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
      line(pen, [[0, 5], [28, 5]]);
    });
  }
  key.append(make("span", "bands: certified bounds, 95 % for shares; ^ no way, proved; \u00d7 impossible", "note"));
  return key;
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
      panels.forEach(({ panel }) => panel.draw());
    });
  };
  const hover = (point, readout) => {
    if (point === hovered) return;
    if (hovered !== null) rows[hovered].classList.remove("chosen");
    hovered = point;
    if (point !== null) rows[point].classList.add("chosen");
    for (const other of section.querySelectorAll(".readout")) other.textContent = "";
    if (readout) readout.textContent = point === null ? "" : charts.points[point].readout;
    drawAll();
  };
  const add = (title, parts, made) => {
    const grid = make("div", "", "panels");
    const readout = make("p", "", "readout");
    section.append(make("h2", title), ...parts, readout, grid);
    for (const panel of made(grid)) {
      panels.push({ panel });
      const look = (event) => hover(panel.under(pointer(panel.canvas, event)), readout);
      panel.canvas.addEventListener("pointermove", look);
      panel.canvas.addEventListener("pointerdown", look);
      panel.canvas.addEventListener("pointerleave", () => hover(null, readout));
    }
  };
  for (const group of charts.curves) {
    add(group.title, [legend(group.series)],
      (grid) => charts.panels.map((panel) => new CurvePanel(grid, group, panel)));
  }
  for (const map of charts.maps) {
    const plain = charts.panels.filter(({ figures }) => figures.length === 1);
    add(map.title, [], (grid) => plain.map((panel) => new MapPanel(grid, map, panel)));
  }
  rows.forEach((row, point) => {
    row.addEventListener("pointerenter", () => hover(point, null));
    row.addEventListener("pointerleave", () => hover(null, null));
  });
  const anew = () => {
    readTheme();
    panels.forEach(({ panel }) => panel.draw());
  };
  anew();
  addEventListener("resize", anew);
  for (const query of ["print", "(prefers-color-scheme: dark)"]) matchMedia(query).addEventListener("change", anew);
  addEventListener("beforeprint", anew);
  addEventListener("afterprint", anew);
}
