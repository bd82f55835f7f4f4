"""Requests of the page: checks of the form, jobs and their files, decks; all answers are JSON."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, PlainTextResponse, Response
from starlette.routing import Route

from umform.bench.decks import checked_deck, known_templates, schema_text, title_of
from umform.bench.errors_as_json import error_record, problems_of
from umform.bench.folders import METAL, RESULTS, SCENE, SHAPE, TABLE
from umform.bench.form_check import look
from umform.bench.gone import gone
from umform.bench.index import Job
from umform.bench.jobs import MOST_WAITING, Queue, result_file
from umform.bench.library import library
from umform.bench.parts import PARTS, Parts
from umform.bench.strips import FILES as STRIP_FILES
from umform.bench.tables import converted, style_of, table_of
from umform.bench.verdicts import verdict
from umform.bench.wanted import Wanted
from umform.errors import InvalidValue, UmformError
from umform.flat_pattern import FILES as FLAT_FILES
from umform.io.tables import CSV_STYLES
from umform.problem.measured import OF_ONE
from umform.problem.results import CHECKPOINT
from umform.problem.results import FILES as DECK_FILES
from umform.problem.templates import template
from umform.processes.air_bending.files import RESULTS as BEND_FILES
from umform.processes.draw.files import FILES as DRAW_FILES

_FILES = frozenset({*BEND_FILES, *DECK_FILES, *STRIP_FILES, *FLAT_FILES, *DRAW_FILES, METAL, SHAPE})
#: Names of the files of bend tables; most follow from the setups.
_OF_TABLES = re.compile(r"bends\.(csv|json)|[A-Za-z0-9][A-Za-z0-9.-]{0,120}\.(FCStd|bnd|inventor\.txt|solidworks\.txt)")
#: Reports contain programs. They are served without an origin, so that they cannot use this server.
_SANDBOX = "sandbox allow-scripts allow-downloads allow-popups"
_SHOWN = (".html", ".png", ".svg")
#: Most bends of a table that is ordered at once.
_MOST_AT_ONCE = 60
_Json = dict[str, Any]


def routes(queue: Queue) -> list[Route]:
    """All routes of the API."""
    api = _Api(queue)
    get: dict[str, Callable[[Request], _Json | Response]] = {
        "/api/library": lambda request: library(),
        "/api/jobs": api.jobs,
        "/api/jobs.csv": api.table,
        "/api/jobs/{name}": api.job,
        "/api/jobs/{name}/curve": api.curve,
        "/api/jobs/{name}/scene": api.scene,
        "/api/tools": lambda request: {"tools": queue.shelf.rows()},
        "/api/parts": lambda request: {"parts": api.parts.rows()},
        "/api/decks": lambda request: {"templates": known_templates()},
        "/api/decks/schema": lambda request: Response(schema_text(), media_type="application/json"),
        "/api/decks/template/{name}": lambda request: {"text": template(request.path_params["name"])},
        "/files/{name}/{file}": api.file,
    }
    post: dict[str, Callable[[Any, Request], _Json]] = {
        "/api/look": lambda body, request: look(body, queue.shelf, api.parts),
        "/api/tools": api.add_tool,
        "/api/tools/remove": api.remove_tool,
        "/api/parts": api.add_part,
        "/api/parts/remove": api.remove_part,
        "/api/jobs": api.add,
        "/api/decks/check": lambda body, request: checked_deck(_text(body), queue.folder),
        "/api/decks/jobs": api.add_deck,
        "/api/jobs/{name}/stop": api.stop,
        "/api/jobs/{name}/resume": api.resume,
        "/api/jobs/{name}/remove": api.remove,
    }
    return [
        *(Route(path, _get_endpoint(handler), methods=["GET"]) for path, handler in get.items()),
        *(Route(path, _post_endpoint(handler), methods=["POST"]) for path, handler in post.items()),
    ]


def _get_endpoint(handler: Callable[[Request], _Json | Response]) -> Callable[[Request], Any]:
    async def endpoint(request: Request) -> Response:
        try:
            answer = await run_in_threadpool(handler, request)
        except UmformError as error:
            return JSONResponse(error_record(error), 404)
        return answer if isinstance(answer, Response) else JSONResponse(answer)

    return endpoint


def _post_endpoint(handler: Callable[[Any, Request], _Json]) -> Callable[[Request], Any]:
    async def endpoint(request: Request) -> Response:
        if request.headers.get("content-type", "").split(";")[0] != "application/json":
            return PlainTextResponse("a request must be JSON", 415)
        try:
            body = json.loads(await request.body(), parse_constant=_no_constant)
            json.dumps(body, ensure_ascii=False).encode()  # half a surrogate pair cannot be written to files
        except (ValueError, RecursionError):
            return JSONResponse({"what": "the request is not valid JSON"}, 400)
        try:
            return JSONResponse(await run_in_threadpool(handler, body, request))
        except UmformError as error:
            return JSONResponse({**error_record(error), "problems": problems_of(error)}, 422)

    return endpoint


def _no_constant(name: str) -> None:
    raise ValueError(name)


def _text(body: Any, name: str = "text") -> str:
    """A text of a request."""
    if not isinstance(body, dict) or not isinstance(body.get(name), str):
        raise InvalidValue("a text is missing in the request", where=name)
    return str(body[name])


class _Api:
    """Requests about jobs."""

    def __init__(self, queue: Queue) -> None:
        self.queue, self.parts = queue, Parts(queue.folder)

    def jobs(self, request: Request) -> _Json:
        """All jobs, the latest first, and how far those are that run."""
        jobs = self.queue.index.jobs()
        full = self.queue.disk.problem()
        rows = [self._row(job) for job in reversed(jobs[-500:])]
        return {"jobs": rows, "full": None if full is None else error_record(full)}

    def job(self, request: Request) -> _Json:
        """A job with its numbers, live data and files."""
        job = self._job_of(request)
        folder = self.queue.folder_of(job.id)
        there = folder / RESULTS
        files = sorted(one.name for one in there.iterdir() if _is_known(one.name)) if there.is_dir() else []
        shape = (folder / SHAPE).is_file()
        kept = (there / CHECKPOINT).is_file()
        known = {"files": files, "has_shape": shape, "has_checkpoint": kept}
        return {**asdict(job), "live": self.queue.live(job.id), **known}

    def _row(self, job: Job) -> _Json:
        row = asdict(job)
        measures = job.summary.get("measures", {})
        live = self.queue.live(job.id) if job.state == "running" else {}
        press = job.summary.get("press")
        row["summary"] = {"measures": measures, "seconds": job.summary.get("seconds"), "press": press}
        row["summary"]["verdict"] = verdict(job.summary) if job.state == "done" else ""
        return row | {"fraction": live.get("fraction", 0.0), "phase": live.get("phase", "")}

    def _job_of(self, request: Request) -> Job:
        name = request.path_params["name"]
        job = self.queue.index.job(name)
        if job is None:
            raise gone("there is no such job", "job", name)
        return job

    def add(self, body: Any, request: Request) -> _Json:
        """Order bends: one form, or a list of them as a series."""
        forms = body.get("forms") if isinstance(body, dict) else None
        if not isinstance(forms, list) or not 1 <= len(forms) <= min(_MOST_AT_ONCE, MOST_WAITING):
            raise InvalidValue(
                f"1 to {_MOST_AT_ONCE} bends are ordered at once",
                where="forms",
                cause="a series of too many values",
                remedy="several series, one after the other",
            )
        wanted = [Wanted.read(form) for form in forms]
        good, refused = [], []
        for number, one in enumerate(wanted):
            try:
                good.append(self._checked(one))
            except UmformError as error:
                if len(wanted) == 1:
                    raise
                refused.append({**error_record(error), "form": number, "title": one.title})
        series = str(body.get("series", ""))[:80]
        add = self.queue.add
        names = [
            add("bend", one.title, dict(one.values), series=series, tools=one.drawn, **self._with(one)) for one in good
        ]
        return {"jobs": names, "refused": refused}

    def _checked(self, wanted: Wanted) -> Wanted:
        """A form that can be run, with the sizes of its drawn tools."""
        if wanted.choices.work == "flat":
            wanted.tooling(self.parts.row(wanted.values["part"])["thickness"])
            return wanted
        if wanted.is_drawn:
            wanted.draw()
            return wanted
        return wanted.as_ordered(wanted.case(self.queue.shelf))

    def _with(self, wanted: Wanted) -> dict[str, Any]:
        """Files and entries of the order that a job needs besides its form: a part, a table."""
        values = wanted.values
        if wanted.choices.work == "flat":
            row = self.parts.row(values["part"])
            copies = {row["name"]: self.parts.path_of(row["name"]), SHAPE: self.parts.view_of(row["name"])}
            return {"files": copies, "more": {"part": row}}
        name = values.get("issue_again")
        if name is None:
            return {}
        job = self.queue.index.job(name)
        if job is None or wanted.choices.material not in job.parameters.get("metals", ()):
            raise InvalidValue(
                "this is no table of this metal",
                where="issue_again",
                value=name[:40],
                cause="another metal, or a table that was deleted",
                remedy="order a bend table of this metal first",
            )
        return {"files": {TABLE: result_file(self.queue, name, "bends.json", _is_known)}}

    def add_part(self, body: Any, request: Request) -> _Json:
        """Read the STEP file of a part and keep it."""
        name, content = (_text(body, part) for part in ("name", "content"))
        full = self.queue.disk.problem()
        if full is not None:
            raise full
        return self.parts.add(name, content)

    def remove_part(self, body: Any, request: Request) -> _Json:
        """Delete a part."""
        self.parts.remove(_text(body, "name"))
        return {}

    def add_deck(self, body: Any, request: Request) -> _Json:
        """Order the run of a deck."""
        text = _text(body)
        title = title_of(text)
        return {"jobs": [self.queue.add("deck", title, {}, deck=text)]}

    def add_tool(self, body: Any, request: Request) -> _Json:
        """Read the drawing of a tool and store it."""
        kind, name, layer, drawing = (_text(body, part) for part in ("kind", "name", "layer", "drawing"))
        full = self.queue.disk.problem()
        if full is not None:
            raise full
        return self.queue.shelf.add(kind, name, layer, drawing)

    def remove_tool(self, body: Any, request: Request) -> _Json:
        """Delete a drawn tool."""
        self.queue.shelf.remove(_text(body, "kind"), _text(body, "name"))
        return {}

    def stop(self, body: Any, request: Request) -> _Json:
        """Stop a job."""
        self.queue.stop(self._job_of(request).id)
        return {}

    def resume(self, body: Any, request: Request) -> _Json:
        """Resume a job."""
        self.queue.resume(self._job_of(request).id)
        return {}

    def remove(self, body: Any, request: Request) -> _Json:
        """Delete a job."""
        if not self.queue.remove(self._job_of(request).id):
            raise InvalidValue("a job that runs is not deleted", where="job", remedy="stop it first")
        return {}

    def curve(self, request: Request) -> _Json:
        """The curve of a bend from its file."""
        path = result_file(self.queue, self._job_of(request).id, "curve.csv", _is_known)
        with path.open(newline="") as text:
            _, *rows = csv.reader(text)  # step, stroke, force
        return {"x": [float(row[1]) for row in rows], "y": [float(row[2]) for row in rows]}

    def scene(self, request: Request) -> Response:
        """The present scene of a job, for a page of its shape that is shown."""
        path = self.queue.folder_of(self._job_of(request).id) / SCENE
        if path.is_symlink() or not path.is_file():
            raise InvalidValue(
                "this job has no shape yet",
                where="scene",
                cause="it waits, or has solved no increment",
                remedy="look again when it runs",
            )
        return FileResponse(path, media_type="application/json")

    def file(self, request: Request) -> Response:
        """A file of a job, or the 3D view of a part."""
        name, file = request.path_params["name"], request.path_params["file"]
        path = self.parts.view_of(file) if name == PARTS else result_file(self.queue, name, file, _is_known)
        if not path.is_file():
            raise gone("there is no such part", "part", file)
        kind = "inline" if path.suffix in _SHOWN else "attachment"
        language = request.query_params.get("language", "")
        if path.suffix == ".csv" and style_of(language) != CSV_STYLES["plain"]:
            headers = {"content-disposition": f'attachment; filename="{path.name}"'}
            return Response(converted(path, language), media_type="text/csv", headers=headers)
        headers = {"content-security-policy": _SANDBOX} if path.suffix in (".html", ".svg") else {}
        return FileResponse(path, filename=path.name, content_disposition_type=kind, headers=headers)

    def table(self, request: Request) -> Response:
        """Some jobs as a table with all quantities, for a spreadsheet in the language of the page."""
        names = request.query_params.get("ids", "")[:20000].split(",")[:500]
        jobs = [
            job
            for job in map(self.queue.index.job, names)
            if job is not None and job.summary.keys() & {"quantities", "measures"}
        ]
        language = request.query_params.get("language", "")
        headers = {"content-disposition": 'attachment; filename="bends.csv"'}
        return Response(table_of(jobs, language), media_type="text/csv", headers=headers)


def _is_known(name: str) -> bool:
    """Whether jobs write files of this name."""
    return name in _FILES or any(pattern.fullmatch(name) for pattern in (_OF_TABLES, OF_ONE))
