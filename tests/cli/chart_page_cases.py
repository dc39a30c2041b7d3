"""The page of burnish chart in a real browser."""

import json

from browser import Browser
from chart_cases import TINY, needs_embree, rows_of
from harness import case, check

POINTS = "[...document.querySelectorAll('.place:not([hidden]) svg.chart')].find(s => s.getClientRects().length).querySelectorAll('.point[data-row]')"


def make_page(bench):
    needs_embree(bench)
    with_browser = Browser(bench.folder / "browser")  # skips before rendering
    words = ("chart", *TINY, "--techniques", "bent_normal,major_axis", "--sweep", "samples=1,4,16", "--sweep", "roughness=0.2,0.6",
             "--sweep", "anisotropy=0,0.8", "-o", "r")
    bench.run(*words).expect(0)
    # Pages are judged at fixed times instead of measured ones, since coinciding points hide each other.
    kept = bench.folder / "r/rows.json"
    content = json.loads(kept.read_text())
    for index, row in enumerate(sorted(content["rows"].values(), key=lambda row: row["flip_mean"])):  # the order of keys depends on the program
        row["ms"] = [1.3**index * share for share in (1.0, 1.1)]
        row["cpu_ms"] = row["ms"]
    kept.write_text(json.dumps(content))
    bench.run(*words).expect(0)
    times = [row["ms_median"] for row in rows_of(bench, "r")]
    check(len(set(times)) == 16 and min(times) > 0.9, f"the given times were not taken: {times}")
    return with_browser


def healthy(browser):
    check(not browser.faults, f"the console says {browser.faults}")
    outside = [url for url in browser.requests if not url.startswith(("file:", "data:", "about:"))]
    check(not outside, f"the page asked for {outside}")


def point(browser, index):
    """Returns the centre of a point's mark, scrolled into view, and the point's row."""
    return browser.value(f"""(() => {{ const p = {POINTS}[{index}]; p.scrollIntoView({{block: 'center'}});
        const b = p.querySelector('.mark').getBoundingClientRect();
        return {{x: b.x + b.width / 2, y: b.y + b.height / 2, row: p.dataset.row}}; }})()""")


@case("chart.page_points_answer_mouse_and_keys", tier="nightly")
def points(bench):
    with make_page(bench) as browser:
        browser.size(1200, 900)
        browser.open(bench.folder / "r/report.html")
        check(browser.value(f"{POINTS}.length") == 4, "a point a setting")
        seen = set()
        for index in range(4):
            at = point(browser, index)
            check(browser.value("tip.hidden"), "a picture before anything was pointed at")
            browser.mouse("mouseMoved", at["x"], at["y"])
            browser.until("!tip.hidden")
            shown = browser.value("tip.dataset.row")
            check(shown == at["row"], f"{at['row']} was pointed at, {shown} answers")
            browser.until("tip.querySelector('img').complete && tip.querySelector('img').naturalWidth > 0")
            same = browser.value("tip.querySelector('img').src === JSON.parse(document.getElementById('data').textContent).rows[tip.dataset.row].picture")
            says = browser.value(f"tip.textContent === [...document.querySelectorAll('.point')].find(p => p.dataset.row === '{shown}').getAttribute('aria-label')")
            check(same and says, f"the picture at {shown} is another one")
            inside = browser.value("(() => { const b = tip.getBoundingClientRect(); return b.left >= 0 && b.right <= innerWidth && b.top >= 0 && b.bottom <= innerHeight; })()")
            check(inside, "the picture leaves the window")
            seen.add(shown)
            browser.mouse("mouseMoved", 2, 2)
            browser.until("tip.hidden")
        check(len(seen) == 4, f"only {seen} answered")
        covers = browser.value("[...document.querySelectorAll('svg.chart text')].filter(t => getComputedStyle(t).pointerEvents !== 'none').length")
        check(covers == 0, f"{covers} words of charts can cover a point")
        # Repeats this by keyboard: one Tab stop a chart, arrow keys inside.
        browser.value(f"{POINTS}[0].focus()")
        browser.until("!tip.hidden")
        from_left = browser.value(f"[...{POINTS}].map(p => [p.querySelector('.mark').getBoundingClientRect().x, p.dataset.row]).sort((a, b) => a[0] - b[0]).map(p => p[1])")
        for first, key, number, order in (("Home", "ArrowRight", 39, from_left), ("End", "ArrowLeft", 37, from_left[::-1])):
            browser.press(first, number=36 if first == "Home" else 35)
            visited = [browser.value("tip.dataset.row")]
            for _ in range(3):
                browser.press(key, number=number)
                visited.append(browser.value("tip.dataset.row"))
            check(visited == order, f"{first} and {key} reach {visited}, not {order}")
        browser.press("Escape", number=27)
        check(browser.value("tip.hidden"), "Escape leaves the picture open")
        browser.press("Home", number=36)
        for row in from_left:
            browser.press("Enter", number=13)
            chosen = browser.value(f"[...document.querySelectorAll('.tile')].some(t => t.querySelector('.picture').src === JSON.parse(document.getElementById('data').textContent).rows['{row}'].picture)")
            check(chosen, "Enter does not show the point's picture in the wall")
            browser.press("ArrowRight", number=39)
        browser.press("Tab", number=9)
        check(browser.value("!document.activeElement.matches('.point') || document.activeElement.closest('svg') !== " + f"{POINTS}[0].closest('svg')"), "Tab stays in the chart")
        healthy(browser)


@case("chart.page_wall_compares_pictures", tier="nightly")
def wall(bench):
    with make_page(bench) as browser:
        browser.size(1200, 900)
        browser.open(bench.folder / "r/report.html")
        style = "getComputedStyle(document.querySelector('.place:not([hidden]) .tiles'))"
        mode = "document.querySelector('.place:not([hidden]) .tiles').dataset.mode"
        shown = "document.querySelector('.place:not([hidden]) .tile .{0}').checkVisibility({{visibilityProperty: true}})"
        check(browser.value("document.querySelectorAll('.tile').length") == 2, "a tile a technique")
        browser.until("[...document.querySelectorAll('.tile img')].every(i => i.complete && i.naturalWidth > 0)")

        def begin(css):
            return browser.value(f"""(() => {{ const b = document.querySelector('.place:not([hidden]) {css}'); b.scrollIntoView({{block: 'center'}});
                const r = b.getBoundingClientRect(); return [r.x, r.y + r.height / 2, r.width]; }})()""")

        # The slider, by mouse and by keys.
        clip = "getComputedStyle(document.querySelector('.place:not([hidden]) .tile .technique')).clipPath"
        before = browser.value(clip)
        x, y, width = begin("input.split")
        browser.mouse("mousePressed", x + 0.5 * width, y, button="left", clickCount=1)
        browser.mouse("mouseMoved", x + 0.8 * width, y, button="left", buttons=1)
        browser.mouse("mouseReleased", x + 0.8 * width, y, button="left", clickCount=1)
        split = float(browser.value(f"{style}.getPropertyValue('--split')").rstrip("%"))
        check(70 < split < 95 and browser.value(clip) != before, f"the slider stands at {split}")
        browser.press("ArrowLeft", number=37)
        check(float(browser.value(f"{style}.getPropertyValue('--split')").rstrip("%")) == split - 1, "the slider does not take keys")

        # Display modes, by keys on an image.
        browser.value("document.querySelector('.place:not([hidden]) .view').focus()")
        for key, name, visible in (("t", "technique", (True, False)), ("r", "reference", (False, False)), ("e", "error", (True, True)), ("s", "split", (True, False))):
            browser.press(key, text=key)
            check(browser.value(mode) == name, f"{key}: {browser.value(mode)}")
            found = tuple(browser.value(shown.format(css)) for css in ("technique", "error"))
            check(found == visible, f"{key}: technique and error map are {found}")
        browser.press("f", text="f")
        modes = {browser.value(mode)}
        browser.until(f"{mode} === 'reference'")
        browser.until(f"{mode} === 'technique'")
        check(browser.value("document.querySelector('.place:not([hidden]) .flicker').getAttribute('aria-pressed')") == "true", f"{modes}")
        browser.press("f", text="f")
        check(browser.value("document.querySelector('.place:not([hidden]) .flicker').getAttribute('aria-pressed')") == "false", "flickers on")

        # All images zoom and move together.
        browser.press("+", text="+")
        browser.press("+", text="+")
        browser.press("ArrowRight", number=39)
        transforms = browser.value("[...new Set([...document.querySelectorAll('.place:not([hidden]) .view img')].map(i => getComputedStyle(i).transform))]")
        check(len(transforms) == 1 and transforms[0].startswith("matrix(4, 0, 0, 4"), f"{transforms}")
        x, y, width = begin(".view")
        browser.mouse("mousePressed", x + 0.5 * width, y, button="left", clickCount=1)
        browser.mouse("mouseMoved", x + 0.6 * width, y, button="left", buttons=1)
        browser.mouse("mouseReleased", x + 0.6 * width, y, button="left", clickCount=1)
        check(browser.value("getComputedStyle(document.querySelector('.place:not([hidden]) .view img')).transform") != transforms[0], "dragging moves nothing")

        # Other sample counts, other surfaces.
        source = "document.querySelectorAll('.place:not([hidden]) .tile')[1].querySelector('.picture').src"
        first = browser.value(source)
        browser.value("(() => { const s = document.querySelector('.place:not([hidden]) .tile select'); s.selectedIndex = 0; s.dispatchEvent(new Event('change')); })()")
        check(browser.value(source) != first, "the list changes nothing")
        browser.value("(() => { const s = document.querySelector('.cells'); s.selectedIndex = 3; s.dispatchEvent(new Event('change')); })()")
        check(browser.value("document.querySelectorAll('.place:not([hidden])').length === 1 && document.querySelectorAll('.place')[3].hidden === false"), "surfaces do not change")
        check(browser.value("document.querySelectorAll('.place:not([hidden]) .tile').length") == 2, "the other surfaces have no pictures")
        healthy(browser)


@case("chart.page_fits_narrow_and_dark_windows", tier="nightly")
def narrow(bench):
    with make_page(bench) as browser:
        page = bench.folder / "r/report.html"
        shades = {}
        for width, scheme in ((1200, "light"), (1200, "dark"), (400, "light"), (400, "dark")):
            browser.size(width, 900)
            browser.scheme(scheme)
            browser.open(page)
            browser.value("document.querySelectorAll('details').forEach(d => d.open = true)")
            check(browser.value("document.documentElement.scrollWidth <= innerWidth"), f"{width} {scheme}: the page is wider than the window")
            small = browser.value("""[...document.querySelectorAll('.place:not([hidden]) svg text, .heats text')].filter(t => t.getClientRects().length).map(t => {
                const m = t.getScreenCTM(), scale = Math.hypot(m.a, m.b); return scale * parseFloat(getComputedStyle(t).fontSize); }).filter(s => s < 10).length""")
            check(small == 0, f"{width} {scheme}: {small} texts of charts are below 10 pixels")
            cut = browser.value("""[...document.querySelectorAll('.place:not([hidden]) svg, .heats svg')].filter(s => s.getClientRects().length).flatMap(s => {
                const b = s.getBoundingClientRect(); return [...s.querySelectorAll('text')].filter(t => { const r = t.getBoundingClientRect();
                return r.left < b.left - 1 || r.right > b.right + 1 || r.top < b.top - 1 || r.bottom > b.bottom + 1; }).map(t => t.textContent); })""")
            check(cut == [], f"{width} {scheme}: texts leave their chart: {cut}")
            # WCAG contrast of texts and marks against their background.
            worst = browser.value("""(() => {
                const paint = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
                const light = c => { paint.fillStyle = c; paint.fillRect(0, 0, 1, 1); const v = [...paint.getImageData(0, 0, 1, 1).data].slice(0, 3)
                  .map(x => x / 255).map(x => x <= .04045 ? x / 12.92 : ((x + .055) / 1.055) ** 2.4); return .2126 * v[0] + .7152 * v[1] + .0722 * v[2]; };
                const ratio = (a, b) => (Math.max(light(a), light(b)) + .05) / (Math.min(light(a), light(b)) + .05);
                const paper = getComputedStyle(document.querySelector('svg.chart')).backgroundColor;
                const texts = [...document.querySelectorAll('.place svg text')].map(t => ratio(getComputedStyle(t).fill, paper));
                const body = getComputedStyle(document.body);
                return Math.min(...texts, ratio(body.color, body.backgroundColor)); })()""")
            check(worst >= 4.5, f"{width} {scheme}: contrast of only {worst:.2f}")
            shades[width, scheme] = browser.value("getComputedStyle(document.body).backgroundColor + getComputedStyle(document.querySelector('svg.chart')).backgroundColor")
            unnamed = browser.value("""[...document.querySelectorAll('input, select, button, [tabindex="0"], svg.chart, .view')].filter(e =>
                !(e.getAttribute('aria-label') || e.textContent.trim() || (e.labels && [...e.labels].some(l => l.textContent.trim())))).length""")
            check(unnamed == 0, f"{unnamed} controls have no name")
            browser.screenshot(bench.folder / f"{width}-{scheme}.png")
        check(shades[1200, "light"] != shades[1200, "dark"] and shades[400, "light"] != shades[400, "dark"], f"dark is as light as light: {shades}")
        healthy(browser)
