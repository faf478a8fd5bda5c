"""A row of `results/bench.csv`: how the benches compare with themselves, commit by commit.

    tests/bench/history.py results/bench.csv

runs `cargo bench` and appends commit, version, date, the machine in words (with the load it had at
the start) and every ratio that the benches print (`ratio NAME VALUE`). Ratios are of times taken side
by side, so that rows of different machines can be compared; names that come or go make columns with
empty places.
"""

import csv
import datetime
import os
import platform
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def git(*arguments):
    return subprocess.run(["git", *arguments], cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()


def processor():
    """Its name as the system tells it."""
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def benches():
    """The widest instructions used and the ratios, as the benches print them."""
    instructions, ratios = "", {}
    run = subprocess.Popen(["cargo", "bench"], cwd=ROOT, stdout=subprocess.PIPE, text=True)
    for line in run.stdout:
        print(line, end="", flush=True)
        words = line.split()
        if words[:1] == ["ratio"]:
            ratios[words[1]] = words[2]
        elif words[:1] == ["instructions"]:
            instructions = words[1]
    if run.wait() != 0:
        sys.exit("cargo bench failed")
    return instructions, ratios


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    table = Path(sys.argv[1])
    changed = git("status", "--porcelain", "--", "src", "tests/bench", "Cargo.toml", "Cargo.lock")
    about = {
        "commit": git("rev-parse", "--short", "HEAD") + ("+" if changed else ""),
        "version": tomllib.loads((ROOT / "Cargo.toml").read_text())["package"]["version"],
        "date": datetime.date.today().isoformat(),
        "machine": "",
        "load": f"{os.getloadavg()[0]:.1f}",
    }
    instructions, ratios = benches()
    about["machine"] = f"{processor()}, {os.cpu_count()} cores, {instructions}"
    rows = list(csv.DictReader(table.open())) if table.exists() else []
    rows.append(about | ratios)
    columns = list(dict.fromkeys(name for row in rows for name in row))
    with table.open("w", newline="") as file:
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
