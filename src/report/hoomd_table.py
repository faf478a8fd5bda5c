"""Continues the last frame of trajectory.gsd in HOOMD-blue, on several processors or a GPU.

    python3 hoomd_table.py SECONDS [--device cpu|gpu] [--frames DT] [--step S]
    mpirun -n 16 python3 hoomd_table.py SECONDS

Checked with HOOMD-blue 4.8.2; not with other versions. It needs HOOMD-blue 4.0 or later with its gsd. Of
HOOMD-blue 7 take 7.1 or later, which keeps rigid bodies in the plane, with gsd 5 or later: since 7.0
hoomd.gsd has the schema 2, which OVITO reads from 3.15.2 on.

Reads hoomd_table.json and trajectory.gsd from its own folder and writes hoomd.gsd there: tiles by their centres
of mass, which OVITO opens. Units: m, kg, s, J, A m^2.

Tiles are rigid bodies of point dipoles and of discs along the inside of the outline. In contrast to
`tilebind table`,
- blocks are grids of point dipoles as far apart as the block is thick;
- discs repel each other like springs, so that contact has no friction and loses no energy, corners are
  rounded and edges uneven by a few hundredths of a disc;
- shaking is white noise in every step, not a kick every few milliseconds;
- there are no shields, no fans, no moving table and no friction on it, no bonds.csv and no energy balance.
"""

import argparse
import itertools
import json
import math
import pathlib

import gsd.hoomd
import hoomd
import numpy as np

FOLDER = pathlib.Path(__file__).parent
SPACING = 0.5  # of discs, in diameters
PRESSED = 0.5  # by the strongest hit, in diameters
STEPS = 30  # of time, in each period of a tile that bounces on its springs


def turned(points, theta):
    """Points (n, 2) turned by theta (rad)."""
    cos, sin = math.cos(theta), math.sin(theta)
    return np.asarray(points) @ np.array([[cos, sin], [-sin, cos]])


def distance(points, start, end):
    """Distances (m) of points (n, 2) from a segment."""
    along = (end - start) / np.dot(end - start, end - start)
    share = np.clip((points - start) @ along, 0.0, 1.0)
    return np.linalg.norm(points - start - share[:, None] * (end - start), axis=1)


def discs(outline, diameter):
    """Centres of discs that touch a counter-clockwise outline from inside."""
    ends = np.roll(outline, -1, axis=0)
    centres = []
    for start, end in zip(outline, ends):
        length = np.linalg.norm(end - start)
        tangent = (end - start) / length
        inwards = np.array([-tangent[1], tangent[0]])
        count = math.ceil(length / (SPACING * diameter))
        shares = np.linspace(0.0, 1.0, count + 1)
        centres.append(start + shares[:, None] * (end - start) + 0.5 * diameter * inwards)
        # Where an edge begins or ends at a convex corner, the last disc touches both edges.
        room = 0.5 * diameter
        if length > diameter:
            inner = np.array([[room], [length - room]]) * tangent
            centres.append(start + inner + room * inwards)
    centres = np.concatenate(centres)
    clear = np.min([distance(centres, *edge) for edge in zip(outline, ends)], axis=0)
    return np.unique(centres[clear > 0.499 * diameter].round(12), axis=0)


def dipoles(magnet, model):
    """Places (n, 2), direction (rad) and moment of the dipoles of one magnet."""
    along, across, through = magnet["size"]
    counts = [1, 1] if model == "dipole" else [max(1, round(it / through)) for it in (along, across)]
    grid = [(np.arange(count) + 0.5) / count - 0.5 for count in counts]
    places = [(x * along, y * across) for x, y in itertools.product(*grid)]
    places = turned(places, magnet["angle"]) + magnet["position"]
    return places, magnet["angle"], magnet["moment"] / len(places)


def spring(kinds, diameter, kt):
    """Stiffness (N/m) of two discs that a tile hits with the energy of a bond, or ten kT."""
    strongest = 10.0 * (kt or 0.0)
    for kind in kinds:
        for face in {it["face"] for it in kind["magnets"]}:
            on_face = [it for it in kind["magnets"] if it["face"] == face]
            energies = [2e-7 * it["moment"] ** 2 / it["size"][0] ** 3 for it in on_face]
            strongest = max(strongest, sum(energies))
    return 2.0 * strongest / (PRESSED * diameter) ** 2


class Model:
    """What HOOMD-blue needs to know of the tiles."""

    def __init__(self, told):
        kinds = told["kinds"]
        outlines = [np.array(kind["outline"]) for kind in kinds]
        edges = [np.linalg.norm(np.roll(it, -1, axis=0) - it, axis=1).max() for it in outlines]
        magnets = [it for kind in kinds for it in kind["magnets"]]
        self.diameter = min([0.02 * min(edges)] + [0.5 * min(it["size"][:2]) for it in magnets])
        self.stiffness = spring(kinds, self.diameter, told["shaking_J"])
        self.types, self.bodies = {}, {}
        for kind, outline in zip(kinds, outlines):
            parts = [("disc", place, 0.0) for place in discs(outline, self.diameter)]
            for magnet in kind["magnets"]:
                places, angle, moment = dipoles(magnet, told["model"])
                vector = (0.0, 0.0, moment * magnet["up"]) if magnet["up"] else (moment, 0.0, 0.0)
                name = self.types.setdefault(vector, f"dipole {len(self.types)}")
                parts += [(name, place, angle) for place in places]
            centre = np.array(kind["centre"])
            self.bodies[kind["name"]] = {
                "constituent_types": [name for name, _, _ in parts],
                "positions": [(*(place - centre), 0.0) for _, place, _ in parts],
                "orientations": [(math.cos(0.5 * it), 0.0, 0.0, math.sin(0.5 * it)) for _, _, it in parts],
            }
        most = max(sum(it == "disc" for it in body["constituent_types"]) for body in self.bodies.values())
        lightest = min(kind["mass"] for kind in kinds)
        # A quarter of a tile's discs press against those of another one.
        self.step = 2.0 * math.pi * math.sqrt(0.5 * lightest / (0.25 * most * self.stiffness)) / STEPS


def start(told, model):
    """The last frame, by centres of mass, in a box so wide that images do not meet."""
    with gsd.hoomd.open(FOLDER / "trajectory.gsd") as frames:
        frame = frames[-1]
    particles = frame.particles
    particles.body = np.arange(particles.N)
    particles.types = [kind["name"] for kind in told["kinds"]] + ["disc", *model.types.values()]
    particles.type_shapes = None
    size = [side + 2.0 * told["cut_off_m"] for side in told["table_m"]]
    frame.configuration.box = [*size, 0.0, 0.0, 0.0, 0.0]
    return frame


def forces(told, model):
    """Dipoles, contact of tiles, and the rim."""
    names = list(model.types.values())
    everything = [*model.bodies, "disc", *names]
    pairs = list(itertools.combinations_with_replacement(everything, 2))
    reach = told["cut_off_m"]
    near = hoomd.md.nlist.Tree(buffer=0.5 * model.diameter, exclusions=("body",))
    contact = hoomd.md.pair.Table(nlist=near, default_r_cut=0.0)
    depth = model.diameter - np.linspace(0.0, model.diameter, 100, endpoint=False)
    springs = {"r_min": 0.0, "U": 0.5 * model.stiffness * depth**2, "F": model.stiffness * depth}
    far = hoomd.md.nlist.Tree(buffer=0.05 * reach, exclusions=("body",))
    magnetic = hoomd.md.pair.aniso.Dipole(nlist=far, default_r_cut=0.0)
    for pair in pairs:
        contact.params[pair] = springs
        magnetic.params[pair] = {"A": 1e-7, "kappa": 0.0}
        if pair == ("disc", "disc"):
            contact.r_cut[pair] = model.diameter
        if set(pair) <= set(names):
            magnetic.r_cut[pair] = reach
    for name in everything:
        magnetic.mu[name] = (0.0, 0.0, 0.0)
    for vector, name in model.types.items():
        magnetic.mu[name] = vector
    half = [0.5 * side for side in told["table_m"]]
    planes = [((-half[0], 0, 0), (1, 0, 0)), ((half[0], 0, 0), (-1, 0, 0)),
              ((0, -half[1], 0), (0, 1, 0)), ((0, half[1], 0), (0, -1, 0))]
    walls = [hoomd.wall.Plane(origin=origin, normal=normal) for origin, normal in planes]
    if told["round"]:
        walls = [hoomd.wall.Cylinder(radius=half[0], axis=(0, 0, 1), inside=True)]
    rim = hoomd.md.external.wall.ForceShiftedLJ(walls=walls)
    for name in everything:
        rim.params[name] = {"epsilon": 0.0, "sigma": 1.0, "r_cut": 0.0}
    energy = 0.02 * model.stiffness * model.diameter**2
    sigma = 0.5 * model.diameter
    rim.params["disc"] = {"epsilon": energy, "sigma": sigma, "r_cut": 2 ** (1 / 6) * sigma}
    return magnetic, contact, rim


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("seconds", type=float, help="time to simulate (s)")
    parser.add_argument("--device", choices=["cpu", "gpu"], default="cpu")
    parser.add_argument("--frames", type=float, default=1.0, help="interval of frames (s)")
    parser.add_argument("--step", type=float, help="time step (s)")
    asked = parser.parse_args()
    told = json.loads((FOLDER / "hoomd_table.json").read_text())
    model = Model(told)
    step = asked.step or model.step

    device = hoomd.device.GPU() if asked.device == "gpu" else hoomd.device.CPU()
    simulation = hoomd.Simulation(device=device, seed=told["seed"] % 65536)
    simulation.create_state_from_snapshot(hoomd.Snapshot.from_gsd_frame(start(told, model), device.communicator))
    rigid = hoomd.md.constrain.Rigid()
    for kind, body in model.bodies.items():
        rigid.body[kind] = body
    for name in ["disc", *model.types.values()]:
        rigid.body[name] = None
    rigid.create_bodies(simulation.state)

    tiles = hoomd.filter.Rigid(("center",))
    if told["drag_per_s"] > 0.0:
        method = hoomd.md.methods.Langevin(filter=tiles, kT=told["shaking_J"] or 0.0)
        for kind in told["kinds"]:
            drag = told["drag_per_s"]
            method.gamma[kind["name"]] = drag * kind["mass"]
            method.gamma_r[kind["name"]] = (0.0, 0.0, drag * kind["inertia"])
    else:
        method = hoomd.md.methods.ConstantVolume(filter=tiles)
    all_forces = forces(told, model)
    simulation.operations.integrator = hoomd.md.Integrator(
        dt=step, methods=[method], forces=list(all_forces), rigid=rigid, integrate_rotational_dof=True)
    thermo = hoomd.md.compute.ThermodynamicQuantities(filter=tiles)
    simulation.operations.computes.append(thermo)
    every = max(1, round(asked.frames / step))
    simulation.operations.writers.append(hoomd.write.GSD(
        filename=FOLDER / "hoomd.gsd", trigger=hoomd.trigger.Periodic(every), mode="wb", filter=tiles,
        dynamic=["property", "momentum"]))

    simulation.run(0)
    print(f"magnetic energy at the start: {all_forces[0].energy:.6g} J; steps of {step:.3g} s", flush=True)
    for _ in range(max(1, round(asked.seconds / step / every))):
        simulation.run(every)
        kinetic = thermo.translational_kinetic_energy / thermo.translational_degrees_of_freedom
        print(f"{simulation.timestep * step:9.3f} s: magnetic {all_forces[0].energy:.6g} J, "
              f"kinetic {kinetic:.3g} J per degree of freedom along x and y", flush=True)


if __name__ == "__main__":
    main()
