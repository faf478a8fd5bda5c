// The disconnectivity graph.

function svg(name, attributes = {}, text = "") {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = text;
  return made;
}

const leavesOf = (node) => node.children ? node.children.reduce((sum, child) => sum + leavesOf(child), 0) : 1;
const energiesOf = (node) => [node.energy, ...(node.bounds ?? []), ...(node.children ?? []).flatMap(energiesOf)];

/** The least distance (px) of labels from lines and from each other. */
const CLEAR = 2;

function buildTree(choose) {
  const place = now.linear ? (energy) => energy / world.most : positionOf;
  const count = world.tree.reduce((sum, { root }) => sum + leavesOf(root), 0);
  const energies = [0, ...world.tree.flatMap(({ root }) => energiesOf(root))];
  const positions = energies.map(place);
  const [low, high] = [Math.min(...positions), Math.max(...positions)];
  const span = Math.max(high - low, 0.2);
  const width = Math.max(560, 70 + 66 * count), height = 430;
  const y = (energy) => 24 + (height - 100) * (high - place(energy)) / span;
  const x = (leaf) => 78 + (width - 90) * leaf / count;
  const picture = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "group", "aria-label": "Disconnectivity graph" });
  picture.style.minWidth = `${0.75 * width}px`;
  const add = (name, attributes, text) => picture.append(svg(name, attributes, text));

  const kept = [];
  const ticks = now.linear ? roundTicks(Math.min(...energies), Math.max(...energies), 7).ticks : energyTicks(low, high);
  for (const energy of [0, ...ticks.sort((a, b) => Math.abs(b) - Math.abs(a))]) {
    if (kept.some((other) => Math.abs(y(other) - y(energy)) < 18)) continue;
    kept.push(energy);
    add("line", { x1: 74, x2: width, y1: y(energy), y2: y(energy), class: "grid" });
    add("text", { x: 70, y: y(energy) + 4, "text-anchor": "end" }, energy ? si(energy, "J", now.linear ? 2 : 1) : "0");
  }

  let next = 0;
  const leaf = (node) => {
    const at = x(next++ + 0.5), foot = y(node.energy);
    const state = world.states.find((s) => s.id === node.state);
    const name = state ? state.name : "free";
    const lines = [name, energyText(node.energy, 3), ...(node.copies > 1 ? [`\u00d7${node.copies}`] : [])];
    const group = svg("g", { class: "leaf", tabindex: 0, role: "button", "data-state": node.state ?? "free",
      "aria-label": `Show ${name}, ${energyText(node.energy, 3)}` });
    taken.push([at - 33, foot - 10, at + 33, foot + 12 + 16 * lines.length]);
    group.append(svg("rect", { x: at - 32, y: foot - 14, width: 64, height: 28 + 16 * lines.length, rx: 5, class: "hit" }));
    const fill = !state ? "var(--page)" : state.kind === "bound" ? "#f0e442" : "#cc79a7";
    group.append(svg("circle", { cx: at, cy: foot, r: state?.kind === "bound" ? 8 : 6, stroke: "var(--ink)", fill }));
    lines.forEach((text, k) => group.append(svg("text", { x: at, y: foot + 22 + 16 * k, "text-anchor": "middle" }, text)));
    group.addEventListener("click", () => choose(node.state));
    group.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      choose(node.state);
    });
    leaves.push(group);
    return at;
  };
  // Rectangles that labels keep off: lines, the labels of states, and each other.
  const leaves = [], labels = [], taken = [];
  const limb = (x1, y1, x2, y2, kind = "limb") => {
    add("line", { x1, y1, x2, y2, class: kind });
    taken.push([Math.min(x1, x2) - CLEAR, Math.min(y1, y2) - CLEAR, Math.max(x1, x2) + CLEAR, Math.max(y1, y2) + CLEAR]);
  };
  const merges = [];
  const draw = (node) => {
    if (!node.children) return leaf(node);
    const level = y(node.energy);
    const ends = node.children.map((child) => {
      const at = draw(child);
      limb(at, y(child.energy), at, level);
      return at;
    });
    limb(ends[0], level, ends.at(-1), level);
    const middle = (ends[0] + ends.at(-1)) / 2;
    if (node.bounds) {
      const [lower, upper] = node.bounds.map(y);
      limb(middle, lower, middle, upper, "certified");
      for (const end of [lower, upper]) limb(middle - 6, end, middle + 6, end, "certified");
    }
    merges.push([middle, level, energyText(node.energy, 3)]);
    return middle;
  };
  for (const { root, apart } of world.tree) {
    const at = draw(root);
    limb(at, y(root.energy), at, 6);
    if (!apart) continue;
    // To the left of its line where there is no room to the right.
    const long = 7.6 * apart.length, turned = at + 8 + long > width;
    add("text", { x: turned ? at - 6 : at + 6, y: 14, class: "soft", "text-anchor": turned ? "end" : "start" }, apart);
    taken.push(turned ? [at - 8 - long, 0, at - 4, 18] : [at + 4, 0, at + 8 + long, 18]);
  }
  for (const [mx, my, text] of merges) {
    const wide = 7.2 * text.length;
    const spots = [0, 1, 2, 3, 4].flatMap((k) => [9 + 14 * k, -9 - wide - 14 * k].flatMap((dx) =>
      [-6, 17, -22, 33, -38, 49].map((dy) => [mx + dx, my + dy])));
    const free = ([left, base]) => left > 74 && left + wide < width && base > 12
      && taken.every(([a, b, c, d]) => left + wide <= a || c <= left || base + 3 <= b || d <= base - 11);
    const away = ([left, base]) => Math.hypot(left + (left < mx ? wide : 0) - mx, base - my);
    // Where there is no room the table has the figure.
    const spot = spots.filter(free).sort((a, b) => away(a) - away(b))[0];
    if (!spot) continue;
    const [left, base] = spot;
    taken.push([left, base - 11, left + wide, base + 3]);
    labels.push(svg("text", { x: left, y: base, class: "soft merge" }, text));
  }
  picture.append(...labels, ...leaves);
  element("tree").replaceChildren(picture);
}

function markChosen() {
  for (const group of document.querySelectorAll("#tree .leaf")) {
    const state = group.dataset.state;
    const same = now.chosen === null ? state === "free" : state !== "free" && classOf(Number(state)) === classOf(now.chosen);
    group.classList.toggle("chosen", same);
  }
  for (const row of document.querySelectorAll("#tables tr.shows")) {
    const { state, path } = row.dataset;
    const same = path === undefined ? classOf(Number(state)) === classOf(now.chosen) : Number(path) === now.path;
    row.classList.toggle("chosen", same);
  }
}
