"""The index: nothing is lost with it, since the folders of the jobs make it again."""

import json

import pytest

from umform.bench import jobs
from umform.bench.index import Index
from umform.bench.jobs import Queue
from umform.errors import InvalidValue


@pytest.fixture
def queue(tmp_path):
    """A queue that has not been started: jobs wait."""
    queue = Queue(tmp_path)
    yield queue
    queue.index.close()


def test_jobs_are_there_for_another_server(queue, tmp_path):
    first = queue.add("bend", "one", {"angle": 90.0}, series="s")
    second = queue.add("bend", "two", {})
    queue.index.change(second, "done", summary={"measures": {"angle": 90.01}})
    again = Index(tmp_path)
    jobs = again.jobs()
    assert [(job.id, job.title, job.state, job.series) for job in jobs] == [
        (first, "one", "waiting", "s"),
        (second, "two", "done", ""),
    ]
    assert jobs[0].parameters == {"angle": 90.0} and jobs[1].summary["measures"]["angle"] == 90.01
    again.close()


@pytest.mark.parametrize("harm", ["gone", "broken", "empty"])
def test_index_is_made_again_from_the_folders(queue, tmp_path, harm):
    names = [queue.add("bend", f"job {number}", {"angle": 90.0 + number}) for number in range(3)]
    queue.index.close()
    file = tmp_path / "bench.sqlite"
    for path in tmp_path.glob("bench.sqlite-*"):
        path.unlink()
    if harm == "gone":
        file.unlink()
    else:
        file.write_bytes(b"no database at all" * 1000 if harm == "broken" else b"")
    again = Index(tmp_path)
    assert [(job.id, job.parameters["angle"]) for job in again.jobs()] == [
        (name, 90.0 + number) for number, name in enumerate(names)
    ]
    assert harm != "broken" or (tmp_path / "bench.broken").exists()
    again.close()


_ORDER = {"kind": "bend", "title": "", "series": "", "parameters": {}, "created": 1.0}
_NO_JOBS = {
    "a" * 12: "no json",
    "b" * 12: "[]",
    "c" * 12: json.dumps({"created": "x"}),
    "d" * 12: json.dumps(_ORDER | {"kind": []}),
    "e" * 12: json.dumps(_ORDER | {"title": "\ud800"}),
    "0123456789ab (copy)": json.dumps(_ORDER),
}


def test_folders_that_are_no_jobs_are_left_alone(tmp_path):
    for name, text in _NO_JOBS.items():
        (tmp_path / "jobs" / name).mkdir(parents=True)
        (tmp_path / "jobs" / name / "job.json").write_text(text)
    index = Index(tmp_path)
    assert index.jobs() == []
    index.close()


def test_too_many_jobs_are_refused(queue, monkeypatch):
    monkeypatch.setattr(jobs, "MOST_WAITING", 3)
    for _ in range(3):
        queue.add("bend", "one", {})
    with pytest.raises(InvalidValue, match="wait already"):
        queue.add("bend", "one more", {})


@pytest.mark.parametrize(
    "name", ["..", "../..", "a", "A" * 12, "0" * 13, "", "/etc/passwd", "0123456789ab/../x", "\x00"]
)
def test_names_that_are_none_of_jobs_lead_nowhere(queue, name):
    with pytest.raises(InvalidValue):
        queue.folder_of(name)


def test_job_that_waits_is_stopped_resumed_and_removed(queue):
    name = queue.add("bend", "one", {})
    queue.stop(name)
    assert queue.index.job(name).state == "stopped"
    queue.resume(name)
    assert queue.index.job(name).state == "waiting"
    queue._running[name] = None
    assert not queue.remove(name)  # it runs
    del queue._running[name]
    assert queue.remove(name)
    assert queue.index.job(name) is None and not queue.folder_of(name).exists()
