#!/usr/bin/env python3
"""Opens the pages of analyse, compare and sweep in headless Chromium and uses them.

    check.py PROGRAM [--pictures FOLDER]

PROGRAM is the built tilebind. Where there is no Chromium, Debian's is installed if that can be
done; where it cannot, the check is left out and says so. Exit status 0 where all holds.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from browser import Browser

SHAPES = pathlib.Path(__file__).resolve().parents[2] / "shapes"
LAPTOP, PHONE = (1440, 900), (390, 844)
LARGEST = 1_000_000  # bytes


def chromium():
    """The browser's program, installed if need be; None where there is none."""
    names = ["chromium", "chromium-browser", "google-chrome"]
    found = next(filter(None, map(shutil.which, names)), None)
    if found or os.geteuid() != 0 or not shutil.which("apt-get"):
        return found
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    for command in (["apt-get", "update"], ["apt-get", "install", "-y", "--no-install-recommends", "chromium"]):
        subprocess.run(command, env={**os.environ, "DEBIAN_FRONTEND": "noninteractive"}, check=False, **quiet)
    return shutil.which("chromium")


class Check:
    def __init__(self, browser, pictures):
        self.browser, self.pictures, self.failures = browser, pictures, []

    def that(self, holds, what):
        if not holds:
            self.failures.append(what)
            print(f"  FAILS: {what}")

    def changes(self, canvases, action, what):
        """That an action changes the pictures on all these canvases."""
        before = [self.browser.picture(canvas) for canvas in canvases]
        self.browser.run(action)
        after = [self.browser.picture(canvas) for canvas in canvases]
        for canvas, a, b in zip(canvases, before, after):
            self.that(a != b, f"{what} changes #{canvas}")

    def keep(self, name, whole=False):
        if self.pictures:
            (self.pictures / f"{name}.png").write_bytes(self.browser.screenshot(whole))


def set_slider(name, value):
    return (f"(() => {{ const s = document.getElementById('{name}'); s.value = {value};"
            " s.dispatchEvent(new Event('input', {bubbles: true})); })()")


def point_at(canvas, u, v):
    """A pointer over a canvas, at fractions of its width and height."""
    return (f"(() => {{ const c = document.getElementById('{canvas}'), b = c.getBoundingClientRect();"
            f" c.dispatchEvent(new PointerEvent('pointermove', {{bubbles: true,"
            f" clientX: b.left + {u} * b.width, clientY: b.top + {v} * b.height}})); }})()")


def text(browser, name):
    return browser.run(f"document.getElementById('{name}').textContent")


def check_playing(check):
    browser = check.browser
    browser.run(set_slider("step", 0))
    before = browser.picture("tiles")
    browser.run("document.getElementById('play').click()")
    browser.wait("Number(document.getElementById('step').value) > 0.05")
    browser.run("document.getElementById('play').click()")
    check.that(browser.picture("tiles") != before, "playing moves the tiles")
    at = browser.run("Number(document.getElementById('step').value)")
    browser.settled()
    check.that(at == browser.run("Number(document.getElementById('step').value)"), "pause stops it")


def check_first_look(check, name, file):
    """Opens a page: it is small."""
    check.that(file.stat().st_size < LARGEST, f"{name}: {file.stat().st_size} bytes are under {LARGEST}")
    check.browser.events.clear()
    check.browser.open(file.as_uri(), LAPTOP)
    check.keep(f"{name}-laptop", whole=True)


def check_other_looks(check, name, file):
    """A page in the dark and on a phone; nothing was complained of since its first look."""
    browser = check.browser
    browser.open(file.as_uri(), LAPTOP, dark=True)
    check.keep(f"{name}-dark", whole=True)
    browser.open(file.as_uri(), PHONE, touch=True)
    check.keep(f"{name}-phone", whole=True)
    check.that(browser.run("document.documentElement.scrollWidth <= 390"), f"{name}: the page fits a phone's width")
    for complaint in browser.complaints():
        check.that(False, complaint)


def check_docking(check, file):
    """The page of docking runs, which plays trajectories in time."""
    browser = check.browser
    check_first_look(check, "docking", file)
    check.that(not browser.run("document.getElementById('merging').offsetHeight"), "no empty disconnectivity graph is shown")
    check.that(browser.run("world.pathways.length") >= 4, "several trajectories can be chosen")
    check.changes(["around", "tiles", "profile"], set_slider("step", 0.9), "the place on the trajectory")
    check.that(" s, U = " in text(browser, "here") and "kinetic" in text(browser, "here"), "time and kinetic energy are told")
    last = "world.pathways[0].points.at(-1)"
    browser.run(set_slider("step", 1))
    check.that(browser.run(f"Math.abs(now.place.s - {last}[0]) < 1e-9"), "the slider's end is the trajectory's")
    # Half the slider is half the time.
    browser.run(set_slider("step", 0.5))
    check.that(browser.run(f"Math.abs(now.place.s - 0.5 * {last}[0]) < 1e-6"), "a trajectory is played evenly in time")
    check.changes(["around", "tiles", "profile"], "(() => { const p = document.getElementById('path'); p.value = 3;"
                  " p.dispatchEvent(new Event('change')); })()", "another trajectory")
    check_playing(check)
    check.that(browser.run("document.querySelectorAll('#pictures img').length") == 2, "the chances and the trajectories are shown")
    check_other_looks(check, "docking", file)


def check_page(check, name, file):
    browser = check.browser
    check_first_look(check, name, file)

    check.changes(["around"], set_slider("theta", 3), "the slider over theta")
    check.changes(["in-front"], set_slider("gap", 12), "the slider over the gap")
    check.changes(["around", "tiles", "profile", "in-front"], set_slider("step", 0.97), "the place on the path")
    check.changes(["around"], point_at("around", 0.93, 0.12), "the pointer")
    check.that("J" in text(browser, "around-readout"), "the energy under the pointer is told")
    browser.run(point_at("in-front", 0.55, 0.4))
    check.that("gap" not in text(browser, "in-front-readout") and "slide" in text(browser, "in-front-readout"),
               "the map in front of the face tells slide and tilt")

    check_playing(check)

    leaves = browser.run("document.querySelectorAll('#tree .leaf').length")
    check.that(leaves >= 2, "the disconnectivity graph has states")
    check.changes(["pose"], "document.querySelectorAll('#tree .leaf:not(.chosen)')[0].dispatchEvent(new Event('click'))",
                  "a click on a state")

    column = "[...document.querySelectorAll('#tables table')[0].tBodies[0].rows].map((r) => r.cells[3].textContent)"
    click = "document.querySelectorAll('#tables table')[0].tHead.rows[0].cells[3].querySelector('button').click()"
    browser.run(click)
    upwards = browser.run(column)
    browser.run(click)
    check.that(browser.run(column) == upwards[::-1] and len(upwards) > 1, "the table of states sorts by energy")

    # What the page computes of dipoles is what the program says of the states.
    off = browser.run("!world.dipoles ? 0 : Math.max(...world.states.map("
                      "(s) => Math.abs(dipoleEnergy(s.pose) / s.energy - 1)))")
    check.that(off < 1e-4, f"the states' energies as the page computes them (off by {off})")
    # And what it unpacks is near what it computes, away from contact.
    off = browser.run("(() => { if (!world.dipoles) return 0; const v = views.around.volume, [t, y, x] = v.axes;"
                      " let worst = 0; for (let k = 0; k < v.positions.length; k += 997) {"
                      " const p = v.positions[k]; if (p !== p) continue;"
                      " const i = k % x.length, j = Math.floor(k / x.length) % y.length, n = Math.floor(k / x.length / y.length);"
                      " worst = Math.max(worst, Math.abs(p - positionOf(dipoleEnergy([x[i], y[j], t[n]])))); } return worst; })()")
    check.that(off < 5e-4, f"the map's energies against the formula (positions off by {off})")

    check_other_looks(check, name, file)
    if check.pictures:
        import base64
        pdf = browser.call("Page.printToPDF", printBackground=True)["data"]
        (check.pictures / f"{name}.pdf").write_bytes(base64.b64decode(pdf))


def check_table_page(check, name, file, use):
    """A page of tables and pictures: `use` tries what is its own."""
    browser = check.browser
    check_first_look(check, name, file)
    use(browser)
    check_other_looks(check, name, file)


def column(k, table=0):
    """The cells of a table's column, and a click on its head."""
    of = f"document.querySelectorAll('#tables table')[{table}]"
    return f"[...{of}.tBodies[0].rows].map((r) => r.cells[{k}].textContent)", f"{of}.tHead.rows[0].cells[{k}].querySelector('button').click()"


def check_comparison(check, program, folder):
    out = folder / "compare"
    designs = [SHAPES / f"{name}.toml" for name in ("dovetail", "tab-20mm", "tab-10mm", "square-teeth-10mm")]
    subprocess.run([program, "compare", *designs, "--out", out, "--quiet", "--milestones", "2000",
                    "--far-starts", "100", "--certify-cells", "20000"], check=True)

    def use(browser):
        image = "document.querySelector('#pictures img')"
        browser.wait(f"{image}.complete && {image}.naturalWidth > 0")
        names, click = column(1)
        browser.run(click)
        check.that(browser.run(names) == sorted(browser.run(names)), "designs sort by name")
        depths, click = column(2)
        browser.run(click)
        upwards = browser.run(depths)
        browser.run(click)
        check.that(browser.run(depths) == upwards[::-1] and "mJ" in upwards[0], "designs sort by their bond")
        check.that(browser.run(column(0, 1)[0])[:1] == ["unbinding barrier"], "the certified order is told")
        check.that("not head-on" in browser.run("document.querySelector('#tables table').textContent"),
                   "what has no capture range says why")

    check_table_page(check, "compare", out / "report.html", use)


def check_sweep(check, program, folder):
    quick = ["--quiet", "--milestones", "500", "--far-starts", "20", "--certify-cells", "1000"]
    depth = "fixed.faces.east.profile.depth="
    design = SHAPES / "tab-20mm.toml"

    def hover(browser, canvas, u, v):
        return browser.run(f"(() => {{ const c = document.querySelectorAll('#charts .panels canvas')[{canvas}],"
                           f" b = c.getBoundingClientRect(); c.dispatchEvent(new PointerEvent('pointermove',"
                           f" {{bubbles: true, clientX: b.left + {u} * b.width, clientY: b.top + {v} * b.height}}));"
                           " const here = document.querySelector('#tables tr.chosen');"
                           " return [document.querySelector('#charts .readout').textContent,"
                           " here ? [...here.parentNode.rows].indexOf(here) : null]; })()")

    def picture(browser):
        browser.settled()
        return browser.run("document.querySelectorAll('#charts .panels canvas')[1].toDataURL()")

    out = folder / "curves"
    subprocess.run([program, "sweep", design, SHAPES / "arc-20mm.toml", "--vary", depth + "0,0.01,0.02,0.06",
                    "--vary", "potential.model=dipole,cuboid", "--out", out, *quick], check=True)

    def curves(browser):
        check.that(browser.run("document.querySelectorAll('#charts .panels').length") == 2, "a group of curves a model")
        before = picture(browser)
        # The first design's bond at the first depth: the dot nearest to the curve's beginning.
        dot = browser.run("(() => { const c = document.querySelector('#charts .panels canvas'),"
                          " g = charts.curves[0], p = g.series[0].points[1][1];"
                          " return [p, charts.points[p].readout]; })()")
        row = "document.querySelectorAll('#tables table')[0].tBodies[0].rows[%d]" % dot[0]
        browser.run(f"{row}.dispatchEvent(new PointerEvent('pointerenter'))")
        check.that(picture(browser) != before, "a row of the table is shown among the curves")
        browser.run(f"{row}.dispatchEvent(new PointerEvent('pointerleave'))")
        told = [hover(browser, 0, u / 50, v / 50) for u in range(50) for v in range(0, 50, 3)]
        seen = {text: place for text, place in told if place is not None}
        check.that(dot[1] in seen and seen[dot[1]] == dot[0], "a point under the pointer tells its values and its row")
        check.that(len(seen) > 3, "points can be pointed at")

    check_table_page(check, "sweep-curves", out / "report.html", curves)

    out = folder / "maps"
    subprocess.run([program, "sweep", design, "--vary", depth + "0:0.04:4", "--vary",
                    "fixed.faces.east.profile.width=0.05:0.4:3", "--out", out, *quick], check=True)

    def maps(browser):
        before = picture(browser)
        text, row = hover(browser, 1, 0.25, 0.8)
        check.that("depth = 0, width = 0.05" in text and row == 0, f"the map's lowest left cell ({text}, {row})")
        text, row = hover(browser, 1, 0.85, 0.8)
        check.that("depth = 0.04, width = 0.05: a magnet of face east sticks out" in text, f"an impossible point's reason ({text})")
        check.that(picture(browser) != before, "the cell under the pointer is marked")

    check_table_page(check, "sweep-maps", out / "report.html", maps)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--pictures", type=pathlib.Path, help="keep screenshots here")
    parser.add_argument("--designs", nargs="*", default=["paper-tile", "triangle-teeth-10mm", "dovetail"])
    arguments = parser.parse_args()
    program = chromium()
    if program is None:
        print("tests/page: left out, there is no Chromium and it cannot be installed here")
        return 0
    if arguments.pictures:
        arguments.pictures.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        browser = Browser(program)
        check = Check(browser, arguments.pictures)
        try:
            for name in arguments.designs:
                print(f"tests/page: {name}")
                out = pathlib.Path(folder, name)
                subprocess.run([arguments.program, "analyse", SHAPES / f"{name}.toml", "--out", out, "--quiet",
                                "--certify-seconds", "2", "--milestones", "3000"], check=True)
                check_page(check, name, out / "report.html")
            print("tests/page: compare, sweep")
            check_comparison(check, arguments.program, pathlib.Path(folder))
            check_sweep(check, arguments.program, pathlib.Path(folder))
            print("tests/page: docking")
            out = pathlib.Path(folder, "docking")
            subprocess.run([arguments.program, "dock", SHAPES / "paper-tile.toml", "--engine", "--runs", "200",
                            "--out", out, "--quiet"], check=True)
            check_docking(check, out / "report.html")
        finally:
            browser.close()
    print(f"tests/page: {len(check.failures)} failures" if check.failures else "tests/page: all holds")
    return 1 if check.failures else 0


if __name__ == "__main__":
    sys.exit(main())
