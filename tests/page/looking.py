"""Checks for every page."""

LAPTOP, PHONE = (1440, 900), (390, 844)
WIDE, NARROW = (1400, 900), (400, 900)
LARGEST = 1_000_000  # bytes


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


def check_first_look(check, name, file):
    """Opens a page: it is small."""
    check.that(file.stat().st_size < LARGEST, f"{name}: {file.stat().st_size} bytes are under {LARGEST}")
    check.browser.events.clear()
    check.browser.open(file.as_uri(), LAPTOP)
    check.keep(f"{name}-laptop", whole=True)


def check_other_looks(check, name, file):
    """A page in the dark and on a phone; no message has appeared on the console since it was opened."""
    browser = check.browser
    browser.open(file.as_uri(), LAPTOP, dark=True)
    check.keep(f"{name}-dark", whole=True)
    browser.open(file.as_uri(), PHONE, touch=True)
    check.keep(f"{name}-phone", whole=True)
    check.that(browser.run("document.documentElement.scrollWidth <= 390"), f"{name}: the page fits a phone's width")
    for complaint in browser.complaints():
        check.that(False, complaint)


def check_links(check, file):
    """Every link leads to a file beside the page, and the command line and the citation are there."""
    browser = check.browser
    links = browser.run("[...document.querySelectorAll('#files a')].map((a) => a.getAttribute('href'))")
    check.that(len(links) > 1, f"the page links to files ({links})")
    for link in links:
        check.that((file.parent / link).is_file(), f"the link {link} leads to a file")
    check.that(text(browser, "command").startswith("tilebind "), "the command line is told")
    check.that(text(browser, "citation").startswith("@software{tilebind,"), "there is something to cite")
    check.that("selectivity" in text(browser, "glossary"), "the words are explained")


def check_hints(check, name, file):
    """At both widths, boxes that scroll indicate it, and no others do."""
    browser = check.browser
    for size in (WIDE, NARROW):
        browser.open(file.as_uri(), size)
        browser.settled()
        boxes = browser.run("[...document.querySelectorAll('.scroll, #tree')].filter((b) => b.offsetHeight).map((b) =>"
                            " [b.scrollWidth > b.clientWidth + 1, !b.previousElementSibling.hidden, b.tabIndex === 0])")
        check.that(all(wide == said == reached for wide, said, reached in boxes), f"{name}: hints at {size[0]} px ({boxes})")
        if size == NARROW:
            # A matrix of few words fits, and so do all tables of many tiles.
            check.that(name in ("crosstalk", "table") or any(wide for wide, _, _ in boxes), f"{name}: at {size[0]} px some table scrolls")
        check.that(browser.run("document.documentElement.scrollWidth <= innerWidth"), f"{name}: the page fits {size[0]} px")


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
