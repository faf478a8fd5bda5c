"""Pages of sets of words: a map of all faces against all, the tiles of the meeting chosen."""

import subprocess

from looking import text
from tables import check_table_page


def check_words(check, program, folder):
    def use(browser):
        ink = ("((c) => c.getContext('2d').getImageData(0, 0, c.width, c.height).data"
               ".filter((v, k) => k % 4 === 3 && v).length)")
        for canvas in ["meeting-map", "meeting-tiles"]:
            check.that(browser.run(f"{ink}(document.getElementById('{canvas}'))") > 1000, f"#{canvas} shows something")
        first = text(browser, "meeting-readout")
        click = ("(() => { const c = document.getElementById('meeting-map'), b = c.getBoundingClientRect(),"
                 " g = meetingGrid(c.clientWidth); c.dispatchEvent(new MouseEvent('click', {bubbles: true,"
                 " clientX: b.left + g.left + 0.5 * g.cell, clientY: b.top + g.left + 2.5 * g.cell})); })()")
        check.changes(["meeting-map", "meeting-tiles"], click, "a click on a cell")
        check.that("C on A" in text(browser, "meeting-readout") != first, "the meeting is told")
        arrow = ("document.getElementById('meeting-map').dispatchEvent("
                 "new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true}))")
        check.changes(["meeting-map"], arrow, "an arrow key")
        check.that("C on B" in text(browser, "meeting-readout"), "the next meeting is told")

    out = folder / "words"
    subprocess.run([program, "words", "--length", "6", "--gap", "0.3", "--out", out, "--quiet"], check=True)
    check_table_page(check, "words", out / "report.html", use)
    judged = folder / "crosstalk"
    subprocess.run([program, "crosstalk", out / "words.toml", "--out", judged, "--quiet"], check=True)
    check_table_page(check, "crosstalk", judged / "report.html", use)
