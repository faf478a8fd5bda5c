// Drawing: canvases of the right size, axes, tiles, markers.

let theme = {};

/** Draws the page, now and whenever its width, its colours or its medium change. */
function followPage(draw) {
  const anew = () => {
    readTheme();
    draw();
  };
  anew();
  for (const event of ["resize", "beforeprint", "afterprint"]) addEventListener(event, anew);
  for (const query of ["print", "(prefers-color-scheme: dark)"]) matchMedia(query).addEventListener("change", anew);
}

/** Scrolls until something is in view, where it is not. */
function bring(id) {
  const shown = element(id);
  (shown.closest("figure") ?? shown).scrollIntoView({ block: "nearest" });
}

function readTheme() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["page", "ink", "soft", "line", "panel", "accent", "fixed", "moving", "edge", "hatch",
    "hatch-line", "north", "south", "certified", "here",
    "ring", "chain", "sheet", "target"]) {
    theme[name] = style.getPropertyValue(`--${name}`).trim();
  }
}

/** Clears a canvas and fits it to its width on the page, if that is not below `least`; `shape` is
    height over width. */
function fresh(canvas, shape, least = 160) {
  const width = Math.max(least, canvas.clientWidth);
  const height = Math.round(width * shape);
  const ratio = Math.max(1, window.devicePixelRatio || 1);
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  canvas.style.height = `${height}px`;
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.font = '13px "Noto Sans", "Helvetica Neue", Arial, sans-serif';
  pen.lineJoin = "round";
  return { pen, width, height };
}

/** A plot: a rectangle of the canvas and the values at its ends. */
class Plot {
  constructor(box, x, y) {
    Object.assign(this, { box, x, y });
  }
  at(x, y) {
    const [left, top, right, bottom] = this.box;
    return [
      left + (right - left) * (x - this.x[0]) / (this.x[1] - this.x[0]),
      bottom - (bottom - top) * (y - this.y[0]) / (this.y[1] - this.y[0]),
    ];
  }
  /** The values at a point of the canvas; null outside. */
  values([px, py]) {
    const [left, top, right, bottom] = this.box;
    if (px < left || px > right || py < top || py > bottom) return null;
    return [
      this.x[0] + (this.x[1] - this.x[0]) * (px - left) / (right - left),
      this.y[0] + (this.y[1] - this.y[0]) * (bottom - py) / (bottom - top),
    ];
  }
  clip(pen) {
    const [left, top, right, bottom] = this.box;
    pen.beginPath();
    pen.rect(left, top, right - left, bottom - top);
    pen.clip();
  }
}

/** Round numbers from low to high, about `count` of them. */
function roundTicks(low, high, count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((m) => m * power >= rough * 0.999);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) ticks.push(k * step);
  return { ticks, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

/** Ticks of lengths or angles with a shared unit: values, texts, and the unit's name. */
function quantityTicks([low, high], unit, count) {
  const [scale, name] = unit === "rad"
    ? [Math.PI / 180, "°"]
    : (([s, p]) => [s, p + unit])(prefixOf(0.999 * Math.max(Math.abs(low), Math.abs(high))));
  const { ticks, decimals } = roundTicks(low / scale, high / scale, count);
  return { ticks: ticks.map((t) => [t * scale, minus(t.toFixed(decimals))]), unit: name };
}

/** Frame, ticks and names of a plot. */
function axes(pen, plot, xAxis, yAxis) {
  const [left, top, right, bottom] = plot.box;
  pen.strokeStyle = theme.ink;
  pen.fillStyle = theme.ink;
  pen.lineWidth = 1;
  pen.strokeRect(left, top, right - left, bottom - top);
  pen.textBaseline = "top";
  pen.textAlign = "center";
  for (const [value, text] of xAxis.ticks) {
    const [x] = plot.at(value, plot.y[0]);
    line(pen, [[x, bottom], [x, bottom + 4]]);
    pen.fillText(text, x, bottom + 6);
  }
  pen.fillText(xAxis.name, (left + right) / 2, bottom + 22);
  pen.textBaseline = "middle";
  pen.textAlign = "right";
  for (const [value, text] of yAxis.ticks) {
    const [, y] = plot.at(plot.x[0], value);
    line(pen, [[left, y], [left - 4, y]]);
    pen.fillText(text, left - 7, y);
  }
  pen.save();
  pen.translate(left - (yAxis.room ?? 48), (top + bottom) / 2);
  pen.rotate(-Math.PI / 2);
  pen.textAlign = "center";
  pen.fillText(yAxis.name, 0, 0);
  pen.restore();
}

function line(pen, points, closed = false) {
  pen.beginPath();
  points.forEach(([x, y], k) => k ? pen.lineTo(x, y) : pen.moveTo(x, y));
  if (closed) pen.closePath();
  pen.stroke();
}

/** A line with an outline that contrasts with any background. */
function seamed(pen, points, colour, width) {
  pen.strokeStyle = "#fff";
  pen.lineWidth = width + 2.4;
  line(pen, points);
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  line(pen, points);
}

/** A star for the bond, a disc for a trap, a ring for free tiles, a diamond for the current place. */
function marker(pen, kind, [x, y], radius) {
  pen.beginPath();
  if (kind === "bound") {
    for (let k = 0; k < 10; k++) {
      const r = radius * (k % 2 ? 0.5 : 1.35), a = k * Math.PI / 5;
      pen.lineTo(x + r * Math.sin(a), y - r * Math.cos(a));
    }
    pen.fillStyle = "#f0e442";
  } else if (kind === "here") {
    for (const [dx, dy] of [[0, -1.4], [1.4, 0], [0, 1.4], [-1.4, 0]]) pen.lineTo(x + dx * radius, y + dy * radius);
    pen.fillStyle = theme.here;
  } else {
    pen.arc(x, y, radius, 0, 2 * Math.PI);
    pen.fillStyle = kind === "free" ? theme.page : "#cc79a7";
  }
  pen.closePath();
  pen.fill();
  pen.strokeStyle = kind === "here" ? "#fff" : "#222";
  pen.lineWidth = kind === "here" ? 2 : 1.2;
  pen.stroke();
}

/** A tile at a pose; `at` takes a point of the fixed tile's frame to the canvas. */
function drawTile(pen, tile, pose, at, fill) {
  pen.beginPath();
  for (const vertex of tile.outline) pen.lineTo(...at(placed(vertex, pose)));
  pen.closePath();
  pen.fillStyle = fill;
  pen.fill();
  for (const magnet of tile.magnets) {
    const block = (from, to) => {
      const across = magnet.size[1] / 2;
      const corners = [[from, -across], [to, -across], [to, across], [from, across]];
      pen.beginPath();
      for (const corner of corners) {
        const inTile = turned(corner, magnet.angle);
        pen.lineTo(...at(placed([inTile[0] + magnet.position[0], inTile[1] + magnet.position[1]], pose)));
      }
      pen.closePath();
      pen.fill();
    };
    const half = magnet.size[0] / 2;
    if (magnet.stands) {
      // The upper pole, with its letter.
      pen.fillStyle = magnet.stands.up === "N" ? theme.north : theme.south;
      const [x, y] = at(placed(magnet.position, pose));
      const [ex, ey] = at(placed([magnet.position[0] + half, magnet.position[1]], pose));
      const radius = Math.hypot(ex - x, ey - y);
      if (magnet.stands.round) {
        pen.beginPath();
        pen.arc(x, y, radius, 0, 2 * Math.PI);
        pen.fill();
      } else {
        block(-half, half);
      }
      if (radius > 6) {
        pen.save();
        pen.fillStyle = "#fff";
        pen.font = `bold ${Math.min(14, 1.2 * radius)}px sans-serif`;
        pen.textAlign = "center";
        pen.textBaseline = "middle";
        pen.fillText(magnet.stands.up === "N" ? "U" : "D", x, y);
        pen.restore();
      }
      continue;
    }
    pen.fillStyle = theme.south;
    block(-half, 0);
    pen.fillStyle = theme.north;
    block(0, half);
  }
  pen.strokeStyle = theme.edge;
  pen.lineWidth = 1.3;
  line(pen, tile.outline.map((vertex) => at(placed(vertex, pose))), true);
}

/** The scale and place at which a rectangle of the plane fits a canvas. */
function fitting([x0, y0, x1, y1], width, height, margin) {
  const scale = Math.min((width - 2 * margin) / (x1 - x0), (height - 2 * margin) / (y1 - y0));
  const [cx, cy] = [(x0 + x1) / 2, (y0 + y1) / 2];
  return { scale, at: ([x, y]) => [width / 2 + (x - cx) * scale, height / 2 - (y - cy) * scale] };
}

/** The rectangle that holds the fixed tile and the moving one at each of some poses. */
function extent(poses) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  const hold = ([x, y]) => {
    box[0] = Math.min(box[0], x); box[1] = Math.min(box[1], y);
    box[2] = Math.max(box[2], x); box[3] = Math.max(box[3], y);
  };
  world.fixed.outline.forEach(hold);
  for (const pose of poses) for (const vertex of world.moving.outline) hold(placed(vertex, pose));
  return box;
}

/** The position of a pointer on a canvas. */
function pointer(canvas, event) {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

/** The outline of the moving tile at the pointer. */
function ghost(pen, pose, at) {
  pen.save();
  pen.setLineDash([5, 4]);
  pen.strokeStyle = theme.here;
  pen.lineWidth = 1.6;
  line(pen, world.moving.outline.map((vertex) => at(placed(vertex, pose))), true);
  pen.restore();
}

/** Fills a plot with the hatching of blocked regions. */
function hatch(pen, plot) {
  const [left, top, right, bottom] = plot.box;
  pen.fillStyle = theme.hatch;
  pen.fillRect(left, top, right - left, bottom - top);
  pen.strokeStyle = theme["hatch-line"];
  pen.lineWidth = 1.5;
  const height = bottom - top;
  for (let x = left - height; x < right; x += 9) line(pen, [[x, bottom], [x + height, top]]);
}

/** The colours with their energies. */
function drawColourBar() {
  const { pen, width } = fresh(element("colour-bar"), 44 / Math.max(160, element("colour-bar").clientWidth));
  const left = 30, right = width - 30;
  for (let x = left; x < right; x++) {
    pen.fillStyle = `rgb(${colourOf((x - left) / (right - left) * 2 - 1).join()})`;
    pen.fillRect(x, 2, 1.5, 16);
  }
  pen.strokeStyle = pen.fillStyle = theme.ink;
  pen.strokeRect(left, 2, right - left, 16);
  pen.textAlign = "center";
  pen.textBaseline = "top";
  const taken = [];
  // Zero first, then outwards: numbers that would collide with earlier ones are omitted.
  for (const energy of energyTicks(-1, 1).sort((a, b) => Math.abs(a) - Math.abs(b))) {
    const x = left + (right - left) * (positionOf(energy) + 1) / 2;
    line(pen, [[x, 18], [x, 23]]);
    const text = energy ? si(energy, "J", 1) : "0";
    const half = pen.measureText(text).width / 2 + 5;
    if (x + half > width + 5 || x - half < -5 || taken.some(([from, to]) => x - half < to && from < x + half)) continue;
    taken.push([x - half, x + half]);
    pen.fillText(text, x, 26);
  }
  element("colour-bar").dataset.labels = JSON.stringify(taken.sort((a, b) => a[0] - b[0]));
  element("colour-scale").textContent = `energy U, logarithmic beyond \u00b1${si(linear, "J", 2)}`;
}
