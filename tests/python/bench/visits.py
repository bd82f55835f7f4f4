"""A visit of the page of the bench in Chromium, for the browser tests; and waiting."""

import shutil
import time

import pytest

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
SOFTWARE_GL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
READY = "html[data-ready=yes]"


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


def serious(page):
    """Serious findings of axe in the light and the dark page."""
    axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="no axe").Axe()
    found = []
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        for one in axe.run(page).response["violations"]:
            if one["impact"] in ("serious", "critical"):
                found.append((scheme, one["id"], one["nodes"][0]["html"]))
    return found


def quick(page, stroke):
    """Fill in a bend that is done in a moment."""
    page.locator("#fields details").last.locator("summary").click()
    page.select_option("#f-mesh", "quick")
    page.fill("#f-stroke", str(stroke))


def wait(holds, seconds=60.0):
    """Wait until something holds."""
    until = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < until, "it has not come to hold"
        time.sleep(0.02)
