// Contacts of a set of words: a map of all pairs of faces, and the tiles of the chosen one.

const meetings = page.meetings;
let met = null;

const shareOf = (energy) => Math.max(0, -energy / meetings.bond_J);
const areBond = (i, j) => meetings.own ? i === j : Math.abs(i - j) === meetings.names.length / 2;

/** A tile with one face's magnets, in reverse order if it is turned over. */
function faceTile(magnets, over) {
  const lying = (m) => over ? { ...m, position: [m.position[0], -m.position[1]] } : m;
  return { outline: meetings.outline, magnets: magnets.map(lying) };
}

function drawMeeting() {
  const [i, j] = met;
  const canvas = element("meeting-tiles"), pose = meetings.poses[i][j];
  const over = meetings.over[i]?.[j] ?? false;
  const { pen, width, height } = fresh(canvas, 0.7);
  const told = element("meeting-readout");
  const [first, second] = [meetings.names[i], meetings.names[j]];
  const codes = `${first} = ${meetings.codes[i]}, ${second} = ${meetings.codes[j]}`;
  if (!pose) {
    told.textContent = `${first} on ${second}: no wrong contact. ${codes}.`;
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
  const bond = areBond(i, j) ? ` (its own ${meetings.own ? "kind" : "mate"}: the strongest contact other than the bond)` : "";
  const proved = lower === null || areBond(i, j) ? "" : `, proved lower bound ${si(lower, "J")}`;
  told.textContent = `${first} on ${second}${over ? ", turned over" : ""}${bond}: ${si(energy, "J")}${proved},`
    + ` ${shareOf(energy).toFixed(3)} of the weakest bond; ${poseText(pose)}. ${codes}.`;
}

function showMeeting(cell) {
  const last = meetings.names.length - 1;
  met = cell.map((k) => Math.max(0, Math.min(last, k)));
  for (const spot of document.querySelectorAll("#meeting-map [data-cell]")) {
    spot.classList.toggle("chosen", spot.dataset.cell === met.join(" "));
  }
  drawMeeting();
}

function showMeetings() {
  element("meetings").hidden = false;
  element("meetings-title").textContent = meetings.title;
  element("meetings-note").textContent = meetings.note;
  const map = element("meeting-map");
  const spots = [...document.querySelectorAll("#pictures [data-cell]")];
  // The picture of the map, which has the title, stands beside its tiles.
  const pictures = new Set(spots.map((spot) => spot.ownerSVGElement));
  const head = spots[0].ownerSVGElement.previousElementSibling;
  if (head?.tagName === "H2") head.remove();
  else element("meetings-title").hidden = true;
  map.append(...pictures);
  for (const spot of spots) {
    spot.addEventListener("click", () => {
      showMeeting(spot.dataset.cell.split(" ").map(Number));
      bring("meeting-tiles");
    });
  }
  map.addEventListener("keydown", (event) => {
    const move = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] }[event.key];
    if (!move) return;
    event.preventDefault();
    showMeeting([met[0] + move[0], met[1] + move[1]]);
  });
  followPage(() => showMeeting(met ?? meetings.worst));
}
