// The energy along a path, and the steps of playing it.

/** A path with the progress of its points: the time of a trajectory; otherwise length and energy, on
    the scale, count together, so that playing dwells where something happens. */
function prepared(path) {
  const { points } = path;
  const length = Math.max(points.at(-1)[0] - points[0][0], 1e-12);
  const progress = [0];
  for (let k = 1; k < points.length; k++) {
    const [a, b] = [points[k - 1], points[k]];
    const along = (b[0] - a[0]) / length;
    const climbed = path.timed ? 0 : Math.abs(positionOf(b[4]) - positionOf(a[4]));
    progress.push(progress[k - 1] + along + climbed);
  }
  const total = progress.at(-1);
  return { ...path, progress: progress.map((p) => p / total), extent: pathExtent(path) };
}

/** The place at a progress from 0 to 1. */
function placeAt(route, progress) {
  const { points } = route;
  let k = route.progress.findIndex((p) => p >= progress);
  k = Math.max(1, k < 0 ? points.length - 1 : k);
  const [a, b] = [points[k - 1], points[k]];
  const span = route.progress[k] - route.progress[k - 1];
  const t = span > 0 ? (progress - route.progress[k - 1]) / span : 1;
  const between = (i) => a[i] + t * (b[i] - a[i]);
  const theta = wrap(a[3] + t * wrap(b[3] - a[3]));
  return { s: between(0), pose: [between(1), between(2), theta], energy: between(4), clearance: between(5),
    kinetic: between(6) };
}

/** The progress at a length along the path. */
function progressAt(route, s) {
  const { points, progress } = route;
  const k = Math.max(1, points.findIndex((p) => p[0] >= s));
  const span = points[k][0] - points[k - 1][0];
  return progress[k - 1] + (span > 0 ? Math.max(0, s - points[k - 1][0]) / span : 0) * (progress[k] - progress[k - 1]);
}

let profilePlot = null;

function drawProfile() {
  const canvas = element("profile");
  const { pen, width, height } = fresh(canvas, 0.62);
  const route = now.route;
  if (!route) return;
  const { points } = route;
  const energies = points.map((p) => p[4]);
  const highest = points.reduce((best, p) => p[4] > best[4] ? p : best);
  const totals = route.timed ? points.map((p) => p[4] + p[6]) : [];
  const positions = [...energies, ...totals, ...(route.bounds ?? []), 0].map(positionOf);
  const [low, high] = [Math.min(...positions), Math.max(...positions)];
  const margin = 0.08 * Math.max(high - low, 0.1);
  const plot = profilePlot = new Plot([78, 8, width - 12, height - 44], [points[0][0], points.at(-1)[0]],
    [low - margin, high + 1.6 * margin]);
  const sAxis = quantityTicks(plot.x, route.timed ? "s" : "m", width > 420 ? 7 : 4);
  const ticks = energyTicks(...plot.y).map((u) => [positionOf(u), u ? si(u, "J", 1) : "0"]);
  pen.save();
  plot.clip(pen);
  pen.strokeStyle = theme.line;
  pen.lineWidth = 1;
  for (const [position] of ticks) line(pen, [plot.at(plot.x[0], position), plot.at(plot.x[1], position)]);
  if (route.bounds) {
    const [lower, upper] = route.bounds.map(positionOf);
    const [x0, y0] = plot.at(plot.x[0], upper), [x1, y1] = plot.at(plot.x[1], lower);
    pen.globalAlpha = 0.35;
    pen.fillStyle = theme.certified;
    pen.fillRect(x0, y0, x1 - x0, Math.max(2, y1 - y0));
    pen.globalAlpha = 1;
  }
  pen.strokeStyle = theme.ink;
  pen.setLineDash([4, 4]);
  if (route.timed) line(pen, points.map((p, k) => plot.at(p[0], positionOf(totals[k]))));
  else line(pen, [plot.at(plot.x[0], positionOf(highest[4])), plot.at(plot.x[1], positionOf(highest[4]))]);
  pen.setLineDash([]);
  pen.strokeStyle = theme.accent;
  pen.lineWidth = 2.2;
  line(pen, points.map((p) => plot.at(p[0], positionOf(p[4]))));
  const here = plot.at(now.place.s, positionOf(now.place.energy));
  pen.strokeStyle = theme.here;
  pen.lineWidth = 1;
  line(pen, [[here[0], plot.box[1]], [here[0], plot.box[3]]]);
  marker(pen, "here", here, 6);
  pen.restore();
  axes(pen, plot, { ticks: sAxis.ticks, name: `${route.timed ? "time" : "length along the path"} (${sAxis.unit})` },
    { ticks: thinned(ticks, plot), name: "energy U", room: 68 });
  element("profile-title").textContent = route.timed ? "Energy over time" : "Energy along the path";
  if (route.timed) {
    element("profile-readout").textContent =
      `with the kinetic energy (dashed): ${energyText(totals[0])} at first, ${energyText(totals.at(-1))} at the end`;
    return;
  }
  const taken = `; work ${energyText(route.work)}, length ${si(route.length, "m", 3)}`;
  const bounds = route.bounds ? `; certified (green) ${energyText(route.climbs[0])} to ${energyText(route.climbs[1])}` : "";
  element("profile-readout").textContent =
    `maximum ${energyText(highest[4])} (dashed), ${energyText(highest[4] - points[0][4])} above the start${bounds}${taken}`;
}

/** The ticks that keep a line's height from each other, zero first. */
function thinned(ticks, plot) {
  const kept = [];
  const byImportance = [...ticks].sort((a, b) => Math.abs(a[0]) - Math.abs(b[0]));
  for (const tick of byImportance) {
    const y = plot.at(plot.x[0], tick[0])[1];
    if (kept.every((other) => Math.abs(plot.at(plot.x[0], other[0])[1] - y) > 15)) kept.push(tick);
  }
  return kept;
}
