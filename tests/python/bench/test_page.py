"""The page in Chromium: bend, stop, resume, compare, table, deck, phone, two tabs, keyboard, both languages."""

import json
import re
import shutil
import subprocess
import threading
import time
from importlib.resources import files
from pathlib import Path

import pytest
import uvicorn

from umform.bench.jobs import Queue
from umform.bench.server import application, listening

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
SOFTWARE_GL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
READY = "html[data-ready=yes]"
PAGE = Path(str(files("umform.bench").joinpath("page")))


@pytest.mark.skipif(shutil.which("node") is None, reason="no Node to parse JavaScript")
def test_modules_can_be_parsed():
    parse = "const vm = require('vm'), fs = require('fs');"
    parse += "for (const file of process.argv.slice(1)) new vm.SourceTextModule(fs.readFileSync(file, 'utf8'));"
    modules = [str(path) for path in PAGE.iterdir() if path.name.endswith(".js")]
    assert len(modules) > 8
    subprocess.run(
        ["node", "--experimental-vm-modules", "--no-warnings", "-e", parse, *modules], check=True, timeout=60
    )


@pytest.mark.skipif(shutil.which("tsc") is None, reason="no TypeScript to check the types of JSDoc")
def test_types_of_the_modules_fit():
    subprocess.run(["tsc", "-p", str(PAGE / "jsconfig.json")], check=True, timeout=120)


def test_both_languages_have_all_texts():
    english, german = (json.loads(PAGE.joinpath(f"{name}.json").read_text(encoding="utf-8")) for name in ("en", "de"))
    assert english.keys() == german.keys()
    for key, text in english.items():
        assert set(re.findall(r"\{(\w+)\}", text)) == set(re.findall(r"\{(\w+)\}", german[key])), key


def test_texts_that_the_page_asks_for_are_there():
    english = json.loads(PAGE.joinpath("en.json").read_text(encoding="utf-8"))
    sources = [path.read_text(encoding="utf-8") for path in PAGE.iterdir() if path.name.endswith((".js", ".html"))]
    asked = {key for text in sources for key in re.findall(r"""(?:\bt\(|data-t(?:-label)?=)["']([\w.]+)["']""", text)}
    assert len(asked) > 40 and asked <= english.keys()


def test_page_names_no_other_server():
    for path in PAGE.iterdir():
        text = path.read_text(encoding="utf-8")
        assert not re.findall(r"https?://(?!www\.w3\.org/)", text), path.name


@pytest.fixture(scope="module")
def link(tmp_path_factory):
    """The link of a server in a thread of this process."""
    with listening(0) as listener:
        port = listener.getsockname()[1]
        app = application(Queue(tmp_path_factory.mktemp("page")), "the-token-of-the-page", port)
        server = uvicorn.Server(uvicorn.Config(app, log_level="error", ws="none", timeout_graceful_shutdown=1))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, daemon=True)
        thread.start()
        until = time.monotonic() + 30
        while not server.started and time.monotonic() < until:
            time.sleep(0.02)
        yield f"http://127.0.0.1:{port}/?token=the-token-of-the-page"
        server.should_exit = True
        thread.join(30)


@pytest.fixture(scope="module")
def browser():
    sync_api = pytest.importorskip("playwright.sync_api", reason="no playwright")
    if BROWSER is None:
        pytest.skip("no Chromium on this machine")
    with sync_api.sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=BROWSER, args=SOFTWARE_GL)
        yield chromium
        chromium.close()


class Visit:
    """A page of the bench, what it asked the network for, and what it complained about."""

    def __init__(self, browser, link, *, toured=True, **options):
        self.context = browser.new_context(**{"viewport": {"width": 1400, "height": 900}, "locale": "en-GB", **options})
        self.context.set_default_timeout(90_000)
        self.complaints, self.requests = [], []
        self.page = self.tab(link, toured)

    def tab(self, link, toured=True):
        page = self.context.new_page()
        page.on("console", lambda message: self.complaints.append(message.text))
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("request", lambda request: self.requests.append(request.url))
        page.goto(link)
        page.wait_for_selector(READY, state="attached")
        if toured:
            page.keyboard.press("Escape")
        return page


@pytest.fixture
def visit(browser, link):
    visit = Visit(browser, link)
    yield visit
    assert visit.complaints == []
    assert all(url.startswith((link.split("?")[0], "blob:", "data:")) for url in visit.requests)
    visit.context.close()


def quick(page, stroke):
    """Fill in a bend that is done in a moment."""
    page.locator("#fields details").last.locator("summary").click()
    page.select_option("#f-mesh", "quick")
    page.fill("#f-stroke", str(stroke))


def bent(page, stroke):
    quick(page, stroke)
    page.click("#run")
    page.wait_for_selector("[data-measure=stroke]")


def test_bend_is_drawn_run_and_told(visit):
    page = visit.page
    sheet = page.locator("#drawing .sheet").get_attribute("d")
    page.fill("#f-thickness", "3")
    page.wait_for_function(
        "(before) => document.querySelector('#drawing .sheet').getAttribute('d') !== before", arg=sheet
    )
    page.fill("#f-thickness", "2")
    bent(page, 1)
    assert page.locator("[data-measure=stroke] b").inner_text() == "1.000"
    assert "kN" in page.locator("[data-measure=largest_force]").inner_text()
    assert page.locator("#drawing .computed").count() == 1
    shape = page.frame_locator("iframe")
    shape.locator(READY).wait_for(state="attached")
    assert page.locator("a[href$='report.html']").get_attribute("target") == "_blank"
    page.fill("#flat-a", "50")
    assert page.locator(".flat .value").inner_text().endswith("mm")


def test_angle_out_of_reach_is_refused_beside_its_field(visit):
    page = visit.page
    page.fill("#f-angle", "70")
    page.wait_for_selector("#f-angle[aria-invalid=true]")
    assert page.locator("#run").is_disabled()
    page.click("#n-angle button")
    page.wait_for_selector("#run:enabled")
    assert float(page.input_value("#f-die_angle")) < 70


def test_jobs_are_compared_in_two_tabs_and_stay(visit, link):
    page = visit.page
    bent(page, 0.8)
    other = visit.tab(link.split("?")[0])
    other.wait_for_selector("#jobs li")
    boxes = other.locator("#jobs input:enabled")
    for number in range(2):
        boxes.nth(number).check()
    other.click("nav [data-view=compare]")
    other.wait_for_selector("#compare table")
    assert other.locator("#compare thead th").count() == 2
    assert other.locator("#compare .curve").count() == 2


def test_deck_is_stopped_and_goes_on(visit):
    page = visit.page
    page.click("nav [data-view=deck]")
    page.select_option("#deck-template", "cantilever")
    page.wait_for_function("() => document.querySelector('#deck-text').value.includes('Cantilever')")
    text = page.input_value("#deck-text")
    page.fill("#deck-text", text.replace("increments = 20", "increments = 800"))
    assert page.locator("#deck-help details").count() > 0
    page.click("#deck-run")
    page.wait_for_selector(".progress p:has-text('increment')")
    page.click("#do-stop")
    page.wait_for_selector("#do-resume")
    page.click("#do-resume")
    page.wait_for_selector("#do-stop")
    page.click("#do-stop")
    page.wait_for_selector("#do-resume")


def test_phone_dark_german_and_keyboard(browser, link):
    phone = {"viewport": {"width": 390, "height": 844}, "color_scheme": "dark", "locale": "de-DE", "has_touch": True}
    visit = Visit(browser, link, toured=False, **phone)
    page = visit.page
    page.wait_for_selector("#tour-dialog[open]")
    for _ in range(6):
        page.locator("#tour-dialog .main").press("Enter")
    assert page.locator("#tour-dialog[open]").count() == 0
    assert page.locator("#run").inner_text() == "Biegen"
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(19, 23, 27)"
    page.focus("#f-angle")
    page.keyboard.press("ArrowUp")
    assert page.input_value("#f-angle") == "91"
    page.select_option("#language", "en")
    page.wait_for_function("() => document.querySelector('#run').textContent === 'Bend'")
    unnamed = page.evaluate("""() => [...document.querySelectorAll('button, a[href], input, select, textarea')]
        .filter((one) => one.checkVisibility() && !one.labels?.length)
        .filter((one) => !(one.getAttribute('aria-label') ?? one.textContent).trim())
        .map((one) => one.outerHTML)""")
    assert unnamed == []
    assert visit.complaints == []
    visit.context.close()
