"""The page of many tiles on one table: moments that play."""

import subprocess

from looking import set_slider, text
from tables import SHAPES, check_table_page


def check_crowd(check, program, folder):
    def use(browser):
        frames = browser.run("crowd.frames.length")
        check.that(frames > 50, f"moments are there ({frames})")
        check.that(browser.run("moment.frame") == frames - 1, "the last is shown first")
        last = browser.run("((f) => [f.bonds.length, f.traps.length])(crowd.frames.at(-1))")
        told = text(browser, "crowd-here")
        check.that(f"{last[0]} bonds, {last[1]} traps" in told, f"what is held is told ({told})")
        check.changes(["crowd-tiles"], set_slider("crowd-step", 3), "the moment")
        check.that(browser.run("moment.frame") == 3, "the slider chooses a moment")
        check.changes(["crowd-tiles"], "document.getElementById('crowd-play').click();"
                      "new Promise((done) => setTimeout(done, 400))", "playing")
        check.that(browser.run("moment.frame") > 3, "playing goes on")
        browser.run("if (moment.playing) document.getElementById('crowd-play').click()")
        check.that(text(browser, "crowd-play") == "Play", "and stops")
        browser.run(set_slider("crowd-step", frames - 1))

    out = folder / "crowd"
    subprocess.run([program, "table", SHAPES / "paper-tile.toml", "--count", "3,3", "--time", "8", "--runs", "2", "--shaking",
                    "3e-3", "--drag", "0.5", "--out", out, "--quiet"], check=True)
    check_table_page(check, "table", out / "report.html", use)
