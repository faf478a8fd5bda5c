"""The pages of commands that have nothing but tables and pictures."""

import subprocess

from tables import SHAPES, check_table_page

TILE, ONE = SHAPES / "paper-tile.toml", SHAPES / "one-face.toml"
DISTANCES = SHAPES.parent / "tests" / "fuzz" / "cases" / "table" / "distances.csv"
COMMANDS = {
    "match": ["match", SHAPES / "tab-20mm.toml", "--quiet"],
    "bond": ["bond", SHAPES / "tab-20mm.toml", "--kt", "2e-3", "--coverage", "0.3", "--quiet"],
    "rates": ["rates", ONE, "--kt", "8e-3", "--traps", "1", "--quiet"],
    "exit": ["rates", ONE, "--kt", "8e-3", "--start", "0.43,-0.04,0", "--quiet"],
    "yield": ["yield", ONE, "--tiles", "4", "--time", "10", "--kt", "2e-3,3e-3", "--runs", "8", "--simulations", "0", "--quiet"],
    "assemble": ["assemble", "lattice", "--lattice", "3x3", "--kt", "7e-3", "--coverage", "0.1", "--quiet"],
    "calibrate": ["calibrate", TILE, "--bonds", DISTANCES, "--quiet"],
    "show": ["show", TILE],
    "make": ["make", TILE, "--kerf", "0.0002"],
    "energy": ["energy", TILE, "--pose", "0.43,0,0", "--pose", "0.45,0.01,0.1", "--pose", "0.9,0,0"],
    "barrier": ["barrier", TILE, "--from", "0.43,-0.04,0", "--to", "0.43,0,0"],
}


def check_others(check, program, folder):
    for name, command in COMMANDS.items():
        print(f"tests/page: {name}")
        out = folder / name
        subprocess.run([program, *command, "--out", out], check=True, stdout=subprocess.DEVNULL)
        check_table_page(check, name, out / "report.html", None)
