// The two maps.

const COLOURS = 512;
let palette;

/** A plane of a volume as an image, blocked points clear. */
function mapImage(volume, plane, width, height) {
  palette ??= Array.from({ length: COLOURS }, (_, k) => colourOf(k / (COLOURS - 1) * 2 - 1));
  const image = new ImageData(width, height);
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      const position = positionAt(volume, plane, (column + 0.5) / width, 1 - (row + 0.5) / height);
      if (position !== position) continue;
      const [r, g, b] = palette[Math.round((position + 1) / 2 * (COLOURS - 1))];
      const at = 4 * (row * width + column);
      image.data[at] = r; image.data[at + 1] = g; image.data[at + 2] = b; image.data[at + 3] = 255;
    }
  }
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}

/** A map: a plane of a volume, chosen by a slider, with the states and the path on it. */
class MapView {
  constructor(id, volume, { xName, yName, xUnit, yUnit, shape }) {
    Object.assign(this, { canvas: element(id), volume, xName, yName, xUnit, yUnit, shape });
    this.readout = element(`${id}-readout`);
    /** The states on the map and where they are drawn. */
    this.spots = [];
    this.ranges = [2, 1].map((k) => [volume.axes[k][0], volume.axes[k].at(-1)]);
    this.plane = 0;
  }

  /** A place on the map as fractions of its width and height. */
  fractions(values) {
    return values.map((value, k) => (value - this.ranges[k][0]) / (this.ranges[k][1] - this.ranges[k][0]));
  }

  /** The state under the pointer. */
  stateAt(event) {
    const [px, py] = pointer(this.canvas, event);
    const apart = ({ at: [x, y] }) => Math.hypot(x - px, y - py);
    // The last is on top.
    const near = [...this.spots].reverse().filter((spot) => apart(spot) < 10);
    return near.sort((a, b) => apart(a) - apart(b))[0]?.state ?? null;
  }

  /** Marks a state, paler if it lies outside the plane. */
  mark(pen, state, at, here) {
    pen.globalAlpha = here ? 1 : 0.4;
    marker(pen, state.kind, at, here ? 5.5 : 3.5);
    if (state.class === classOf(now.chosen)) {
      pen.globalAlpha = 1;
      pen.strokeStyle = theme.here;
      pen.lineWidth = 2;
      pen.beginPath();
      pen.arc(...at, 9, 0, 2 * Math.PI);
      pen.stroke();
    }
    this.spots.push({ state, at });
  }

  /** Value of the slider's coordinate. */
  get level() { return this.volume.axes[0][this.plane]; }

  ground() {
    const { pen, width } = fresh(this.canvas, this.shape);
    const box = [62, 8, width - 10, 0];
    box[3] = box[1] + (this.shape * width - 8 - 44);
    const [x, y] = this.ranges;
    const plot = this.plot = new Plot(box, x, y);
    const size = [Math.round(box[2] - box[0]), Math.round(box[3] - box[1])];
    const key = [this.plane, ...size].join();
    if (this.key !== key) {
      this.key = key;
      this.image = mapImage(this.volume, this.plane, ...size);
    }
    this.blocked = this.blockedRegion?.(plot) ?? null;
    pen.save();
    plot.clip(pen);
    hatch(pen, plot);
    pen.drawImage(this.image, box[0], box[1], box[2] - box[0], box[3] - box[1]);
    if (this.blocked) {
      pen.clip(this.blocked);
      hatch(pen, plot);
    }
    pen.restore();
    const xAxis = quantityTicks(x, this.xUnit, width > 420 ? 7 : 5);
    const yAxis = quantityTicks(y, this.yUnit, 7);
    axes(pen, plot, { ticks: xAxis.ticks, name: `${this.xName} (${xAxis.unit})` },
      { ticks: yAxis.ticks, name: `${this.yName} (${yAxis.unit})` });
    return { pen, plot };
  }
}

/** The map around the fixed tile, at an orientation. */
class AroundView extends MapView {
  constructor(volume) {
    const [x, y] = [2, 1].map((k) => volume.axes[k].at(-1) - volume.axes[k][0]);
    super("around", volume, { xName: "x", yName: "y", xUnit: "m", yUnit: "m", shape: Math.min(1.1, 0.92 * y / x + 0.06) });
    const thetas = volume.axes[0];
    this.step = thetas.length > 1 ? thetas[1] - thetas[0] : 2 * Math.PI;
    this.period = this.step * thetas.length;
    // Copies at one place, once; the deepest last, on top.
    const places = new Map(world.states.map((state) =>
      [[...state.pose.slice(0, 2), this.within(state.pose[2])].map((v) => v.toFixed(5)).join(), state]));
    this.states = [...places.values()].sort((a, b) => b.energy - a.energy);
    this.follow(0);
  }
  /** An angle as one of this map's, which repeats. */
  within(theta) { return theta - this.period * Math.round(theta / this.period); }
  follow(theta) {
    const count = this.volume.axes[0].length;
    const k = Math.round((this.within(theta) - this.volume.axes[0][0]) / this.step);
    this.plane = ((k % count) + count) % count;
  }
  label() {
    const repeats = this.period < 6.28 ? ` (repeats every ${degrees(this.period, 0)})` : "";
    return `${degrees(this.level)}${repeats}`;
  }
  /** Where the tiles overlap: the Minkowski sum of the fixed outline and the turned moving one's
      reflection, the union of the sums of their edges and of one outline at a corner of the other. */
  blockedRegion(plot) {
    const a = world.fixed.outline;
    const b = world.moving.outline.map((vertex) => turned(vertex, this.level + Math.PI));
    const path = new Path2D();
    const add = (points) => {
      points.forEach(([x, y], k) => k ? path.lineTo(...plot.at(x, y)) : path.moveTo(...plot.at(x, y)));
      path.closePath();
    };
    const plus = (p, q) => [p[0] + q[0], p[1] + q[1]];
    add(a.map((p) => plus(p, b[0])));
    add(b.map((p) => plus(p, a[0])));
    if (a.length * b.length > 40000) return null;
    a.forEach((p, i) => b.forEach((q, j) => {
      const [r, s] = [a[(i + 1) % a.length], b[(j + 1) % b.length]];
      const corners = [plus(p, q), plus(r, q), plus(r, s), plus(p, s)];
      const area = (r[0] - p[0]) * (s[1] - q[1]) - (r[1] - p[1]) * (s[0] - q[0]);
      // All in the same orientation, so that they add up.
      add(area < 0 ? corners.reverse() : corners);
    }));
    return path;
  }
  draw() {
    const { pen, plot } = this.ground();
    const at = ([x, y]) => plot.at(x, y);
    pen.save();
    plot.clip(pen);
    drawTile(pen, world.fixed, [0, 0, 0], at, theme.fixed);
    if (now.route) seamed(pen, now.route.points.map((p) => plot.at(p[1], p[2])), "#222", 1.8);
    this.spots = [];
    for (const here of [false, true]) {
      for (const state of this.states) {
        const inPlane = Math.abs(this.within(state.pose[2] - this.level)) <= this.step / 2 + 1e-9;
        if (inPlane === here) this.mark(pen, state, plot.at(...state.pose), here);
      }
    }
    pen.globalAlpha = 1;
    if (now.place) marker(pen, "here", plot.at(...now.place.pose), 6);
    if (now.probe) ghost(pen, now.probe, at);
    pen.restore();
  }
  /** Pose and energy under the pointer. */
  probe(event) {
    const values = this.plot?.values(pointer(this.canvas, event));
    if (!values) return null;
    const [x, y] = values;
    const pose = [x, y, this.level];
    const position = positionAt(this.volume, this.plane, ...this.fractions(values));
    if (this.isBlocked(event, position)) return { text: `${poseText(pose)}: the tiles would overlap` };
    return { pose, text: `${poseText(pose)}: ${energyAt(pose, position)}` };
  }
  isBlocked(event, position) {
    if (!this.blocked) return position !== position;
    // With a pen without a scale.
    const pen = new OffscreenCanvas(1, 1).getContext("2d");
    return pen.isPointInPath(this.blocked, ...pointer(this.canvas, event));
  }
}

/** The map in front of the target face, at a gap. */
class InFrontView extends MapView {
  constructor(volume) {
    super("in-front", volume, { xName: "slide", yName: "tilt", xUnit: "m", yUnit: "rad", shape: 0.96 });
  }
  /** The distance along the normal at which the tiles first touch; null if they do not. */
  landing(tilt, slide) {
    const [, tilts, slides] = this.volume.axes;
    const index = (axis, value) => (value - axis[0]) / (axis.at(-1) - axis[0]) * (axis.length - 1);
    const [y, x] = [index(tilts, tilt), index(slides, slide)];
    if (!(x >= -1e-9 && y >= -1e-9 && x <= slides.length - 1 + 1e-9 && y <= tilts.length - 1 + 1e-9)) return null;
    const i = Math.max(0, Math.min(Math.floor(x + 1e-9), slides.length - 2));
    const j = Math.max(0, Math.min(Math.floor(y + 1e-9), tilts.length - 2));
    let sum = 0, weight = 0;
    for (const [di, dj] of [[0, 0], [1, 0], [0, 1], [1, 1]]) {
      const value = world.landing[(j + dj) * slides.length + i + di];
      const share = (di ? x - i : 1 - x + i) * (dj ? y - j : 1 - y + j);
      if (value !== null && share > 0) { sum += share * value; weight += share; }
    }
    return weight > 0 ? sum / weight : null;
  }
  /** Tilt, slide and gap of a pose, null if it is not in front of the target face. */
  coordinates(pose) {
    const { tilt, slide, distance } = inFrontOf(pose);
    const landing = this.landing(tilt, slide);
    return landing === null ? null : { tilt, slide, gap: Math.max(0, distance - landing) };
  }
  follow(gap) {
    const gaps = this.volume.axes[0];
    this.plane = gaps.reduce((best, g, k) => Math.abs(g - gap) < Math.abs(gaps[best] - gap) ? k : best, 0);
  }
  label() { return si(this.level, "m", 3); }
  draw() {
    const { pen, plot } = this.ground();
    pen.save();
    plot.clip(pen);
    let piece = [];
    const flush = () => {
      if (piece.length > 1) seamed(pen, piece, "#222", 1.8);
      piece = [];
    };
    for (const point of now.route?.points ?? []) {
      const { tilt, slide, distance } = inFrontOf(point.slice(1, 4));
      if (distance < -0.5 * (plot.x[1] - plot.x[0])) { flush(); continue; }
      piece.push(plot.at(slide, tilt));
    }
    flush();
    this.spots = [];
    for (const state of world.states) {
      const c = this.coordinates(state.pose);
      if (!c || inFrontOf(state.pose).distance < this.landing(c.tilt, c.slide) - 1e-3) continue;
      this.mark(pen, state, plot.at(c.slide, c.tilt), Math.abs(c.gap - this.level) < 1e-3);
    }
    pen.globalAlpha = 1;
    const here = now.place && this.coordinates(now.place.pose);
    if (here) marker(pen, "here", plot.at(here.slide, here.tilt), 6);
    pen.restore();
  }
  probe(event) {
    const values = this.plot?.values(pointer(this.canvas, event));
    if (!values) return null;
    const [slide, tilt] = values;
    const text = `slide ${si(slide, "m", 3)}, tilt ${degrees(tilt)}`;
    const landing = this.landing(tilt, slide);
    const position = positionAt(this.volume, this.plane, ...this.fractions(values));
    if (landing === null || position !== position) return { text: `${text}: the tile misses the target face` };
    const pose = poseInFront(tilt, slide, landing + this.level);
    return { pose, text: `${text}: ${energyText(energyOf(position), 3)} (between grid points)` };
  }
}

/** An energy as text: computed for point dipoles, otherwise from the map. */
function energyAt(pose, position) {
  if (world.dipoles) return energyText(dipoleEnergy(pose));
  return position === position ? `about ${energyText(energyOf(position), 2)}` : "not on the map's grid";
}
