// A sweep: a figure of its points over a number or another figure.

const charts = page.charts;
/** Okabe and Ito's colours, as in the pictures; the last one is the text colour. Further series repeat them in dashes. */
const SERIES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const COUNT = SERIES.length + 1;
const seriesColour = (k) => SERIES[k % COUNT] ?? theme.ink;
const seriesDashes = (k) => [[], [12, 3], [2, 3]][Math.min(2, Math.floor(k / COUNT))];
/** The point under the pointer, the one that was clicked, and the one that all are set against, by
    their places in the sweep. */
let hovered = null, pinned = null, baseline = null;
/** More powers of ten than these are shown by logarithms. */
const MOST_DECADES = 2;

/** A figure of a point with its bounds, as a multiple of the baseline's where there is one; a value of
    null where there is no way at all. */
function figureOf(point, figure) {
  const numbers = charts.points[point].figures[figure] ?? null;
  if (baseline === null || numbers === null) return numbers;
  const base = charts.points[baseline].figures[figure]?.[0] ?? null;
  return base ? numbers.map((v) => v === null ? null : v / base) : null;
}

/** Whether a point has no figure because it has no trap. */
const hasNoTrap = (point, figure) => charts.points[point].without.includes(figure);

/** Ticks at powers of ten, in a unit, for a range of logarithms. */
function decadeTicks([low, high]) {
  const ticks = [];
  for (let k = Math.ceil(low); k <= high; k++) ticks.push(k);
  return ticks;
}

/** Ticks of a figure's axis and its name. */
function figureTicks(range, unit, count) {
  if (baseline !== null) {
    const { ticks, decimals } = roundTicks(...range, count);
    return { ticks: ticks.map((t) => [t, minus(t.toFixed(decimals))]), name: "\u00d7 baseline" };
  }
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

/** A canvas with a heading and its controls, in a grid. */
function panelCanvas(grid, heading, ...more) {
  const box = make("figure");
  const canvas = make("canvas");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", heading);
  const caption = make("figcaption");
  caption.append(make("strong", heading), ...more);
  box.append(caption, canvas);
  grid.append(box);
  return canvas;
}

/** A button that shows the scale of a panel, and changes it. */
function scaleButton(panel) {
  const button = make("button");
  button.type = "button";
  button.title = "linear or logarithmic";
  button.addEventListener("click", () => {
    panel.wanted = panel.isLogarithmic() ? "linear" : "log";
    panel.draw();
  });
  return button;
}

/** Figures of one kind over a number, one curve per series. */
class CurvePanel {
  /** `group`: the name of the axis, and series with a name and points, each a place on the axis and a
      point of the sweep; `panel`: a heading, a unit and figures. */
  constructor(grid, group, panel) {
    this.button = scaleButton(this);
    Object.assign(this, { group, panel, canvas: panelCanvas(grid, panel.heading, this.button) });
  }

  all() {
    return this.group.series.flatMap(({ points }) => points.flatMap(([, point]) =>
      this.panel.figures.flatMap((figure) => (figureOf(point, figure) ?? []).filter((v) => v !== null))));
  }

  positive() { return this.all().filter((v) => v > 0); }

  /** Logarithmic if requested, or if positive numbers span several powers of ten. */
  isLogarithmic() {
    const all = this.all();
    if (!this.positive().length || all.some((v) => v < 0)) return false;
    if (this.wanted) return this.wanted === "log";
    const spread = Math.log10(Math.max(...all) / Math.min(...this.positive()));
    return this.panel.unit !== "%" && spread > MOST_DECADES;
  }

  /** From zero, or below, to slightly above the highest value; the range of the values for logarithms. */
  range() {
    const all = this.all();
    if (this.logarithmic) {
      const powers = this.positive().map(Math.log10);
      return [Math.min(...powers) - 0.2, Math.max(...powers) + 0.2];
    }
    if (this.panel.unit === "%" && baseline === null) return [0, 1];
    const [low, high] = [Math.min(0, ...all), Math.max(0, ...all)];
    if (high - low === 0) return [0, this.panel.unit === "J" && baseline === null ? 2e-3 : 1];
    return [low < 0 ? low - 0.08 * (high - low) : 0, high + 0.08 * (high - low)];
  }

  /** The position of a value on the axis; on a logarithmic one zero is at the bottom. */
  at(x, value) {
    const y = this.logarithmic ? Math.max(this.values[0], Math.log10(value)) : value;
    return this.plot.at(x, y);
  }

  ticks() {
    if (!this.logarithmic) return figureTicks(this.values, this.panel.unit, 5);
    const text = (k) => baseline !== null || !this.panel.unit || this.panel.unit === "%"
      ? String(Number((10 ** k).toPrecision(1))) : si(10 ** k, this.panel.unit, 1);
    const name = baseline !== null ? "\u00d7 baseline" : "";
    return { ticks: decadeTicks(this.values).map((k) => [k, text(k)]), name, room: 56 };
  }

  draw() {
    this.logarithmic = this.isLogarithmic();
    this.values = this.range();
    this.button.textContent = this.logarithmic ? "log" : "linear";
    const { pen, width, height } = fresh(this.canvas, 0.68);
    const xs = this.group.series.flatMap(({ points }) => points.map(([x]) => x));
    const [first, last] = [Math.min(...xs), Math.max(...xs)];
    const room = 0.03 * (last - first || 1);
    const plot = this.plot = new Plot([68, 8, width - 10, height - 44], [first - room, last + room], this.values);
    const x = roundTicks(first - room, last + room, 5);
    axes(pen, plot, { ticks: x.ticks.map((t) => [t, minus(t.toFixed(x.decimals))]), name: this.group.axis }, this.ticks());
    this.dots = [];
    let any = false;
    pen.save();
    plot.clip(pen);
    this.group.series.forEach((series, number) => {
      for (const figure of this.panel.figures) any = this.curve(pen, series, number, figure) || any;
      any = this.signs(pen, series, number) || any;
    });
    pen.restore();
    if (!any) {
      pen.fillStyle = theme.soft;
      pen.textAlign = "center";
      pen.fillText("none", (plot.box[0] + plot.box[2]) / 2, (plot.box[1] + plot.box[3]) / 2);
    }
    for (const { point, at, colour, sign } of this.dots) {
      const here = point === hovered || point === pinned;
      if (sign && !here) continue;
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
        for (const { x, estimate } of piece) pen.lineTo(...this.at(x, estimate[1]));
        for (const { x, estimate } of [...piece].reverse()) pen.lineTo(...this.at(x, estimate[2]));
        pen.closePath();
        pen.globalAlpha = 0.25;
        pen.fillStyle = colour;
        pen.fill();
        pen.globalAlpha = 1;
      }
      pen.strokeStyle = colour;
      // Later curves are thinner, so that earlier ones remain visible below them.
      pen.lineWidth = 1.6 + 2.4 * (this.group.series.length - 1 - number) / this.group.series.length;
      pen.setLineDash(seriesDashes(number));
      line(pen, piece.map(({ x, estimate }) => this.at(x, estimate[0])));
      pen.setLineDash([]);
      for (const { x, point, estimate } of piece) this.dots.push({ point, at: this.at(x, estimate[0]), colour });
    }
    for (const { x, point, estimate } of known) {
      if (!estimate || estimate[0] !== null) continue;
      // Proved to have no path: beyond any scale.
      const [px] = this.plot.at(x, this.values[1]);
      const top = this.plot.box[1];
      pen.strokeStyle = colour;
      pen.lineWidth = 2;
      line(pen, [[px - 5, top + 12], [px, top + 4], [px + 5, top + 12]]);
      this.dots.push({ point, at: [px, top + 8], colour, sign: true });
    }
    return known.some(({ estimate }) => estimate);
  }

  /** Crosses for impossible designs, rings for those without a trap; whether there was one of these. */
  signs(pen, series, number) {
    const colour = pen.strokeStyle = seriesColour(number);
    const [, top, , bottom] = this.plot.box;
    let rings = false;
    pen.lineWidth = 1.6;
    for (const [x, point] of series.points) {
      const [px] = this.plot.at(x, this.values[0]);
      const impossible = !charts.points[point].figures.length;
      const ring = !impossible && hasNoTrap(point, this.panel.figures[0]);
      if (!impossible && !ring) continue;
      // Without a trap a ratio is beyond any scale.
      const y = ring && !this.panel.unit ? top + 8 + 9 * number : bottom - 8 - 9 * number;
      if (impossible) {
        line(pen, [[px - 3.5, y - 3.5], [px + 3.5, y + 3.5]]);
        line(pen, [[px - 3.5, y + 3.5], [px + 3.5, y - 3.5]]);
      } else {
        rings = true;
        pen.beginPath();
        pen.arc(px, y, 4.2, 0, 2 * Math.PI);
        pen.stroke();
      }
      this.dots.push({ point, at: [px, y], colour, sign: true });
    }
    return rings;
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
