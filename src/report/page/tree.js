// The disconnectivity graph.

function buildTree(choose) {
  const [byLogarithms, evenly] = world.tree;
  const picture = drawnOf(now.linear ? evenly : byLogarithms, "Disconnectivity graph");
  picture.setAttribute("role", "group");
  for (const leaf of picture.querySelectorAll("[data-state]")) {
    const { state } = leaf.dataset;
    const id = state === "free" ? null : Number(state);
    leaf.setAttribute("role", "button");
    leaf.setAttribute("aria-label", `Show ${leaf.textContent}`);
    choosable(leaf, () => choose(id));
    leaf.classList.add("leaf");
  }
  // Narrower its words could not be read.
  picture.style.minWidth = `${0.75 * picture.width.baseVal.value}px`;
  element("tree").replaceChildren(picture);
}

function markChosen() {
  for (const leaf of document.querySelectorAll("#tree .leaf")) {
    const { state } = leaf.dataset;
    const same = now.chosen === null ? state === "free" : state !== "free" && classOf(Number(state)) === classOf(now.chosen);
    leaf.classList.toggle("chosen", same);
  }
  for (const row of document.querySelectorAll("#tables tr.shows")) {
    const { state, path } = row.dataset;
    const same = path === undefined ? classOf(Number(state)) === classOf(now.chosen) : Number(path) === now.path;
    row.classList.toggle("chosen", same);
  }
}
