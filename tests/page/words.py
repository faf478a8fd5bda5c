"""Pages of sets of words: a map of all faces against all, the tiles of the meeting chosen."""

import subprocess

from looking import text
from tables import check_table_page


def check_words(check, program, folder):
    def use(browser):
        ink = ("((c) => c.getContext('2d').getImageData(0, 0, c.width, c.height).data"
               ".filter((v, k) => k % 4 === 3 && v).length)")
        check.that(browser.run(f"{ink}(document.getElementById('meeting-tiles'))") > 1000, "#meeting-tiles shows something")
        check.that(browser.run("document.querySelectorAll('#meeting-map text').length") > 10, "#meeting-map shows something")
        first = text(browser, "meeting-readout")
        chosen = "[...document.querySelectorAll('#meeting-map .wide .chosen')].map((cell) => cell.dataset.cell).join()"
        click = "document.querySelector('#meeting-map [data-cell=\"2 0\"]').dispatchEvent(new MouseEvent('click', {bubbles: true}))"
        check.changes(["meeting-tiles"], click, "a click on a cell")
        check.that("C on A" in text(browser, "meeting-readout") != first, "the meeting is told")
        check.that(browser.run(chosen) == "2 0", "its cell is marked")
        arrow = ("document.getElementById('meeting-map').dispatchEvent("
                 "new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true}))")
        check.changes(["meeting-tiles"], arrow, "an arrow key")
        check.that("C on B" in text(browser, "meeting-readout"), "the next meeting is told")
        check.that(browser.run(chosen) == "2 1", "the next cell is marked")

    out = folder / "words"
    subprocess.run([program, "words", "--length", "6", "--gap", "0.3", "--out", out, "--quiet"], check=True)
    check_table_page(check, "words", out / "report.html", use)
    judged = folder / "crosstalk"
    subprocess.run([program, "crosstalk", out / "words.toml", "--out", judged, "--quiet"], check=True)
    check_table_page(check, "crosstalk", judged / "report.html", use)
