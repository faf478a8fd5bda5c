"""Pages with a landscape: of analyse and of dock."""

import time

from looking import (NARROW, WIDE, check_first_look, check_hints, check_links, check_other_looks, check_playing, point_at,
                     set_slider, text)


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
    check.that(browser.run("document.querySelectorAll('#pictures svg.wide').length") == 2, "the chances and the trajectories are shown")
    check_other_looks(check, "docking", file)


def check_colour_bar(check, name, file):
    browser = check.browser
    for size in (WIDE, NARROW):
        browser.open(file.as_uri(), size)
        labels = browser.run("JSON.parse(document.getElementById('colour-bar').dataset.labels)")
        apart = all(a[1] <= b[0] for a, b in zip(labels, labels[1:]))
        check.that(apart and len(labels) >= 3, f"{name}: labels of the colour bar at {size[0]} px ({labels})")


# Whether labels at the graph's merges touch a line or each other.
STRUCK = """(() => {
  const box = (e) => { const b = e.getBBox(); return [b.x, b.y, b.x + b.width, b.y + b.height]; };
  const meet = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
  const labels = [...document.querySelectorAll('#tree text[fill="#696969"]')].filter((e) => /J$/.test(e.textContent));
  const lines = [...document.querySelectorAll('#tree polyline')]
    .filter((e) => [16, 18, 30].includes(Number(e.getAttribute('stroke-width')))).map(box);
  // Halos and ascents make boxes a little higher than what is seen.
  const inner = (e) => { const [l, t, r, b] = box(e); return [l + 10, t + 40, r - 10, b - 40]; };
  return labels.filter((label, k) => lines.some((line) => meet(inner(label), line))
    || labels.some((other, j) => j < k && meet(inner(label), inner(other)))).map((label) => label.textContent);
})()"""


def check_choosing(check):
    """Rows and states react to clicks and keys."""
    browser = check.browser
    rows = "[...document.querySelectorAll('#tables table')[1].tBodies[0].rows].filter((r) => r.dataset.path !== undefined)"
    if browser.run(f"{rows}.length") > 1:
        browser.run(f"{rows}[1].click()")
        path = browser.run(f"{rows}[1].dataset.path")
        check.that(browser.run("document.getElementById('path').value") == path, "a click on a barrier takes its way")
        check.that(browser.run(f"{rows}[1].classList.contains('chosen')"), "the barrier's row is marked")
        # Scrolling takes its time.
        browser.wait("Math.abs(document.getElementById('landscape').getBoundingClientRect().top) < 300")
        browser.run(f"{rows}[0].focus()")
        check.that(browser.run(f"document.activeElement === {rows}[0]"), "rows can be reached by the keyboard")
        browser.run(f"{rows}[0].dispatchEvent(new KeyboardEvent('keydown', {{key: 'Enter', bubbles: true}}))")
        check.that(browser.run(f"document.getElementById('path').value === {rows}[0].dataset.path"), "Enter takes the way")
    ways = browser.run("[...document.querySelectorAll('#tables table')[2].tBodies[0].rows].map((r) => [...r.cells].map((c) => c.textContent))")
    check.that(any("least work" in way for way in ways), f"ways of least work are listed ({len(ways)})")
    check.that(all(way[3] != "\u2013" and way[4] != "\u2013" for way in ways), "work and length stand beside the barrier")
    state = "document.querySelectorAll('#tables table')[0].tBodies[0].rows[1]"
    browser.run("scrollTo({top: document.body.scrollHeight, behavior: 'instant'})")
    seen = ("(([top, bottom]) => top >= 0 && bottom <= innerHeight)((({top, bottom}) => [top, bottom])"
            "(document.getElementById('%s').getBoundingClientRect()))")
    # Out of view at first, and brought there; where it is in view, it stays.
    top = "document.getElementById('pose').getBoundingClientRect().top"
    check.that(not browser.run(seen % "pose"), "the chosen state's picture is out of view at first")
    browser.run(f"{state}.click()")
    browser.wait(seen % "pose")
    time.sleep(0.5)
    before = browser.run(top)
    browser.run("document.querySelector('#tree .leaf:not(.chosen)').dispatchEvent(new Event('click'))")
    time.sleep(0.5)
    check.that(abs(browser.run(top) - before) < 50, "what is in view stays where it is")
    for view in ("around", "inFront"):
        browser.settled()
        spot = browser.run(f"(() => {{ const v = views.{view}, s = v.spots.at(-1); if (!s) return null;"
                           " const b = v.canvas.getBoundingClientRect(); v.canvas.dispatchEvent(new MouseEvent('click',"
                           " {bubbles: true, clientX: b.left + s.at[0], clientY: b.top + s.at[1]}));"
                           " return [s.state.class, classOf(now.chosen)]; })()")
        check.that(spot is None or spot[0] == spot[1], f"a click on a state of the map {view} chooses it ({spot})")


def check_graph(check, name):
    browser = check.browser
    check.that(browser.run(STRUCK) == [], f"{name}: no label of a merge is struck through ({browser.run(STRUCK)})")
    drawn = "document.getElementById('tree').innerHTML"
    before = browser.run(drawn)
    browser.run("document.getElementById('tree-scale').click()")
    check.that(browser.run(drawn) != before, "the graph can be drawn on a linear scale")
    check.that(browser.run(STRUCK) == [], f"{name}: nor on the linear scale ({browser.run(STRUCK)})")
    browser.run("document.getElementById('tree-scale').click()")
    check.that(browser.run(drawn) == before, "and back")


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

    check_graph(check, name)
    check_choosing(check)
    check_links(check, file)
    card = browser.run("document.querySelector('#facts .value').textContent")
    both = "as blocks" in browser.run("document.querySelector('#facts .note').textContent")
    check.that(both == (card.count("/") == 1), f"{name}: the first card tells dipoles and blocks ({card})")

    column = "[...document.querySelectorAll('#tables table')[0].tBodies[0].rows].map((r) => r.cells[3].textContent)"
    click = "document.querySelectorAll('#tables table')[0].tHead.rows[0].cells[3].querySelector('button').click()"
    browser.run(click)
    upwards = browser.run(column)
    browser.run(click)
    check.that(browser.run(column) == upwards[::-1] and len(upwards) > 1, "the table of states sorts by energy")

    # The page's energies of dipoles equal those of the program's states.
    off = browser.run("!world.dipoles ? 0 : Math.max(...world.states.map("
                      "(s) => Math.abs(dipoleEnergy(s.pose) / s.energy - 1)))")
    check.that(off < 1e-4, f"the states' energies as the page computes them (off by {off})")
    # The unpacked energies are close to the computed ones, away from contact.
    off = browser.run("(() => { if (!world.dipoles) return 0; const v = views.around.volume, [t, y, x] = v.axes;"
                      " let worst = 0; for (let k = 0; k < v.positions.length; k += 997) {"
                      " const p = v.positions[k]; if (p !== p) continue;"
                      " const i = k % x.length, j = Math.floor(k / x.length) % y.length, n = Math.floor(k / x.length / y.length);"
                      " worst = Math.max(worst, Math.abs(p - positionOf(dipoleEnergy([x[i], y[j], t[n]])))); } return worst; })()")
    check.that(off < 5e-4, f"the map's energies against the formula (positions off by {off})")

    check_hints(check, name, file)
    check_colour_bar(check, name, file)
    check_other_looks(check, name, file)
    if check.pictures:
        import base64
        pdf = browser.call("Page.printToPDF", printBackground=True)["data"]
        (check.pictures / f"{name}.pdf").write_bytes(base64.b64decode(pdf))
