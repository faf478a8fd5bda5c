// A sweep over two varied numbers.

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
    const [scale, name] = baseline !== null ? [1, "\u00d7 baseline"] : this.panel.unit === "%" ? [0.01, "%"]
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
      const sign = () => point === null || !charts.points[point].figures.length ? "\u00d7"
        : hasNoTrap(point, figure) ? "\u25cb" : "\u2013";
      const text = !estimate ? sign()
        : estimate[0] === null ? "\u221e" : minus(String(Number((estimate[0] / scale).toPrecision(3))));
      pen.fillStyle = !estimate ? theme.soft : estimate[0] / most > 0.6 ? "#000" : "#fff";
      if (estimate?.[0] === null) pen.fillStyle = theme.ink;
      pen.fillText(text, x + w / 2, y + h / 2);
    });
    this.map.cells.forEach((point, k) => {
      if (point === null || (point !== hovered && point !== pinned)) return;
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
