// The glossary of a page: the terms of this table that occur on it.

/** Terms, each with its other forms, and what they mean. */
const TERMS = [
  ["bond", "The intended contact of two tiles: their target faces coincide."],
  ["trap", "Any other stable contact."],
  ["free", "Tiles far apart, so that their magnets do not act on each other."],
  ["bond A, trap B, trap C, B', B.2", "Kinds of states, the deepest first. A is the bond if there is one, B and B' are mirror images, B.2 is B's second symmetric copy."],
  ["copies", "States that are equal by the symmetry of the tiles, counted as one kind."],
  ["energy, energies", "The magnetic energy of both tiles. It is 0 when they are far apart and negative where they attract."],
  ["depth", "Of a state, how far its energy lies below that of tiles far apart. Of a face profile, how far it protrudes."],
  ["pose", "Position and angle of the moving tile: x and y of its reference point relative to the fixed tile, and its rotation θ."],
  ["barrier", "The energy a tile needs to get from one state to another: the saddle's energy minus the energy of the start."],
  ["saddle", "The highest point of the path with the lowest maximum energy between two states, among all collision-free paths."],
  ["certified", "Of a barrier: proved to lie between the two bounds, for the stated model of the magnets."],
  ["undecided", "Bounds or intervals overlap, so the order is not known."],
  ["caged", "No path leads out, whatever the energy: the shapes block every way."],
  ["far starts, captured, captures", "Tiles start at random far away and move downhill in energy. A capture is a start that ends in a state; its share is given per state."],
  ["overdamped", "Drag is so strong that a tile has no momentum: it moves downhill in energy and never overshoots."],
  ["95 %", "A 95 % confidence interval contains the true value in 95 of 100 repetitions. For shares it stands in brackets."],
  ["baseline", "The point of a sweep that the others are compared with."],
  ["capture range, head-on", "How far a tile at the target face may be shifted, withdrawn or tilted and still move downhill into the bond. Not head-on: moved straight to the face, it stops outside the bond."],
  ["selectivity", "The bond's energy divided by that of the deepest trap: 4 means that the bond is four times as strong."],
  ["proved", "True without exception for the stated model of the magnets. Results not called proved were found by search."],
  ["complete", "Every state that is deeper than the stated energy and has a higher escape barrier than stated is listed."],
  ["unlisted", "The deepest energy that a state missing from the list can have."],
  ["work", "The sum of all energy increases along a path. A path with a low barrier can still need much work."],
  ["most probable", "The path that a shaken tile takes most often."],
  ["minimum, minima", "A pose with less energy than all poses near it."],
  ["milestone", "A random collision-free pose: a node of the roadmap."],
  ["basin", "All poses from which a tile moves downhill into the same state."],
  ["dipole", "A model of magnets as points. It is fast and inaccurate near contact."],
  ["block", "A model of magnets as uniformly magnetised bodies of their real size."],
  ["clearance", "The smallest distance between the two tiles; negative if they overlap."],
  ["kT", "The effective thermal energy of the shaking: a free tile has a mean kinetic energy of kT/2 in each of its three degrees of freedom."],
  ["coverage, covered", "The share of the table's area that tiles cover."],
  ["ln K", "The depth of a bond minus its docking cost, both in kT. Above 0, a pair is bound more than half of the time."],
  ["docking, docking cost", "Docking is the arrival of a tile in a state. Its cost, in kT, is the logarithm of how much rarer the state's poses are than free ones."],
  ["detailed balance", "In equilibrium every transition is as frequent as its reverse, so one rate follows from the other."],
  ["in equilibrium", "After a long time of shaking at this kT."],
  ["drag", "The rate (1/s) at which air slows a moving tile: its speed falls by a factor e in 1/drag."],
  ["restitution", "The share of the approach speed that remains after a collision."],
  ["on-rate", "How often a pair of free tiles on this table binds, per second."],
  ["mean first passage", "The mean time until a tile that leaves one set of poses first reaches another."],
  ["mesh, meshes", "The grid of poses on which rates are computed. A finer mesh has a smaller error."],
  ["closed form", "An estimate from the slope of the energy around the state, without a mesh."],
  ["flux, flow", "How many tiles pass a place per unit of time on their way from one state to another."],
  ["Places, places", "Of a tile: bond, trap or free. Of a magnet: a position on its face."],
  ["word", "The poles of a face's magnets, N or S outwards, read counter-clockwise: the barcode of the face."],
  ["mate, A*", "The word that binds a given word: its reverse with N and S exchanged."],
  ["gap", "Of words: 1 - strongest wrong attraction / weakest bond. Of tiles: the distance between them."],
  ["meeting", "A contact of two faces. It is wrong unless the faces are mates and aligned."],
  ["crosstalk", "The attraction between faces that should not bind."],
  ["flush", "Face to face, without tilt."],
  ["slide, slid", "Shifted along the face from the aligned position."],
  ["position", "Where a magnet can sit on a face."],
  ["glue", "A label on the sides of tiles in a tile set. Sides with equal glues bind; each glue gets its own word."],
  ["strength", "The bond energy of a glue in units of the weakest bond."],
  ["tau", "The total strength that a tile needs to stay attached."],
  ["Gse", "The depth of the weakest bond of strength 1, in kT."],
  ["Gmc", "The entropy cost of attaching a tile of one kind, in kT: the higher, the fewer tiles arrive."],
  ["kTAM", "The kinetic tile assembly model: tiles arrive at a rate set by Gmc and leave at a rate set by the bonds that hold them."],
  ["mismatch", "Two adjacent sides that are not mates."],
  ["docking time", "A unit of time: in one docking time, one tile of each kind arrives at every place on average."],
  ["cluster", "Tiles connected by bonds or traps, directly or through other tiles."],
  ["verdict", "How the tiles on the table move: thermal (with the energy kT), frozen (hardly at all) or driven (by the drives, not thermally)."],
  ["drives", "What keeps the tiles moving: shaking or fans."],
  ["pull-off, straight apart", "The largest force needed to pull the tiles apart at right angles to their faces."],
  ["north pole, south pole", "The two ends of a magnet. Unlike poles attract."],
  ["remanence", "The flux density of a magnet's material: a measure of its strength."],
  ["kerf", "The width of material that the cutter removes."],
  ["pocket", "The hole in a tile that holds a magnet."],
  ["shield", "A sheet of iron near magnets that weakens the field behind it."],
  ["held out", "Measurements not used in the fit, with which it is tested."],
];

/** Whether a text has one of a term's forms, as a whole word or in the plural; capitals count where a form has them. */
function isUsed(term, text) {
  return term.split(", ").some((form) => {
    const plain = form.replace(/[.*]/g, "\\$&");
    return new RegExp(`(?<![\\w-])${plain}(e?s)?(?![\\w-])`, form === form.toLowerCase() ? "i" : "").test(text);
  });
}

/** Explains the words that can be seen so far. */
function explainWords() {
  const text = document.body.innerText;
  const used = TERMS.filter(([term]) => isUsed(term, text));
  element("glossary").hidden = used.length === 0;
  element("glossary").querySelector("dl").append(...used.flatMap(([term, meaning]) => [make("dt", term), make("dd", meaning)]));
}
