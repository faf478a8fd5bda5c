// One shared place links the maps, the tiles and the profile.

/** The path that is shown, how far along it one is (0 to 1) and where that is; the pose under the
    pointer; the chosen state. */
const now = { route: null, path: null, progress: 0, place: null, probe: null, chosen: null, playing: false, linear: false };
/** Seconds that a path takes to play, and a second of a trajectory. */
const DURATION = 9, SECOND = 2;
const durationOf = ({ points, timed }) => timed ? SECOND * (points.at(-1)[0] - points[0][0]) : DURATION;

function showPage() {
  document.title = page.title;
  element("title").textContent = page.title;
  element("subtitle").append(...make("p", page.subtitle).childNodes);
  element("origin").textContent = page.origin;
  for (const fact of page.facts) {
    const box = make("div");
    box.append(make("dt", fact.name), make("dd", fact.value, "value"), make("dd", fact.note, "note"));
    element("facts").append(box);
  }
  for (const { title, is_titled: isTitled, svg, narrow } of page.pictures) {
    if (!isTitled && narrow) element("pictures").append(make("h2", title));
    for (const [kind, source] of [["wide", svg], ["narrow", narrow]]) {
      if (!source) continue;
      const picture = drawnOf(source, title);
      picture.classList.add(kind);
      element("pictures").append(picture);
    }
  }
  for (const table of page.tables) buildTable(table, (state) => choose(state), choosePath);
  element("notes").append(...page.notes.map((note) => make("p", note)));
}

/** Explains what is shown, and adds the files and what to cite, whose words are not the page's. */
function endPage() {
  explainWords();
  listFiles(page.files);
  element("reproduce").hidden = !page.citation;
  element("command").hidden = !page.command;
  element("command").textContent = commandHere(page.command);
  element("citation").textContent = page.citation;
}

/** The command with the folder that this page is in, where its address tells; the file itself has a
 * neutral name, so that the same command writes the same bytes into any folder. */
function commandHere(command) {
  const folder = location.protocol === "file:" && decodeURIComponent(location.pathname).split("/").at(-2);
  if (!folder) return command;
  const plain = /^[\w.,:=+-]+$/.test(folder) ? folder : `'${folder.replaceAll("'", "'\\''")}'`;
  return command.replace(/ --out results$|(?<= --out )results(?= )/, (found) => found.replace("results", () => plain));
}

/** A picture that describes the place under the pointer. */
function drawnOf(source, title) {
  const parsed = new DOMParser().parseFromString(source, "image/svg+xml");
  const picture = document.importNode(parsed.documentElement, true);
  picture.setAttribute("role", "img");
  picture.setAttribute("aria-label", title);
  return picture;
}

/** Links to the files beside the page, those of one stem together. */
function listFiles(files) {
  const stems = new Map();
  for (const file of files) {
    const stem = file.replace(/\.[a-z]+$/, "");
    stems.set(stem, [...stems.get(stem) ?? [], file]);
  }
  for (const [stem, all] of [...stems].sort()) {
    const entry = make("li", `${stem} `);
    for (const file of all) {
      const link = make("a", file.slice(stem.length + 1));
      link.href = file.split("/").map(encodeURIComponent).join("/");
      entry.append(link, " ");
    }
    element("files").querySelector("ul").append(entry);
  }
  element("files").hidden = files.length === 0;
}

let views = null;
let waiting = false;

/** Redraws everything once before the next frame. */
function redraw() {
  if (waiting || !views) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    draw();
  });
}

function draw() {
  for (const view of [views.around, views.inFront]) view.draw();
  drawPathTiles();
  drawProfile();
  drawPose();
  element("theta").value = views.around.plane;
  element("theta-value").textContent = views.around.label();
  element("gap").value = views.inFront.plane;
  element("gap-value").textContent = views.inFront.label();
  element("step").value = now.progress;
  element("here").textContent = !now.place ? "" : now.route.timed
    ? `${now.place.s.toFixed(2)} s, U = ${energyText(now.place.energy, 3)}, kinetic ${energyText(now.place.kinetic, 3)}`
    : `${si(now.place.s, "m", 3)} along, U = ${energyText(now.place.energy)}`;
  element("play").textContent = now.playing ? "Pause" : "Play";
}

/** Goes to a place on the path; both maps follow. */
function goTo(progress) {
  now.progress = Math.max(0, Math.min(1, progress));
  now.place = placeAt(now.route, now.progress);
  views.around.follow(now.place.pose[2]);
  const inFront = views.inFront.coordinates(now.place.pose);
  if (inFront) views.inFront.follow(inFront.gap);
  redraw();
}

function takePath(index) {
  now.route = prepared(world.pathways[index]);
  now.path = index;
  element("path").value = index;
  goTo(0);
  markChosen();
}

/** Shows a state's pose, and the exit of it or of another state of its kind: on the path if chosen in a map, otherwise by itself. */
function choose(state, where = world.tree.length ? "pose" : "tiles") {
  if (!views) return;
  now.chosen = state;
  const starts = (same) => world.pathways.findIndex(({ ends }) => ends[0] !== null && state !== null && same(ends[0]));
  const own = starts((id) => id === state);
  const index = own >= 0 ? own : starts((id) => classOf(id) === classOf(state));
  if (index >= 0 && !now.playing) takePath(index);
  markChosen();
  redraw();
  bring(where);
}

/** Shows a path from its start. */
function choosePath(index) {
  if (!views) return;
  now.playing = false;
  now.chosen = world.pathways[index].ends[0];
  takePath(index);
  element("landscape").scrollIntoView({ block: "start" });
}

function play() {
  now.playing = !now.playing;
  if (now.playing && now.progress >= 1) goTo(0);
  let before = null;
  const advance = (time) => {
    if (!now.playing) return;
    const passed = before === null ? 0 : Math.min(0.1, (time - before) / 1000);
    before = time;
    goTo(now.progress + passed / durationOf(now.route));
    if (now.progress >= 1) now.playing = false;
    else requestAnimationFrame(advance);
  };
  if (now.playing) requestAnimationFrame(advance);
  redraw();
}

function slider(id, view, planes) {
  element(id).max = planes - 1;
  element(id).addEventListener("input", (event) => {
    view.plane = Number(event.target.value);
    redraw();
  });
}

function watchPointer(view) {
  const look = (event) => {
    const state = view.stateAt(event);
    const found = state ? { text: `${state.name}, ${energyText(state.energy)}: click to see it` } : view.probe(event);
    view.canvas.style.cursor = state ? "pointer" : "";
    now.probe = found?.pose ?? null;
    view.readout.textContent = found?.text ?? "";
    redraw();
  };
  view.canvas.addEventListener("pointermove", look);
  view.canvas.addEventListener("pointerdown", look);
  view.canvas.addEventListener("click", (event) => {
    const state = view.stateAt(event);
    if (state) choose(state.id, "tiles");
  });
  view.canvas.addEventListener("pointerleave", () => {
    now.probe = null;
    redraw();
  });
}

async function showLandscape() {
  const [around, inFront] = await Promise.all([unpacked(world.around), unpacked(world.in_front)]);
  element("landscape").hidden = false;
  readTheme();
  views = { around: new AroundView(around), inFront: new InFrontView(inFront) };
  slider("theta", views.around, around.axes[0].length);
  slider("gap", views.inFront, inFront.axes[0].length);
  watchPointer(views.around);
  watchPointer(views.inFront);
  element("path").append(...world.pathways.map((path, k) => new Option(path.name, k)));
  element("path").addEventListener("change", (event) => takePath(Number(event.target.value)));
  element("step").max = 1;
  element("step").addEventListener("input", (event) => goTo(Number(event.target.value)));
  element("play").addEventListener("click", play);
  const drag = (event) => {
    const values = event.buttons && profilePlot?.values(pointer(element("profile"), event));
    if (values) goTo(progressAt(now.route, values[0]));
  };
  element("profile").addEventListener("pointerdown", drag);
  element("profile").addEventListener("pointermove", drag);
  element("player").hidden = world.pathways.length === 0;
  element("merging").hidden = world.tree.length === 0;
  if (world.tree.length) {
    buildTree(choose);
    hintScroll(element("tree"), "graph");
    element("tree-scale").addEventListener("click", (event) => {
      now.linear = !now.linear;
      event.target.setAttribute("aria-pressed", now.linear);
      buildTree(choose);
      markChosen();
    });
  }
  if (world.pathways.length) {
    takePath(0);
    // The steepest part of the approach is more informative than its far end.
    goTo(0.6);
  }
  now.chosen = world.states.length ? world.states[0].id : null;
  markChosen();
  followPage(() => {
    drawColourBar();
    draw();
  });
}

showPage();
if (charts) showCharts();
if (meetings) showMeetings();
if (crowd) showCrowd();
const ready = world ? showLandscape() : Promise.resolve();
ready.then(
  endPage,
  (error) => {
    endPage();
    element("trouble").hidden = false;
    element("trouble").textContent = `The landscape cannot be shown: ${error.message}`;
    console.error(error);
  },
).then(() => { document.documentElement.dataset.ready = "yes"; });
