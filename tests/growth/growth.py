"""How the time of an analysis grows with a design: over magnets a face, corners, and faces with magnets.

    tests/growth/growth.py target/release/tilebind results/growth.csv [--limit SECONDS] [--model MODEL]
        [--only FAMILY]

analyses designs of one family a row, without proofs (`analyse --certify-seconds 0
--complete-seconds 0`), and writes the processor time of each (user and system, of all threads,
pictures included), with what was asked for and found, and the picture of the table beside it.
Magnets are dipoles unless `--model` is given.
`--draw TABLE` draws an existing table; `--design FAMILY SIZE` prints a design.

Beyond 16,384 pairs of magnets `analyse` asks for less: fewer milestones, far starts and kinds of
states (`Settings::of`). Such a row is `asked = less`, is no measure of growth against smaller ones,
and has a second one, `asked = usual`, with what smaller designs are asked for. Slopes are of log
time over log size, by least squares, of `usual` rows only. A design that is not done within the
limit has an empty time, and so have the larger ones of its family, which are not tried.
"""

import csv
import json
import math
import random
import resource
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

MAGNETS = [4, 8, 16, 32, 64, 128, 256]
CORNERS = [4, 8, 16, 32, 64, 128, 256]
FACES = [1, 2, 4, 8, 16, 32, 64]
COLUMNS = ["family", "size", "pairs", "asked", "processor_s", "milestones", "far_starts", "kinds", "states", "barriers",
           "captured", "energies"]
# The defaults of `analyse` for tiles without very many magnets; all kinds of states.
MANY_PAIRS = 16_384
USUAL = ["--milestones", "8000", "--far-starts", "1000", "--kinds", "1000000"]
NO_PROOFS = ["--certify-seconds", "0", "--complete-seconds", "0"]


def code(n, seed):
    """As many north as south poles in random order; NNNS for four."""
    if n == 4:
        return "NNNS"
    poles = list("NS" * (n // 2) + "N" * (n % 2))
    random.Random(seed).shuffle(poles)
    return "".join(poles)


def mate(word):
    return "".join("S" if pole == "N" else "N" for pole in reversed(word))


def tile(name, shape, faces):
    lines = [f"[{name}]", shape, "thickness = 0.013", "mass = 0.1", f"[{name}.faces]", *faces]
    return "\n".join(lines)


def design(name, magnet, fixed, moving, target, inset=0.0):
    """`magnet`: pitch (m); the magnets are as long and wide as the paper's, or as fit."""
    size = min(0.01, 0.8 * magnet)
    return f"""name = "{name}"
[table]
size = [2.0, 2.0]
[magnet]
size = [{size:.9g}, {size:.9g}, {0.3 * size:.9g}]
remanence = 1.2
pitch = {magnet:.9g}
inset = {inset}
{fixed}
{moving}
[target]
fixed = "{target[0]}"
moving = "{target[1]}"
[potential]
model = "dipole"
"""


def magnets(n):
    """The paper's squares with n magnets a face."""
    word = code(n, 7)
    pair = (tile("fixed", "side = 0.43", [f'all = {{ code = "{word}" }}']),
            tile("moving", "side = 0.43", [f'all = {{ code = "{mate(word)}" }}']))
    return design(f"magnets-{n}", 0.04 if n == 4 else 0.4 / n, *pair, ("east", "west"))


def corners(n):
    """The paper's squares, the meeting faces a wave of n straight pieces."""
    count = max(n // 16, 1)
    points = [(k / n - 0.5, round(math.sin(2 * math.pi * count * k / n), 9)) for k in range(n + 1)]
    points = ", ".join(f"[{0.36 * s:.9g}, {0.008 * h / count:.9g}]" for s, h in points)
    east = f'east = {{ profile = {{ shape = "points", points = [{points}] }} }}'
    pair = (tile("fixed", "side = 0.43", ['all = { code = "NNNS" }', east]),
            tile("moving", "side = 0.43", ['all = { code = "NSSS" }', 'west = { mates = "east" }']))
    return design(f"corners-{n}", 0.04, *pair, ("east", "west"), inset=0.002)


def faces(n):
    """A polygon as large as the paper's tile, of n sides with four magnets each (below four: a
    square with so many such faces)."""
    sides = max(n, 4)
    side = 0.43 * math.tan(math.pi / sides)
    shape = f"sides = {sides}\nside = {side:.9g}"
    pitch = min(0.04, side / 4.5)
    # Opposite faces meet first.
    order = [0, sides // 2, *(k for k in range(1, sides) if k != sides // 2)][:n]

    def coded(word, turn):
        return [f'{(k + turn) % sides} = {{ code = "{word}" }}' for k in sorted(order)]

    pair = (tile("fixed", shape, coded("NNNS", 0)), tile("moving", shape, coded("NSSS", sides // 2)))
    return design(f"faces-{n}", pitch, *pair, ("0", str(sides // 2)))


# Each with its sizes, the design of a size, and the pairs of magnets that this has.
FAMILIES = {"magnets a face": (MAGNETS, magnets, lambda n: (4 * n) ** 2),
            "corners": (CORNERS, corners, lambda n: 16**2),
            "faces": (FACES, faces, lambda n: (4 * n) ** 2)}


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measure(program, text, limit, asked):
    """The columns from `processor_s` on; empty where the limit (s of processor time) did not do."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "design.toml"
        path.write_text(text)
        out = Path(folder) / "out"
        command = [program, "analyse", path, *NO_PROOFS, *asked, "--out", out]
        before = processor_seconds()
        whole = math.ceil(limit)
        done = subprocess.run(command, capture_output=True, text=True, preexec_fn=lambda: resource.setrlimit(
            resource.RLIMIT_CPU, (whole, whole)))
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            return [""] * (len(COLUMNS) - 4)
        if done.returncode != 0:
            sys.exit(f"{text}\n{done.stderr}")
        seconds = processor_seconds() - before
        report = json.loads((out / "report.json").read_text())
        counts, settings = report["counts"], report["settings"]
        states, bond = report["states"], report["bound"]["state"]
        bonds = [] if bond is None else [s for s in states if s["class"] == states[bond]["class"]]
        captured = f"{sum(state['capture']['share'] for state in bonds):.3f}"
        kinds = len({state["class"] for state in states})
        return [f"{seconds:.2f}", counts["milestones"], settings["far_starts"], kinds, len(states),
                len(report["barriers"]), captured, counts["energy_evaluations"]]


def slope(points):
    xs, ys = [math.log(x) for x, _ in points], [math.log(y) for _, y in points]
    mean = sum(xs) / len(xs), sum(ys) / len(ys)
    over = sum((x - mean[0]) * (y - mean[1]) for x, y in zip(xs, ys))
    return over / sum((x - mean[0]) ** 2 for x in xs)


def draw(table):
    """Processor time over size, both logarithmic, a line a family; an SVG without any library."""
    looks = {"magnets a face": ("#0072B2", ""), "corners": ("#D55E00", "8 4"), "faces": ("#009E73", "2 3")}
    rows = [row for row in csv.DictReader(table.open()) if row["processor_s"]]
    left, top, width, height = 70, 60, 620, 400
    times = [float(row["processor_s"]) for row in rows]
    # Marks at 1, 2 and 5 of each decade, from the last below to the first above all times.
    marks = [digit * 10.0**power for power in range(-2, 6) for digit in (1, 2, 5)]
    low = max(mark for mark in marks if mark <= min(times))
    high = min(mark for mark in marks if mark >= max(times))

    def at(size, seconds):
        x = left + width * math.log2(size) / 8
        return x, top + height * math.log(high / seconds) / math.log(high / low)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{left + width + 30}" height="{top + height + 60}" '
           'font-family="sans-serif" font-size="14"><rect width="100%" height="100%" fill="white"/>',
           f'<text x="{left}" y="22" font-size="17">Processor time of an analysis without proofs (s)</text>',
           f'<text x="{left}" y="44" fill="#555555">hollow: more than 16,384 pairs of magnets, '
           'fewer milestones and starts asked for</text>']
    for mark in marks:
        if low <= mark <= high:
            y = at(1, mark)[1]
            out.append(f'<path d="M{left} {y:.1f}h{width}" stroke="#dddddd"/>')
            out.append(f'<text x="{left - 8}" y="{y + 5:.1f}" text-anchor="end">{mark:g}</text>')
    for power in range(9):
        x = at(2**power, low)[0]
        out.append(f'<path d="M{x:.1f} {top + height}v5" stroke="#555555"/>')
        out.append(f'<text x="{x:.1f}" y="{top + height + 20}" text-anchor="middle">{2**power}</text>')
    out.append(f'<text x="{left + width / 2}" y="{top + height + 45}" text-anchor="middle">'
               "magnets a face, corners of the meeting faces, or faces with four magnets</text>")
    legend = []
    for line, (family, (colour, dashes)) in enumerate(looks.items()):
        def of(asked):
            return [(int(row["size"]), float(row["processor_s"])) for row in rows
                    if row["family"] == family and row["asked"] == asked]

        usual, less = of("usual"), of("less")
        if not usual:
            continue
        dashed = f' stroke-dasharray="{dashes}"' if dashes else ""
        style = f'stroke="{colour}" stroke-width="2"{dashed} fill="none"'
        for points in (usual, less):
            places = [at(*point) for point in points]
            path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
            if len(places) > 1:
                out.append(f'<polyline points="{path}" {style}/>')
            fill = colour if points is usual else "white"
            out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{fill}" stroke="{colour}" stroke-width="2"/>'
                    for x, y in places]
        said = family
        if len(usual) > 1:
            said += f": slope {slope(usual):.2f}, of the last two {slope(usual[-2:]):.2f}"
        y = top + 20 + 22 * line
        legend.append(f'<path d="M{left + 12} {y - 5}h32" {style}/><text x="{left + 52}" y="{y}">{said}</text>')
    behind = f'<rect x="{left + 4}" y="{top + 2}" width="340" height="{22 * len(legend) + 6}" fill="white"/>'
    table.with_suffix(".svg").write_text("\n".join([*out, behind, *legend, "</svg>\n"]))


def main():
    arguments = sys.argv[1:]

    def option(name, default):
        if name not in arguments:
            return default
        at = arguments.index(name)
        value = arguments[at + 1]
        del arguments[at : at + 2]
        return value

    limit = float(option("--limit", "3600"))
    model, only = option("--model", "dipole"), option("--only", "")
    if arguments[:1] == ["--draw"] and len(arguments) == 2:
        return draw(Path(arguments[1]))
    if arguments[:1] == ["--design"] and len(arguments) == 3:
        name = next(name for name in FAMILIES if name.startswith(arguments[1]))
        return print(FAMILIES[name][1](int(arguments[2])), end="")
    if len(arguments) != 2:
        sys.exit(__doc__)
    program, table = Path(arguments[0]).resolve(), Path(arguments[1])
    with table.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for family, (sizes, make, pairs) in FAMILIES.items():
            if not family.startswith(only):
                continue
            late = set()
            for size in sizes:
                many = pairs(size) > MANY_PAIRS
                for asked, options in [("less", []), ("usual", USUAL)] if many else [("usual", [])]:
                    found = [""] * (len(COLUMNS) - 4)
                    if asked not in late:
                        text = make(size).replace('model = "dipole"', f'model = "{model}"')
                        found = measure(program, text, limit, options)
                    if found[0] == "":
                        late.add(asked)
                    row = [family, size, pairs(size), asked, *found]
                    writer.writerow(row)
                    file.flush()
                    print(*row, file=sys.stderr)
    return draw(table)


if __name__ == "__main__":
    main()
