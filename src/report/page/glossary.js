// What the words of a page mean: of those in this table the ones that are on it.

/** Terms, each with its other forms, and what they mean. */
const TERMS = [
  ["bond", "The wanted contact of two tiles, in which their target faces coincide."],
  ["trap", "Any other contact that holds."],
  ["free", "Tiles far apart, or a tile that nothing holds."],
  ["bond A, trap B, trap C, B', B.2", "Kinds of states from the deepest: A is the bond where there is one, B and B' are mirror twins, B.2 is the second copy that symmetry makes of B."],
  ["copies", "The states that the symmetry of the tiles makes of one, counted together as a kind."],
  ["energy, energies", "Of the magnets of both tiles, 0 far apart: what is below 0 attracts."],
  ["depth", "How far below that of tiles far apart the energy lies; of a profile, how far it sticks out."],
  ["pose", "Where the moving tile is: x and y of its reference point seen from the fixed tile, and the angle θ by which it is turned."],
  ["barrier", "How far the energy must rise to get from one state to another: the saddle less the energy of the start."],
  ["saddle", "The least possible highest point of the energy, over all ways that the tiles can move without overlapping."],
  ["certified", "Proved to lie between the two bounds, for the stated model of the magnets."],
  ["undecided", "Bounds or intervals overlap, so that nothing is known of the order."],
  ["caged", "There is no way out at all: the shapes are in the way, whatever the energy."],
  ["far starts, captured, captures", "Tiles start at random from far away and creep downhill without swing; the share that ends in a state."],
  ["overdamped", "Drag stops a tile at once, so that it creeps downhill and never swings."],
  ["95 %", "The true value lies in such an interval in 95 of 100 cases; of a share it stands in brackets."],
  ["baseline", "The point of a sweep of which the others are shown as multiples."],
  ["capture range, head-on", "How far off a tile that touches the target face straight on may be slid, drawn back or tilted and still creep downhill into the bond."],
  ["selectivity", "The bond's energy over that of the deepest trap: 4 means that the bond holds four times as strongly."],
  ["proved", "Shown to hold without exception for the stated model of the magnets; what is not called so was found by search."],
  ["complete", "Besides the listed states there is none below the stated energy that takes more than the stated climb to leave."],
  ["unlisted", "How deep a state that is not listed may be at most."],
  ["work", "The energy that is put in: on a path all climbs added up, so that a way with a low barrier may still take much."],
  ["most probable", "Of all paths the one whose motions a shaken tile most likely takes, one after another."],
  ["minimum, minima", "A pose of less energy than all poses next to it."],
  ["milestone", "A pose without overlap, drawn at random, that paths may lead through."],
  ["basin", "All poses from which a tile creeps downhill into the same state."],
  ["dipole", "A model of magnets: points with the magnets' moments, fast to compute and wrong near contact."],
  ["block", "A model of magnets: uniformly magnetised bodies of their size, exact for such."],
  ["clearance", "The least distance between the two tiles; below 0 they overlap."],
  ["kT", "The effective energy of the shaking: a free tile has half of it in each of its motions."],
  ["coverage, covered", "The share of the table's area on which tiles lie."],
  ["ln K", "The logarithm of the binding constant over the concentration of tiles: above 0 a pair is bound more than half of the time."],
  ["docking, docking cost", "A tile's way into a state; its cost is how much rarer than free poses those of the state are, in kT."],
  ["detailed balance", "In equilibrium every change is as frequent as its reverse, which gives one rate from the other."],
  ["in equilibrium", "After any length of time at this shaking."],
  ["drag", "How fast moving tiles slow down in air: the share of the speed that is lost in a second."],
  ["restitution", "The share of the speed that a collision leaves."],
  ["on-rate", "How often a pair of free tiles on this table binds, in a second."],
  ["mean first passage", "The mean time until a tile that leaves one set of poses first reaches the other."],
  ["mesh, meshes", "The poses at which rates are solved for; the finer, the smaller the error."],
  ["closed form", "Estimated from how steep the energy is about the state, without a mesh."],
  ["flux, flow", "How many tiles pass a place on their way from one state to another."],
  ["Places, places", "Where a tile may be: the bond, a trap or free; of a magnet, a position on its face."],
  ["word", "The poles of a face's magnets, N or S outwards, read counter-clockwise: its barcode."],
  ["mate, A*", "The word that binds a given one: its reverse with N and S exchanged."],
  ["gap", "Of words, 1 less the strongest wrong attraction over the weakest bond; of tiles, how far or how wide they are apart."],
  ["meeting", "Two faces against each other; it is wrong unless they are mates and aligned."],
  ["crosstalk", "How strongly faces attract each other that are not to bind."],
  ["flush", "Face against face, without a tilt."],
  ["slide, slid", "Moved along the face from where both are aligned."],
  ["position", "Where a magnet can sit on a face."],
  ["glue", "What sides of tiles of a set are marked with: two that are equal bind, and each gets a word of its own."],
  ["strength", "How many weakest bonds a glue counts for."],
  ["tau", "The strength that must hold a tile for it to stay."],
  ["Gse", "The depth of the weakest bond of strength 1, in kT."],
  ["Gmc", "What docking costs a tile of one kind, in kT: the more, the fewer tiles arrive."],
  ["kTAM", "The kinetic model of tile assembly: tiles arrive as Gmc says and leave as the bonds that hold them say."],
  ["mismatch", "Two sides that touch and are no mates."],
  ["waits", "In one of them a tile of each kind arrives at every place once, on average."],
  ["cluster", "Tiles that hold each other, directly or through others."],
  ["verdict", "Of many tiles, how they move: thermal, as kT says; frozen, hardly any more; or driven, as the drives do."],
  ["drives", "What keeps the tiles moving: shaking, fans."],
  ["pull-off, straight apart", "The largest force against pulling the tiles apart along the normal of their faces."],
  ["north pole, south pole", "The two ends of a magnet: unlike ones attract."],
  ["remanence", "How strong a magnet's material is: the flux density that stays in it."],
  ["kerf", "The width of the line that a cutter takes away."],
  ["pocket", "The hole in a tile that holds a magnet."],
  ["shield", "A sheet of iron near magnets, which weakens what lies behind it."],
  ["held out", "Measurements kept from the fit, on which it is tested."],
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
