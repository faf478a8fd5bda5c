// Many tiles on a table, frame by frame.

const crowd = page.crowd;
/** Longest playing time (s); a shorter run plays in real time. */
const LONGEST = 40;
/** Structures, whose tiles have a colour of the theme each; also told apart without red and green. */
const STRUCTURES = ["ring", "chain", "sheet", "target"];
const moment = { frame: 0, playing: false };

function drawCrowd() {
  const frame = crowd.frames[moment.frame];
  const [wide, high] = crowd.size;
  const { pen, width, height } = fresh(element("crowd-tiles"), Math.min(1.2, high / wide));
  const { scale, at } = fitting([-wide / 2, -high / 2, wide / 2, high / 2], width, height, 6);
  pen.strokeStyle = theme.ink;
  pen.lineWidth = 2;
  const sides = crowd.round ? 120 : 4;
  const around = Array.from({ length: sides }, (_, k) => (k + 0.5) / sides * 2 * Math.PI);
  const out = crowd.round ? 1 : Math.SQRT2;
  line(pen, around.map((angle) => [out * Math.cos(angle), out * Math.sin(angle)]).map(([x, y]) => at([x * wide / 2, y * high / 2])), true);
  const poses = frame.poses;
  crowd.tiles.forEach((kind, k) => {
    const own = kind % 2 ? theme.moving : theme.fixed;
    drawTile(pen, crowd.kinds[kind], poses[k], at, STRUCTURES.includes(frame.built[k]) ? theme[frame.built[k]] : own);
    if (crowd.kinds.length > 2) label(pen, crowd.kinds[kind], at(poses[k]), scale);
  });
  const middle = (k) => at(placed(crowd.kinds[crowd.tiles[k]].centre, poses[k]));
  for (const [ties, colour, dashes] of [[frame.bonds, theme.certified, []], [frame.traps, theme.here, [5, 3]]]) {
    pen.strokeStyle = colour;
    pen.lineWidth = 3;
    pen.setLineDash(dashes);
    for (const [i, j] of ties) line(pen, [middle(i), middle(j)]);
  }
  pen.setLineDash([]);
  // Inside the rim.
  const [right, bottom] = at([wide / 2, -high / 2]);
  scaleBar(pen, scale, right - 8, bottom - 8);
  element("crowd-step").value = moment.frame;
  element("crowd-here").textContent =
    `${si(frame.time, "s", 3)}: ${frame.bonds.length} bonds, ${frame.traps.length} traps`;
  element("crowd-play").textContent = moment.playing ? "Pause" : "Play";
}

/** Writes the name of a tile if there is room for it. */
function label(pen, kind, [x, y], scale) {
  const room = scale * Math.max(...kind.outline.map(([a, b]) => Math.hypot(a, b)));
  if (pen.measureText(kind.name).width > 1.2 * room) return;
  pen.fillStyle = theme.ink;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillText(kind.name, x, y);
}

function playCrowd() {
  const last = crowd.frames.length - 1;
  moment.playing = !moment.playing;
  if (moment.playing && moment.frame === last) moment.frame = 0;
  const whole = crowd.frames[last].time;
  const speed = Math.max(1, whole / LONGEST);
  let start = null;
  const from = crowd.frames[moment.frame].time;
  const advance = (now) => {
    if (!moment.playing) return;
    start ??= now;
    const time = from + (now - start) / 1000 * speed;
    while (moment.frame < last && crowd.frames[moment.frame + 1].time <= time) moment.frame++;
    if (moment.frame === last) moment.playing = false;
    drawCrowd();
    if (moment.playing) requestAnimationFrame(advance);
  };
  if (moment.playing) requestAnimationFrame(advance);
  drawCrowd();
}

function showCrowd() {
  element("crowd").hidden = false;
  element("crowd-note").textContent = crowd.note;
  const built = STRUCTURES.filter((kind) => crowd.frames.some((frame) => frame.built.includes(kind)));
  for (const kind of built) {
    const key = document.createElement("span");
    key.className = `key ${kind}`;
    key.textContent = kind;
    element("crowd-built").append(key, " ");
  }
  element("crowd-step").max = crowd.frames.length - 1;
  element("crowd-step").addEventListener("input", (event) => {
    moment.playing = false;
    moment.frame = Number(event.target.value);
    drawCrowd();
  });
  element("crowd-play").addEventListener("click", playCrowd);
  moment.frame = crowd.frames.length - 1;
  followPage(drawCrowd);
}
