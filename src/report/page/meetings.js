// Meetings of a set of words: a map of all faces against all, and the tiles of the one chosen.

const meetings = page.meetings;
let met = null;

/** White to dark blue, by the share of the weakest bond. */
function shareColour(share) {
  const t = Math.max(0, Math.min(1, share));
  const [r, g, b] = [[247, 8], [251, 48], [255, 107]].map(([from, to]) => Math.round(from + (to - from) * t));
  return `rgb(${r},${g},${b})`;
}

const shareOf = (energy) => Math.max(0, -energy / meetings.bond_J);
const areMates = (i, j) => Math.abs(i - j) === meetings.names.length / 2;

/** Where the cells are on the canvas. */
function meetingGrid(width) {
  const n = meetings.names.length, left = 34;
  return { n, left, cell: Math.min(44, (width - left - 4) / n) };
}

function drawMeetingMap() {
  const canvas = element("meeting-map");
  const { n, left, cell } = meetingGrid(canvas.clientWidth);
  const { pen } = fresh(canvas, (left + n * cell + 30) / Math.max(160, canvas.clientWidth));
  const every = Math.ceil(16 / cell);
  pen.textBaseline = "middle";
  for (let i = 0; i < n; i++) {
    const middle = left + (i + 0.5) * cell;
    if (i % every === 0) {
      pen.fillStyle = theme.ink;
      pen.textAlign = "right";
      pen.fillText(meetings.names[i], left - 5, middle);
      pen.textAlign = "center";
      pen.fillText(meetings.names[i], middle, left - 12);
    }
    for (let j = 0; j < n; j++) {
      const energy = meetings.energies_J[i][j];
      const [x, y] = [left + j * cell, left + i * cell];
      pen.fillStyle = energy === null ? theme.panel : shareColour(shareOf(energy));
      pen.fillRect(x, y, cell - 0.7, cell - 0.7);
      if (areMates(i, j)) {
        pen.strokeStyle = "#d55e00";
        pen.lineWidth = 1.6;
        pen.strokeRect(x + 0.8, y + 0.8, cell - 2.3, cell - 2.3);
      }
      if (energy !== null && cell >= 30) {
        pen.fillStyle = shareOf(energy) > 0.5 ? "#fff" : "#222";
        pen.textAlign = "center";
        pen.fillText(shareOf(energy).toFixed(2), x + cell / 2, y + cell / 2);
      }
    }
  }
  const [i, j] = met;
  pen.strokeStyle = theme.here;
  pen.lineWidth = 2.5;
  pen.strokeRect(left + j * cell, left + i * cell, cell - 0.7, cell - 0.7);
  const y = left + n * cell + 12, step = Math.min(26, (canvas.clientWidth - left - 150) / 11);
  for (let k = 0; k <= 10; k++) {
    pen.fillStyle = shareColour(k / 10);
    pen.fillRect(left + k * step, y, step, 12);
  }
  pen.fillStyle = theme.ink;
  pen.textAlign = "left";
  pen.fillText("0 to 1 weakest bond", left + 11 * step + 6, y + 6);
}

/** A tile with one face's magnets; of one turned over they lie the other way round. */
function faceTile(magnets, over) {
  const lying = (m) => over ? { ...m, position: [m.position[0], -m.position[1]] } : m;
  return { outline: meetings.outline, magnets: magnets.map(lying) };
}

function drawMeeting() {
  const [i, j] = met;
  const canvas = element("meeting-tiles"), pose = meetings.poses[i][j];
  const over = meetings.over[i]?.[j] ?? false;
  const { pen, width, height } = fresh(canvas, 0.8);
  const told = element("meeting-readout");
  const [first, second] = [meetings.names[i], meetings.names[j]];
  const codes = `${first} = ${meetings.codes[i]}, ${second} = ${meetings.codes[j]}`;
  if (!pose) {
    told.textContent = `${first} on ${second}: they meet in no wrong way. ${codes}.`;
    return;
  }
  const corners = [...meetings.outline, ...meetings.outline.map((p) => placed(p, pose))];
  const [xs, ys] = [0, 1].map((k) => corners.map((p) => p[k]));
  const box = [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
  const { scale, at } = fitting(box, width, height, 12);
  drawTile(pen, faceTile(meetings.first[i], false), [0, 0, 0], at, theme.fixed);
  drawTile(pen, faceTile(meetings.second[j], over), pose, at, theme.moving);
  scaleBar(pen, scale, width, height);
  const energy = meetings.energies_J[i][j], lower = meetings.lower_J?.[i]?.[j] ?? null;
  const bond = areMates(i, j) ? " (its own mate: the strongest meeting beside the bond)" : "";
  const proved = lower === null || areMates(i, j) ? "" : `, proved no lower than ${si(lower, "J")}`;
  told.textContent = `${first} on ${second}${over ? ", turned over" : ""}${bond}: ${si(energy, "J")}${proved},`
    + ` ${shareOf(energy).toFixed(3)} of the weakest bond; ${poseText(pose)}. ${codes}.`;
}

function showMeeting(cell) {
  const { n } = meetingGrid(element("meeting-map").clientWidth);
  met = cell.map((k) => Math.max(0, Math.min(n - 1, k)));
  drawMeetingMap();
  drawMeeting();
}

function showMeetings() {
  element("meetings").hidden = false;
  element("meetings-title").textContent = meetings.title;
  element("meetings-note").textContent = meetings.note;
  const canvas = element("meeting-map");
  canvas.addEventListener("click", (event) => {
    const { n, left, cell } = meetingGrid(canvas.clientWidth);
    const [x, y] = pointer(canvas, event).map((p) => Math.floor((p - left) / cell));
    if (x >= 0 && y >= 0 && x < n && y < n) showMeeting([y, x]);
  });
  canvas.addEventListener("keydown", (event) => {
    const move = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] }[event.key];
    if (!move) return;
    event.preventDefault();
    showMeeting([met[0] + move[0], met[1] + move[1]]);
  });
  const anew = () => {
    readTheme();
    showMeeting(met ?? meetings.worst);
  };
  anew();
  addEventListener("resize", anew);
  for (const query of ["print", "(prefers-color-scheme: dark)"]) matchMedia(query).addEventListener("change", anew);
}
