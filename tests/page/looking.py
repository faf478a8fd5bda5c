"""Checks for every page."""

import re

LAPTOP, PHONE = (1440, 900), (390, 844)
WIDE, NARROW = (1400, 900), (400, 900)
LARGEST = 1_000_000  # bytes
# Pages whose tables, if they have any, fit a narrow page.
FITTING = ("crosstalk", "table", "match", "barrier", "calibrate")


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
    check_words_explained(check, name)
    check_pictures(check, name, file)
    check.browser.open(file.as_uri(), LAPTOP)


# The texts of a page that can be seen, but for the glossary and for names of files, commands and citations.
SEEN = """(() => {
  const found = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const parent = walker.currentNode.parentElement;
    if (parent.closest("#glossary, #files, #reproduce, script, noscript, title")) continue;
    if (parent.closest("option") || parent.getClientRects().length) found.push(walker.currentNode.data);
  }
  return found.join("\\n");
})()"""


def check_words_explained(check, name):
    """The glossary has all terms of its table that the page uses, and no other."""
    browser = check.browser
    text = browser.run(SEEN)
    explained = browser.run("[...document.querySelectorAll('#glossary dt')].map((term) => term.textContent)")

    def is_used(form):
        return re.search(rf"(?<![\w-]){re.escape(form)}(e?s)?(?![\w-])", text, re.I if form == form.lower() else 0)

    used = [term for term in browser.run("TERMS.map(([term]) => term)") if any(map(is_used, term.split(", ")))]
    check.that(used == explained, f"{name}: {set(used) ^ set(explained)} explained though not used, or the other way round")
    expected = {"words": {"word", "mate, A*", "gap"}, "assemble": {"word", "Gse", "Gmc", "tau"}, "rates": {"Places, places"}}
    check.that(expected.get(name, {"bond"} if name == "paper-tile" else set()) <= set(explained), f"{name}: {explained}")
    check.that(("Gse" in explained) == (name == "assemble"), f"{name}: Gse is explained where it is used")


# Words of pictures that leave them, and words that lie over others.
COLLISIONS = """(() => {
  const found = [];
  for (const svg of document.querySelectorAll("svg")) {
    const box = svg.getBoundingClientRect();
    const words = [...svg.querySelectorAll("text")].filter((e) => e.textContent.trim());
    const boxes = words.map((e) => [e.textContent.trim(), e.getBoundingClientRect()]);
    for (const [text, b] of box.width ? boxes : []) {
      if (b.left < box.left - 2 || b.right > box.right + 2 || b.top < box.top - 2 || b.bottom > box.bottom + 2) found.push(text);
    }
    boxes.forEach(([text, a], k) => boxes.slice(0, k).forEach(([other, b]) => {
      const [across, down] = [[a.left, a.right, b.left, b.right], [a.top, a.bottom, b.top, b.bottom]]
        .map(([low, high, l, h]) => Math.min(high, h) - Math.max(low, l));
      // Halos are the same words once more.
      if (across > 2 && down > 5 && !(text === other && Math.abs(a.left - b.left) < 0.2)) found.push([text, other]);
    }));
  }
  return found;
})()"""


def check_pictures(check, name, file):
    """On a phone and on a wide page nothing leaves the page, and no words of a picture are cut off or overlap."""
    for size in (NARROW, (1200, 900)):
        check.browser.open(file.as_uri(), size)
        check.browser.settled()
        widths = check.browser.run("[document.documentElement.scrollWidth, innerWidth]")
        check.that(widths[0] <= widths[1], f"{name}: the page is {widths[0]} px wide at {size[0]} px")
        bad = check.browser.run(COLLISIONS)
        check.that(not bad, f"{name}: words of pictures are cut off or overlap at {size[0]} px: {bad}")
        inner = check.browser.run("[...document.querySelectorAll('#pictures svg, #meeting-map svg')].filter((e) =>"
                                  " e.getBoundingClientRect().right > innerWidth).length")
        check.that(inner == 0, f"{name}: {inner} pictures are cut off at {size[0]} px")


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
    check.that(links, "the page links to files")
    for link in links:
        check.that((file.parent / link).is_file(), f"the link {link} leads to a file")
    check.that(text(browser, "command").startswith("tilebind "), "the command line is told")
    check.that(text(browser, "citation").startswith("@software{tilebind,"), "there is something to cite")


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
            check.that(name in FITTING or any(wide for wide, _, _ in boxes), f"{name}: at {size[0]} px some table scrolls")
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
