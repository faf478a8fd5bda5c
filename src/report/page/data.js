// The data of the page, energies as positions and colours, quantities as text.

const page = JSON.parse(document.getElementById("data").textContent);
const world = page.landscape;
const element = (id) => document.getElementById(id);

// Numbers as text

const minus = (text) => text.replace("-", "\u2212");

/** The power of ten of a number rounded to this many significant digits. */
const powerOf = (value, digits) => Number(value.toExponential(digits - 1).split("e")[1]);

/** The factor of the SI prefix with which a size, rounded to this many digits, is below 1000, and the prefix. */
function prefixOf(size, digits = 16) {
  const prefixes = [[1e-12, "p"], [1e-9, "n"], [1e-6, "µ"], [1e-3, "m"], [1, ""], [1e3, "k"]];
  return prefixes.find(([scale]) => powerOf(size / scale, Math.max(3, digits)) < 3) ?? prefixes[5];
}

/** The decimals that give a rounded number this many significant digits. */
const decimalsOf = (value, digits) => Math.max(0, digits - 1 - powerOf(value, digits));

function si(value, unit, digits = 4) {
  if (value === null) return "none";
  if (value === 0) return `0 ${unit}`;
  const [scale, prefix] = prefixOf(Math.abs(value), digits);
  const scaled = value / scale;
  return minus(`${scaled.toFixed(decimalsOf(scaled, digits))} ${prefix}${unit}`);
}

const degrees = (angle, decimals = 1) => minus(`${(angle * 180 / Math.PI).toFixed(decimals)}°`).replace(/^\u2212(?=[0.]*°$)/, "");

function wrap(angle) {
  const turned = angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
  return turned <= -Math.PI ? turned + 2 * Math.PI : turned;
}

function poseText([x, y, theta]) {
  return `x ${si(x, "m")}, y ${si(y, "m")}, θ ${degrees(theta)}`;
}

// A symmetric scale of energies, linear about zero and logarithmic beyond.

const linear = world ? world.most / 10 ** world.decades : 1;
const full = world ? Math.asinh(world.most / linear) : 1;
const positionOf = (energy) => Math.max(-1, Math.min(1, Math.asinh(energy / linear) / full));
const energyOf = (position) => linear * Math.sinh(position * full);

/** An energy as text, 0 if it is negligible on the scale. */
const energyText = (energy, digits = 4) =>
  Math.abs(energy) < 1e-3 * linear ? "0 J" : si(energy, "J", digits);

/** Zero and the powers of ten beyond the linear part, between two positions. */
function energyTicks(low, high) {
  const top = Math.floor(Math.log10(world.most));
  const ticks = [0];
  for (let k = top - world.decades + 1; k <= top; k++) ticks.push(10 ** k, -(10 ** k));
  return ticks.filter((u) => positionOf(u) >= low - 1e-9 && positionOf(u) <= high + 1e-9).sort((a, b) => a - b);
}

function colourOf(position) {
  const at = (Math.max(-1, Math.min(1, position)) + 1) / 2 * (world.palette.length - 1);
  const below = Math.min(Math.floor(at), world.palette.length - 2);
  const [a, b] = [world.palette[below], world.palette[below + 1]];
  return a.map((value, c) => Math.round(value + (b[c] - value) * (at - below)));
}

// Volumes

/** The positions of a volume's energies, NaN where blocked. */
async function unpacked(volume) {
  const text = atob(volume.data);
  const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const plain = new Uint8Array(await new Response(stream).arrayBuffer());
  const [planes, rows, columns] = volume.axes.map((axis) => axis.length);
  const count = planes * rows * columns;
  const steps = new Uint16Array(count);
  for (let i = 0; i < count; i++) {
    const column = i % columns, row = Math.floor(i / columns) % rows;
    const left = column > 0 ? steps[i - 1] : 0;
    const below = row > 0 ? steps[i - columns] : 0;
    const corner = column > 0 && row > 0 ? steps[i - columns - 1] : 0;
    steps[i] = left + below - corner + plain[i] + 256 * plain[count + i];
  }
  const positions = Float32Array.from(steps, (s) => s === 0 ? NaN : (s - 1) / volume.steps * 2 - 1);
  return { axes: volume.axes, rows, columns, positions };
}

/** Position at fractions of the width and the height of a plane, linear between free grid points;
    NaN where none of them is free. */
function positionAt(volume, plane, u, v) {
  const { rows, columns, positions } = volume;
  const x = Math.max(0, Math.min(1, u)) * (columns - 1), y = Math.max(0, Math.min(1, v)) * (rows - 1);
  const i = Math.min(Math.floor(x), columns - 2), j = Math.min(Math.floor(y), rows - 2);
  const s = x - i, t = y - j;
  const first = (plane * rows + j) * columns + i;
  let sum = 0, weight = 0;
  const add = (index, share) => {
    const position = positions[index];
    if (position === position) { sum += share * position; weight += share; }
  };
  add(first, (1 - s) * (1 - t));
  add(first + 1, s * (1 - t));
  add(first + columns, (1 - s) * t);
  add(first + columns + 1, s * t);
  return weight > 0 ? sum / weight : NaN;
}

const stateOf = (id) => world.states.find((state) => state.id === id);
/** Kinds of states: symmetric copies have one class. */
const classOf = (id) => stateOf(id)?.class ?? null;

// Poses

const turned = ([x, y], angle) => {
  const c = Math.cos(angle), s = Math.sin(angle);
  return [c * x - s * y, s * x + c * y];
};
const placed = (p, [x, y, theta]) => {
  const [a, b] = turned(p, theta);
  return [a + x, b + y];
};
const dot = (a, b) => a[0] * b[0] + a[1] * b[1];

/** Tilt, slide and distance along the normal of a pose in front of the target face. */
function inFrontOf(pose) {
  const { bound, pivot, tangent, normal } = world.target;
  const a = placed(pivot, pose), b = placed(pivot, bound);
  const moved = [a[0] - b[0], a[1] - b[1]];
  return { tilt: wrap(pose[2] - bound[2]), slide: dot(moved, tangent), distance: dot(moved, normal) };
}

/** The pose of a tilt, a slide and a distance along the normal. */
function poseInFront(tilt, slide, distance) {
  const { bound, pivot, tangent, normal } = world.target;
  const at = placed(pivot, bound);
  const theta = wrap(bound[2] + tilt);
  const arm = turned(pivot, theta);
  return [0, 1].map((k) => at[k] + slide * tangent[k] + distance * normal[k] - arm[k]).concat(theta);
}

/** mu0 / (4 pi) (T m / A). */
const MU0_OVER_4PI = 1e-7;

/** U of the magnets as point dipoles: mu0 / (4 pi r^3) (m1 m2 - 3 (m1 e) (m2 e)) over all pairs. */
function dipoleEnergy(pose) {
  let energy = 0;
  for (const b of world.moving.magnets) {
    const at = placed(b.position, pose);
    const m2 = [Math.cos(b.angle + pose[2]) * b.moment, Math.sin(b.angle + pose[2]) * b.moment];
    for (const a of world.fixed.magnets) {
      const m1 = [Math.cos(a.angle) * a.moment, Math.sin(a.angle) * a.moment];
      const r = [at[0] - a.position[0], at[1] - a.position[1]];
      const r2 = dot(r, r);
      energy += MU0_OVER_4PI / (r2 * Math.sqrt(r2)) * (dot(m1, m2) - 3 * dot(m1, r) * dot(m2, r) / r2);
    }
  }
  return energy;
}
