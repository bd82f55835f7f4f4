"""Jobs outlive the server: killed, ended by Ctrl-C, asked by a thousand at once; what was stopped goes on."""

import concurrent.futures
import csv
import http.client
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from visits import wait

from umform.bench import jobs
from umform.bench.index import UNFINISHED
from umform.bench.jobs import MOST_STARTS, Queue
from umform.bench.server import locked
from umform.errors import FileProblem
from umform.problem.problem import Problem

QUICK = {"mesh": "quick", "angle": None, "stroke": 0.6}
#: A strip that is bent elastically in many increments: it is stopped on its way.
DECK = """
title = "strip"
[mesh]
generator = "strip"
length = 10.0
width = 1.0
thickness = 0.5
cells = [6, 1]
[element]
name = "ANS3DEAS"
[material]
law = "SVK"
E = 1e4
nu = 0.3
[[supports]]
kind = "fix"
nodes = "x0"
[controls.tip]
kind = "displacement"
nodes = "x1"
direction = "z"
[[steps]]
kind = "move"
to = { tip = 2.0 }
increments = 400
[output]
frames = 3
pictures = false
vtkhdf = false
report = false
"""


class Server:
    """A server of its own process, on a port that was free."""

    def __init__(self, folder):
        command = [sys.executable, "-m", "umform", "bench", "--folder", str(folder), "--port", "0", "--no-browser"]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        link = re.search(r"http://127.0.0.1:(\d+)/\?token=(\S+)", self.process.stdout.readline())
        assert link, "the server has printed no link"
        self.port, self.token = int(link[1]), link[2]
        wait(self.answers)

    def ask(self, method, path, body=None, headers=None, timeout=30):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)
        cookie = {"cookie": f"umform-bench-{self.port}={self.token}", "content-type": "application/json"}
        connection.request(method, path, None if body is None else json.dumps(body), {**cookie, **(headers or {})})
        answer = connection.getresponse()
        content = answer.read()
        connection.close()
        return answer.status, content

    def answers(self):
        try:
            return self.ask("GET", "/api/jobs")[0] == 200
        except OSError:
            assert self.process.poll() is None, "the server has died"
            return False

    def jobs(self):
        return {job["id"]: job for job in json.loads(self.ask("GET", "/api/jobs")[1])["jobs"]}

    def end(self, number=signal.SIGKILL):
        self.process.send_signal(number)
        self.process.wait(timeout=40)
        self.process.stdout.close()


def killed(folder, times):
    """Kill a server again and again, at other moments of its jobs; no job is lost, and all end as they should."""
    ordered = []
    for number in range(times):
        server = Server(folder)
        status, text = server.ask("POST", "/api/jobs", {"forms": [{**QUICK, "stroke": 0.5 + 0.01 * number}]})
        assert status == 200
        ordered += json.loads(text)["jobs"]
        time.sleep(0.15 * (number % 8))
        assert set(ordered) <= set(server.jobs())
        server.end()
    server = Server(folder)
    wait(lambda: all(server.jobs()[name]["state"] == "done" for name in ordered), 60 + 8 * times)
    jobs = server.jobs()
    for number, name in enumerate(ordered):
        assert jobs[name]["summary"]["measures"]["stroke"] == pytest.approx(0.5 + 0.01 * number)
        assert (folder / "jobs" / name / "results" / "report.html").is_file()
    return server


def asked_at_once(server, count):
    """Ask many questions at once, good ones and hostile ones; all get the answer that is theirs."""
    questions = [
        ("GET", "/api/jobs", None, {}, 200),
        ("POST", "/api/look", {"thickness": 1e300}, {}, 200),
        ("GET", "/api/jobs", None, {"host": "evil.example"}, 421),
        ("POST", "/api/jobs", {"forms": [{}]}, {"origin": "http://evil.example"}, 403),
        ("GET", "/files/../../token", None, {}, 404),
    ]

    def ask(number):
        method, path, body, headers, expected = questions[number % len(questions)]
        return server.ask(method, path, body, headers, timeout=120)[0] == expected

    with concurrent.futures.ThreadPoolExecutor(min(count, 500)) as pool:
        return all(pool.map(ask, range(count)))


def test_server_that_is_killed_loses_nothing_and_answers_a_thousand_at_once(tmp_path):
    server = killed(tmp_path, 3)
    before = set(server.jobs())
    assert asked_at_once(server, 1000)
    assert set(server.jobs()) == before and server.process.poll() is None
    server.process.send_signal(signal.SIGINT)
    said, _ = server.process.communicate(timeout=40)
    assert server.process.returncode == 0 and "has ended" in said


@pytest.mark.long
@pytest.mark.timeout(1200)
def test_server_that_is_killed_twenty_times_loses_nothing(tmp_path):
    killed(tmp_path, 20).end(signal.SIGINT)


def test_second_server_on_a_folder_is_refused(tmp_path):
    with locked(tmp_path), pytest.raises(FileProblem, match="another bench"), locked(tmp_path):
        pass
    (tmp_path / "file").write_text("")
    with pytest.raises(FileProblem, match="there is a file of this name"), locked(tmp_path / "file"):
        pass


def test_deck_that_is_stopped_and_handed_on_ends_with_the_same_bits(tmp_path):
    queue = Queue(tmp_path)
    queue.start()
    name = queue.add("deck", "strip", {}, deck=DECK)
    results = queue.folder_of(name) / "results"
    wait(lambda: queue.live(name).get("increments", 0) > 3)
    queue.stop(name)
    wait(lambda: queue.index.job(name).state not in UNFINISHED)
    job = queue.index.job(name)
    assert job.state == "stopped" and (results / "checkpoint.h5").is_file(), job.reason
    stopped_at = queue.live(name)["increments"]

    queue.resume(name)
    wait(lambda: queue.live(name).get("increments", 0) > stopped_at + 3)
    queue.close()  # gently, as by Ctrl-C: another server takes it up

    queue = Queue(tmp_path)
    assert queue.index.job(name).state == "waiting"
    queue.start()
    wait(lambda: queue.index.job(name).state not in UNFINISHED)
    job = queue.index.job(name)
    queue.close()
    assert job.state == "done" and job.summary["resumed"], job.reason
    assert job.summary["balance"]["run"]["force_imbalance"] < 1e-6
    with (results / "history.csv").open(newline="") as text:
        column = [float(row["tip_force"]) for row in csv.DictReader(text)]
    assert column == Problem.read(DECK).build().solve(progress=False)["tip_force"].tolist()


def test_process_that_dies_without_a_word_is_started_again_but_not_for_ever(tmp_path):
    queue = Queue(tmp_path)
    queue.spare.command = [sys.executable, "-S", "-c", "import sys; sys.stdin.readline(); sys.exit(9)"]
    queue.start()
    name = queue.add("deck", "strip", {}, deck=DECK)
    wait(lambda: queue.index.job(name).state not in UNFINISHED)
    job = queue.index.job(name)
    assert (job.state, job.starts) == ("failed", MOST_STARTS) and "without a result" in job.reason
    assert "memory" in job.summary["error"]["cause"] and "jobs.log" in job.summary["error"]["remedy"]
    queue.resume(name)
    wait(lambda: queue.index.job(name).state not in UNFINISHED)
    job = queue.index.job(name)
    assert (job.state, job.starts) == ("failed", MOST_STARTS) and f"{MOST_STARTS} times" in job.reason
    queue.close()


#: A process that does not stop when it is asked to, with a child; it writes down the numbers of both.
_DEAF = """
import os, signal, subprocess, sys, time
signal.signal(signal.SIGTERM, signal.SIG_IGN)
place = sys.stdin.readline().strip()
child = subprocess.Popen(["sleep", "600"])
with open(place + "/pids.new", "w") as text:
    text.write(f"{os.getpid()} {child.pid}")
os.rename(place + "/pids.new", place + "/pids")
time.sleep(600)
"""


def test_job_that_does_not_stop_is_killed_with_its_children(tmp_path, monkeypatch):
    monkeypatch.setattr(jobs, "_GRACE", 0.2)
    queue = Queue(tmp_path)
    queue.spare.command = [sys.executable, "-S", "-c", _DEAF]
    queue.start()
    name = queue.add("deck", "strip", {}, deck=DECK)
    wait((queue.folder_of(name) / "pids").is_file)
    queue.stop(name)
    wait(lambda: queue.index.job(name).state == "stopped")
    queue.close()
    child = int((queue.folder_of(name) / "pids").read_text().split()[1])
    wait(lambda: not _runs(child))


def _runs(pid):
    """Whether a process runs; one that has ended and waits for its parent does not."""
    try:
        os.kill(pid, 0)
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_job_that_was_stopped_while_the_server_ends_is_not_taken_up(tmp_path, monkeypatch):
    monkeypatch.setattr(jobs, "_GRACE", 0.2)
    queue = Queue(tmp_path)
    queue.spare.command = [sys.executable, "-S", "-c", _DEAF]
    queue.start()
    name = queue.add("deck", "strip", {}, deck=DECK)
    wait((queue.folder_of(name) / "pids").is_file)
    with queue._lock:
        queue._closing.set()
        queue.stop(name)
    queue.close()
    queue = Queue(tmp_path)
    assert queue.index.job(name).state == "stopped"
    queue.index.close()


def test_more_running_jobs_than_are_allowed_start_no_others(tmp_path):
    queue = Queue(tmp_path, at_once=1)
    names = [queue.add("deck", "strip", {}, deck=DECK) for _ in range(6)]
    queue._running = dict.fromkeys(names[:3])  # of a server before this one, which ran three at a time
    for name in names[:3]:
        queue.index.change(name, "running")
    queue.spare.command = [sys.executable, "-S", "-c", "import sys; sys.stdin.readline()"]
    queue._start_waiting()
    assert [queue.index.job(name).state for name in names[3:]] == ["waiting"] * 3
    queue._running.clear()
    queue.spare.end()
    queue.index.close()
