"""Photograph the page of the bench with a finished bend, for docs/bench.md: python tools/bench_picture.py [FILE].

It needs Playwright and Chromium, as the tests of the page do.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
import threading
import time
from pathlib import Path

import uvicorn
from playwright.sync_api import sync_playwright

from umform.bench.jobs import Queue
from umform.bench.server import application, listening

PICTURE = Path(__file__).parent.parent / "docs" / "images" / "bench.png"
#: Width and height in pixels.
SIZE = {"width": 1440, "height": 1010}
#: Names of the browser.
CHROMIUM = ("chromium", "chromium-browser", "google-chrome")


def photograph(link: str, path: Path) -> None:
    """Bend the sheet of the form, and photograph the page with its result."""
    browser = next(filter(None, map(shutil.which, CHROMIUM)), None)
    with sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=browser, args=["--use-angle=swiftshader"])
        page = chromium.new_page(viewport=SIZE, locale="en-GB", color_scheme="light")
        page.goto(link)
        page.wait_for_selector("html[data-ready=yes]", state="attached")
        page.keyboard.press("Escape")  # the tour
        page.click("#run")
        page.wait_for_selector("[data-measure=stroke]", timeout=300_000)
        page.wait_for_selector("#jobs .dot.done")
        page.evaluate("scrollTo(0, 0)")
        page.mouse.move(0, 0)
        page.wait_for_timeout(500)
        page.screenshot(path=path)
        chromium.close()


def main(path: Path = PICTURE) -> None:
    """Start a server on a folder of its own, and photograph its page."""
    with tempfile.TemporaryDirectory() as folder, listening(0) as listener:
        port = listener.getsockname()[1]
        app = application(Queue(Path(folder)), "the-token-of-the-picture", port)
        server = uvicorn.Server(uvicorn.Config(app, log_level="error", ws="none", timeout_graceful_shutdown=1))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]}, daemon=True)
        thread.start()
        while not server.started:
            time.sleep(0.02)
        photograph(f"http://127.0.0.1:{port}/?token=the-token-of-the-picture", path)
        server.should_exit = True
        thread.join(30)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
