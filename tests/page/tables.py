"""Pages of tables, pictures and charts: of compare and of sweep."""

import pathlib
import subprocess

from looking import check_first_look, check_hints, check_links, check_other_looks

SHAPES = pathlib.Path(__file__).resolve().parents[2] / "shapes"


def check_table_page(check, name, file, use):
    """A page of tables and pictures: `use` tries its specific functions."""
    browser = check.browser
    check_first_look(check, name, file)
    if use:
        use(browser)
    check_links(check, file)
    check_hints(check, name, file)
    check_other_looks(check, name, file)


def column(k, table=0):
    """The cells of a table's column, and a click on its head."""
    of = f"document.querySelectorAll('#tables table')[{table}]"
    return f"[...{of}.tBodies[0].rows].map((r) => r.cells[{k}].textContent)", f"{of}.tHead.rows[0].cells[{k}].querySelector('button').click()"


def check_comparison(check, program, folder):
    out = folder / "compare"
    designs = [SHAPES / f"{name}.toml" for name in ("dovetail", "tab-20mm", "tab-10mm", "square-teeth-10mm")]
    subprocess.run([program, "compare", *designs, "--out", out, "--quiet", "--milestones", "600",
                    "--far-starts", "30", "--certify-cells", "5000"], check=True)

    def use(browser):
        browser.wait("document.querySelector('#pictures svg').getBoundingClientRect().width > 300")
        names, click = column(1)
        browser.run(click)
        check.that(browser.run(names) == sorted(browser.run(names)), "designs sort by name")
        depths, click = column(2)
        browser.run(click)
        upwards = browser.run(depths)
        browser.run(click)
        head = browser.run("document.querySelector('#tables table').tHead.rows[0].cells[1].textContent")
        check.that(browser.run(depths) == upwards[::-1] and head == "bond (mJ)", f"designs sort by their bond ({head})")
        cards = browser.run("[...document.querySelectorAll('#facts .value')].map((card) => card.textContent)")
        check.that(cards[2:] == ["undecided"] * 2, f"no card claims an order that is undecided ({cards})")
        check.that(browser.run(column(0, 2)[0])[:1] == ["unbinding barrier"], "the certified order is told")
        check.that("not head-on" in browser.run("document.querySelector('#tables table').textContent"),
                   "what has no capture range says why")

    check_table_page(check, "compare", out / "report.html", use)


def check_sweep(check, program, folder):
    quick = ["--quiet", "--milestones", "500", "--far-starts", "20", "--certify-cells", "1000", "--complete-cells", "0"]
    depth = "fixed.faces.east.profile.depth="
    design = SHAPES / "tab-20mm.toml"

    def hover(browser, spot):
        """The text for a spot of a picture, and the row that is marked while the pointer is there."""
        return browser.run(f"(() => {{ const s = {spot}; s.dispatchEvent(new PointerEvent('pointerenter'));"
                           " const here = document.querySelector('#tables tr.chosen');"
                           " const told = [document.querySelector('#point .readout')?.textContent ?? '', s.textContent.trim(),"
                           " here ? [...here.parentNode.rows].indexOf(here) : null];"
                           " s.dispatchEvent(new PointerEvent('pointerleave')); return told; })()")

    def picture(browser):
        browser.settled()
        return browser.run("document.querySelector('#charts .panels canvas').toDataURL()")

    out = folder / "curves"
    subprocess.run([program, "sweep", design, SHAPES / "arc-20mm.toml", "--vary", depth + "0,0.01,0.02,0.06",
                    "--vary", "potential.model=dipole,cuboid", "--out", out, *quick], check=True)

    def curves(browser):
        check.that(browser.run("document.querySelectorAll('#pictures svg.wide').length") == 2, "a picture of curves a model")
        check.that(browser.run("document.querySelectorAll('#charts .panels').length") == 1, "and one to choose")
        before = picture(browser)
        # The first design's bond at the second depth.
        dot = browser.run("[2, charts.points[2].readout]")
        row = "document.querySelectorAll('#tables table')[0].tBodies[0].rows[%d]" % dot[0]
        marked = "document.querySelectorAll('#pictures [data-point].chosen').length"
        browser.run(f"{row}.dispatchEvent(new PointerEvent('pointerenter'))")
        check.that(picture(browser) != before and browser.run(marked) > 3, "a row of the table is shown among the curves")
        browser.run(f"{row}.dispatchEvent(new PointerEvent('pointerleave'))")
        check.that(browser.run(marked) == 0, "and no more")
        count = browser.run("charts.points.length")
        told = [hover(browser, f"document.querySelector('#pictures [data-point=\"{k}\"]')") for k in range(count)]
        check.that(told[dot[0]][0] == dot[1] and [row for _, _, row in told] == list(range(count)),
                   "a point under the pointer tells its values and its row")
        name = browser.run("charts.points[2].name")
        check.that(told[2][1].startswith(f"{name}: ") and "mJ" in told[2][1], f"a title tells them, too ({told[2][1]})")
        check_chosen(browser, dot)

    def check_chosen(browser, dot):
        """Points that are chosen, pinned and compared with another one."""
        row = f"document.querySelectorAll('#tables table')[0].tBodies[0].rows[{dot[0]}]"
        browser.run(f"{row}.click()")
        browser.run("document.querySelector('#charts .panels canvas').dispatchEvent(new PointerEvent('pointerleave'))")
        browser.settled()
        card = browser.run("document.querySelector('#point').textContent")
        check.that(dot[1] in card and "tilebind analyse designs/" in card, f"a click keeps a point ({card})")
        design = browser.run("document.querySelector('#point code').textContent.split(' ')[2]")
        check.that((out / design).is_file(), f"the point's design is there ({design})")
        ink = ("((c) => c.getContext('2d').getImageData(0, 0, c.width, c.height).data.filter((v, k) => k % 4 === 3 && v).length)")
        check.that(browser.run(f"{ink}({row}.cells[0].firstChild)") > 100, "a row shows its tiles")
        check.that(browser.run(f"{ink}(document.querySelector('#point canvas'))") > 100, "the point shows its tiles")
        change = "document.getElementById('%s').value = %d; document.getElementById('%s').dispatchEvent(new Event('change'))"
        before = picture(browser)
        browser.run(change % ("baseline", dot[0] + 1, "baseline"))
        check.that(picture(browser) != before, "curves are set against a point")
        browser.run(change % ("baseline", 0, "baseline"))
        check.that(picture(browser) == before, "and no more")
        button = "document.querySelector('#charts .panels button')"
        word = browser.run(f"{button}.textContent")
        browser.run(f"{button}.click()")
        check.that(browser.run(f"{button}.textContent") != word and picture(browser) != before, "a panel changes its scale")
        browser.run(f"{button}.click()")
        last = "[...document.querySelectorAll('#charts .panels')].at(-1).querySelector('canvas').toDataURL()"
        before = browser.run(last)
        browser.run(change % ("across", 3, "across"))
        browser.settled()
        check.that(browser.run(last) != before, "what stands to the right can be chosen")

    check_table_page(check, "sweep-curves", out / "report.html", curves)

    out = folder / "maps"
    subprocess.run([program, "sweep", design, "--vary", depth + "0:0.04:4", "--vary",
                    "fixed.faces.east.profile.width=0.05:0.4:3", "--out", out, *quick], check=True)

    def maps(browser):
        before = picture(browser)
        spot = "document.querySelector('#pictures [data-point=\"%d\"]')"
        text, title, row = hover(browser, spot % 0)
        check.that(all("depth = 0 mm, width = 50 mm" in it for it in (text, title)) and row == 0,
                   f"the map's lowest left cell ({text}, {title}, {row})")
        last = browser.run("charts.points.findIndex(({ name }) => name === 'depth = 40 mm, width = 50 mm')")
        text, title, _ = hover(browser, spot % last)
        reason = "depth = 40 mm, width = 50 mm: a magnet of face east sticks out"
        check.that(reason in text and reason in title, f"an impossible point's reason ({text}, {title})")
        browser.run(f"{spot % 0}.dispatchEvent(new PointerEvent('pointerenter'))")
        check.that(browser.run(f"{spot % 0}.classList.contains('chosen')"), "the cell under the pointer is marked")
        browser.run(f"{spot % 0}.dispatchEvent(new PointerEvent('pointerleave'))")
        check.that(picture(browser) == before, "and no more")

    check_table_page(check, "sweep-maps", out / "report.html", maps)
