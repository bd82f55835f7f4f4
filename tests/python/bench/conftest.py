"""A bench in a folder of its own, and bends that are done in a moment."""

import threading
import time

import pytest

pytest.importorskip("starlette", reason="no extra bench")
pytest.importorskip("uvicorn", reason="no extra bench")
pytest.importorskip("httpx2", reason="no httpx2, which Starlette's test client needs")

import uvicorn
from starlette.testclient import TestClient
from visits import BROWSER, SOFTWARE_GL, Visit, wait

from umform.bench.jobs import Queue
from umform.bench.server import application, listening

PORT, TOKEN = 8765, "a-token-that-nobody-guesses"
#: A blunt bend on a coarse mesh: a tenth of a second.
QUICK = {"mesh": "quick", "angle": None, "stroke": 1.0, "length": 500.0}


class Bench:
    """A server with its queue, and a browser that has opened the link."""

    def __init__(self, folder):
        self.queue = Queue(folder)
        self.app = application(self.queue, TOKEN, PORT)
        self.client = TestClient(self.app, base_url=f"http://127.0.0.1:{PORT}")

    def order(self, **values):
        answer = self.client.post("/api/jobs", json={"forms": [{**QUICK, **values}]})
        assert answer.status_code == 200, answer.text
        return answer.json()["jobs"][0]

    def state(self, name):
        return self.client.get(f"/api/jobs/{name}").json()["state"]

    def ended(self, name, seconds=60.0):
        wait(lambda: self.state(name) not in ("waiting", "running"), seconds)
        return self.client.get(f"/api/jobs/{name}").json()


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    bench = Bench(tmp_path_factory.mktemp("bench"))
    with bench.client:
        assert bench.client.get(f"/?token={TOKEN}").status_code == 200
        yield bench


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


@pytest.fixture
def visit(browser, link):
    visit = Visit(browser, link)
    yield visit
    assert visit.complaints == []
    assert all(url.startswith((link.split("?")[0], "blob:", "data:")) for url in visit.requests)
    visit.context.close()
