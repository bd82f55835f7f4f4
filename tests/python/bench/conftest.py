"""A bench in a folder of its own, and bends that are done in a moment."""

import time

import pytest

pytest.importorskip("starlette", reason="no extra bench")
pytest.importorskip("uvicorn", reason="no extra bench")
pytest.importorskip("httpx2", reason="no httpx2, which Starlette's test client needs")

from starlette.testclient import TestClient

from umform.bench.jobs import Queue
from umform.bench.server import application

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


def wait(holds, seconds=30.0):
    """Wait until something holds."""
    until = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < until, "it has not come to hold"
        time.sleep(0.02)


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    bench = Bench(tmp_path_factory.mktemp("bench"))
    with bench.client:
        assert bench.client.get(f"/?token={TOKEN}").status_code == 200
        yield bench
