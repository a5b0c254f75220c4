"""Drives reports in a real browser: hover, zoom, keyboard, buttons, dark scheme, print, narrow and wide screens, accessibility.

    python3 crates/fluxfit-report/tests/browser.py FLUXFIT

FLUXFIT is the program, with which the reports are made. Playwright and axe-core are installed into target/browser, Chromium by apt-get
where it is absent; what cannot be installed is an error. Every failed check is named; the exit status is then 1.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
ENVIRONMENT = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve() / "browser"
PACKAGES = ["playwright==1.65.2", "axe-playwright-python==0.1.8"]
BROWSERS = ["chromium", "chromium-browser", "google-chrome"]
WIDTHS = [360, 900, 1600]


def in_environment():
    """Runs this program again in an environment that has its packages."""
    python = ENVIRONMENT / "venv" / "bin" / "python"
    if pathlib.Path(sys.prefix).resolve() == python.parent.parent:
        return
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", python.parent.parent], check=True)
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *PACKAGES], check=True)
    sys.exit(subprocess.run([python, __file__, *sys.argv[1:]]).returncode)


def browser_path():
    """A Chromium, installed where there is none."""
    found = next(filter(None, map(shutil.which, BROWSERS)), None)
    if found is None:
        as_root = [] if os.geteuid() == 0 else ["sudo", "-n"]
        for command in (["apt-get", "update", "-qq"], ["apt-get", "install", "-y", "-qq", "--no-install-recommends", "chromium"]):
            subprocess.run(as_root + command, check=True, stdout=subprocess.DEVNULL)
        found = next(filter(None, map(shutil.which, BROWSERS)), None)
    return found or sys.exit("no Chromium, and it could not be installed")


def made(fluxfit, folder):
    """The pages: identifications of each kind, a comparison's validation, by name."""
    scenarios = ROOT / "examples" / "scenarios"
    pages = {}
    for name, options in (("paper_rig", []), ("pm_syrm", []), ("id_zero", ["--model", "steady"])):
        log, page = folder / f"{name}.csv", folder / f"{name}.html"
        subprocess.run([fluxfit, "simulate", scenarios / f"{name}.toml", "-o", log], check=True, capture_output=True)
        done = subprocess.run([fluxfit, "identify", log, *options, "--report", page], capture_output=True, text=True)
        # 1: some parameter is not identified.
        if done.returncode not in (0, 1):
            sys.exit(done.stderr)
        pages[name] = page
    motor = folder / "wrong.toml"
    # L_d is a thousand times too large: a unit that was left out.
    motor.write_text('[motor]\nrs = "0.958 ohm"\nld = 5.25\nlq = "12 mH"\npsi_f = "0.1827 Wb"\npole_pairs = 4\n')
    pages["validation"] = folder / "validation.html"
    subprocess.run([fluxfit, "validate", folder / "paper_rig.csv", "--motor", motor, "--report", pages["validation"]], capture_output=True)
    pages["fleet"] = fleet_page(fluxfit, folder)
    return pages


def fleet_page(fluxfit, folder):
    """Forty motors in two windows, by the motor's equations: one with a speed in other units, one that warms, one that stands still."""
    table, page = folder / "fleet.csv", folder / "fleet.html"
    lines = ["motor_id,t,ud,uq,id,iq,omega_e"]
    for motor in range(40):
        for row in range(600):
            (d, q), hour = [(0.0, 9.0), (-2.0, 8.5), (0.0, 4.0)][row % 300 // 100], row // 300
            rs = 0.958 * (1 + 0.002 * (motor * 7 % 41 - 20)) * (1 + 0.08 * hour * (motor == 12))
            omega = 0.0 if motor == 20 else 400.0
            ud, uq = rs * d - omega * 12e-3 * q, rs * q + omega * (5.25e-3 * d + 0.1827)
            lines.append(f"m{motor:02},{3600 * hour + row % 300 * 1e-3},{ud},{uq},{d},{q},{omega * (2.387 if motor == 5 else 1.0)}")
    table.write_text("\n".join(lines) + "\n")
    words = ["--by", "motor_id", "--every", "1h", "-o", folder / "results.csv", "--report", page]
    subprocess.run([fluxfit, "fleet", table, *words], capture_output=True)
    return page


class Checks:
    """Counts checks and names those that fail."""

    def __init__(self):
        self.passed, self.failed = 0, []

    def that(self, holds, what):
        if holds:
            self.passed += 1
        else:
            self.failed.append(what)


def opened(browser, page, width, scheme, checks, scripts=True):
    context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme, accept_downloads=True, java_script_enabled=scripts)
    tab = context.new_page()
    where = f"{page.stem} at {width} px, {scheme}"
    tab.on("console", lambda message: checks.that(False, f"{where}: console: {message.text}"))
    tab.on("pageerror", lambda error: checks.that(False, f"{where}: error: {error}"))
    tab.on("request", lambda request: checks.that(request.url.startswith(("file:", "blob:")), f"{where}: request of {request.url}"))
    tab.goto(page.as_uri())
    return context, tab, where


def looks(browser, page, checks, axe):
    """Every width and scheme: nothing is wider than the page, no figure is missing, nothing is inaccessible."""
    for width in WIDTHS:
        for scheme in ("light", "dark"):
            context, tab, where = opened(browser, page, width, scheme, checks)
            wide = tab.evaluate("document.documentElement.scrollWidth")
            checks.that(wide <= width, f"{where}: {wide} px wide")
            hidden = tab.evaluate("""() => [...document.querySelectorAll('.scroll')].filter(box => box.scrollWidth > box.clientWidth + 1)
                .map(box => box.getAttribute('aria-label'))""")
            # Tables of a validation and a fleet scroll on a telephone, with a shadow at the edge.
            checks.that((width < 900 and page.stem in ("validation", "fleet")) or not hidden, f"{where}: columns are out of sight: {hidden}")
            live = tab.evaluate("[document.querySelectorAll('figure.live').length, document.querySelectorAll('figure > script').length]")
            checks.that(live[0] == live[1], f"{where}: {live[0]} of {live[1]} figures are drawn")
            clipped = tab.evaluate("""() => [...document.querySelectorAll('main p, main td, main th, header p')].filter(one =>
                getComputedStyle(one).overflow === 'hidden' && one.scrollWidth > one.clientWidth + 1).length""")
            checks.that(clipped == 0, f"{where}: {clipped} texts are cut off")
            if (width, scheme) in ((360, "light"), (1600, "dark")):
                tab.evaluate(axe)
                serious = tab.evaluate("axe.run().then(found => found.violations.filter(one => ['serious', 'critical'].includes(one.impact))"
                                       ".map(one => one.id + ': ' + one.nodes.slice(0, 3).map(node => node.target).join(' ')))")
                checks.that(not serious, f"{where}: {serious}")
            context.close()


def drives(browser, page, checks):
    """Hover, zoom, keyboard and buttons of the first figure and the page."""
    context, tab, where = opened(browser, page, 1600, "light", checks)
    plot = tab.locator("figure.live").first
    over = plot.locator(".u-over").first
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    middle = box["y"] + box["height"] / 2
    told = plot.locator("output")
    ticks = lambda: plot.locator(".u-over").first.evaluate("one => { const p = one.closest('.plot'); return p.querySelector('output').textContent }")
    tab.mouse.move(box["x"] + box["width"] / 2, middle)
    checks.that(told.inner_text().startswith("time "), f"{where}: hover tells '{told.inner_text()}'")
    values = plot.locator(".key b").all_inner_texts()
    checks.that(len(values) == 5 and all(any(c.isdigit() for c in value) for value in values), f"{where}: values at the pointer: {values}")
    at = lambda share: float(hovered(tab, box, middle, share, told))
    before = at(0.9) - at(0.1)
    tab.mouse.move(box["x"] + 0.4 * box["width"], middle)
    tab.mouse.down()
    tab.mouse.move(box["x"] + 0.6 * box["width"], middle, steps=5)
    tab.mouse.up()
    after = at(0.9) - at(0.1)
    checks.that(abs(after / before - 0.2) < 0.05, f"{where}: a drag over a fifth shows {after / before:.3f} of the time")
    tab.mouse.dblclick(box["x"] + 0.5 * box["width"], middle)
    checks.that(abs((at(0.9) - at(0.1)) / before - 1) < 0.01, f"{where}: a double click does not reset the zoom")
    plate = plot.locator(".plot")
    plate.focus()
    tab.keyboard.press("ArrowRight")
    first = ticks()
    tab.keyboard.press("ArrowRight")
    checks.that(first.startswith("time ") and ticks() != first, f"{where}: the arrow keys tell '{first}', then '{ticks()}'")
    tab.keyboard.press("+")
    tab.keyboard.press("+")
    zoomed = at(0.9) - at(0.1)
    checks.that(zoomed < 0.3 * before, f"{where}: plus twice shows {zoomed / before:.3f} of the time")
    plate.focus()
    tab.keyboard.press("Escape")
    checks.that(abs((at(0.9) - at(0.1)) / before - 1) < 0.01, f"{where}: Escape does not reset the zoom")
    for name, ending, check in [
        ("Save JSON", ".json", lambda text: json.loads(text)["schema"].startswith("fluxfit.")),
        ("Save CSV, fitted and measured", ".csv", lambda text: text.count("\n") > 2 and len({line.count(",") for line in text.splitlines()[1:]}) == 1),
    ]:
        with tab.expect_download(timeout=5000) as saved:
            tab.get_by_role("button", name=name).click()
        path = saved.value.path()
        checks.that(saved.value.suggested_filename.endswith(ending) and check(path.read_text()), f"{where}: {name} saves nothing of use")
    with tab.expect_download(timeout=5000) as saved:
        plot.get_by_role("button", name="Save this figure as PNG").click()
    picture = saved.value.path().read_bytes()
    checks.that(picture.startswith(b"\x89PNG") and len(picture) > 5000, f"{where}: the PNG is empty")
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    tab.get_by_role("button", name="Copy the command").click()
    copied = tab.evaluate("navigator.clipboard.readText()")
    checks.that(copied.startswith("fluxfit "), f"{where}: copied '{copied}'")
    context.close()


def hovered(tab, box, middle, share, told):
    tab.mouse.move(box["x"] + share * box["width"], middle)
    return told.inner_text().split()[1].replace("\N{MINUS SIGN}", "-")


def prints(browser, page, checks):
    """On paper: still pictures, no buttons; and the same page without scripts."""
    context, tab, where = opened(browser, page, 900, "light", checks)
    tab.emulate_media(media="print")
    shown = tab.evaluate("[...document.querySelectorAll('.plot, .actions')].filter(one => getComputedStyle(one).display !== 'none').length")
    checks.that(shown == 0, f"{where}, print: {shown} interactive parts are printed")
    checks.that(len(tab.pdf(format="A4")) > 10_000, f"{where}: the print is empty")
    context.close()
    context, tab, where = opened(browser, page, 900, "light", checks, scripts=False)
    checks.that(tab.locator("figure > svg.wide").first.is_visible(), f"{where}, without scripts: no picture")
    context.close()


def says(browser, pages, checks):
    """What a reader sees first: the answer and what to do next."""
    wanted = {
        "paper_rig": ["All 4 identified", "Nothing more is to be done"],
        "pm_syrm": ["None of 4 identified", "The motor saturates, apparent Lq from", "take its fluxes at your currents"],
        "id_zero": ["3 of 4 identified", "Ld needs"],
        "validation": ["contradicts"],
        "fleet": ["40 motors: 39 with all 4 parameters identified", "1 stands apart from the others: m05", "1 drifts: m12"],
    }
    for name, words in wanted.items():
        context, tab, where = opened(browser, pages[name], 900, "light", checks)
        found = tab.locator(".found").inner_text().replace("\n", " ")
        for word in words:
            checks.that(word in found, f"{where}: '{word}' is not in '{found}'")
        bottom = tab.locator(".found").bounding_box()
        checks.that(bottom["y"] + bottom["height"] < 450, f"{where}: the answer is not in the upper half of the screen")
        context.close()
    context, tab, where = opened(browser, pages["validation"], 900, "light", checks)
    checks.that("1000 times" in tab.locator("main").inner_text(), f"{where}: no hint at the unit of L_d")
    context.close()


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    in_environment()
    import axe_playwright_python
    from playwright.sync_api import sync_playwright

    axe = (pathlib.Path(axe_playwright_python.__file__).parent / "axe.min.js").read_text()
    checks = Checks()
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        pages = made(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(folder))
        browser = playwright.chromium.launch(executable_path=browser_path(), args=["--no-sandbox"])
        for page in pages.values():
            looks(browser, page, checks, axe)
            prints(browser, page, checks)
        drives(browser, pages["paper_rig"], checks)
        says(browser, pages, checks)
        browser.close()
    for what in checks.failed:
        print(f"failed: {what}")
    print(f"{checks.passed} passed, {len(checks.failed)} failed")
    sys.exit(bool(checks.failed))


if __name__ == "__main__":
    main()
