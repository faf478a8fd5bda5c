// Both tiles, on a path or in a state.

const ORIGIN = [0, 0, 0];

/** Draws both tiles with the moving one at `pose`; `box` is the rectangle (m) to be seen. */
function drawTiles(canvas, pose, box, shape, probe = null) {
  const { pen, width, height } = fresh(canvas, shape);
  const { scale, at } = fitting(box, width, height, 12);
  drawTile(pen, world.fixed, ORIGIN, at, theme.fixed);
  if (pose) drawTile(pen, world.moving, pose, at, theme.moving);
  if (probe) ghost(pen, probe, at);
  scaleBar(pen, scale, width, height);
}

function scaleBar(pen, scale, width, height) {
  const wanted = 0.2 * width / scale;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const length = power * [5, 2, 1].find((m) => m * power <= wanted);
  const right = width - 8, y = height - 8;
  pen.strokeStyle = pen.fillStyle = theme.ink;
  pen.lineWidth = 2;
  line(pen, [[right - length * scale, y], [right, y]]);
  pen.textAlign = "right";
  pen.textBaseline = "bottom";
  pen.fillText(si(length, "m", 1), right, y - 4);
}

/** The visible rectangle of a path: where the tiles are near each other. */
function pathExtent({ points, timed }) {
  const far = (timed ? 0.8 : 0.25) * Math.max(...world.moving.outline.map(([x, y]) => Math.hypot(x, y)));
  const near = points.filter((p) => p[5] <= far);
  return extent((near.length ? near : points).map((p) => p.slice(1, 4)));
}

function drawPathTiles() {
  const canvas = element("tiles");
  const place = now.place;
  drawTiles(canvas, place?.pose ?? null, now.route?.extent ?? extent([]), 0.62, now.probe);
  element("tiles-readout").textContent = place
    ? `${poseText(place.pose)}; ${place.clearance < 1e-5 ? "touching" : `${si(place.clearance, "m", 3)} apart`}`
    : "";
}

/** Height over width in which all states have room. */
let poseShape = null;

function drawPose() {
  const state = world.states.find((s) => s.id === now.chosen);
  const canvas = element("pose");
  poseShape ??= Math.min(0.9, 0.1 + Math.max(0.4, ...world.states.map(({ pose }) => {
    const [left, bottom, right, top] = extent([pose]);
    return (top - bottom) / (right - left);
  })));
  if (!state) {
    drawTiles(canvas, null, extent([]), poseShape);
    element("pose-readout").textContent = "The tiles are apart: U = 0.";
    return;
  }
  drawTiles(canvas, state.pose, extent([state.pose]), poseShape);
  element("pose-readout").textContent =
    `${state.name}: U = ${energyText(state.energy)}; ${poseText(state.pose)}`;
}
