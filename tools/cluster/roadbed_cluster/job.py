"""A job as `roadbed batch` names it, and the line that says it failed."""

import json
from typing import Any, NamedTuple


class Job(NamedTuple):
    """One job that has no result yet."""

    hash: str  #: of its inputs' contents, its options and the program, as `roadbed batch` gives it
    line: str  #: the job as JSON, one line without its end, as `roadbed batch --serve` reads it


class Result(NamedTuple):
    """What became of one job."""

    line: str  #: JSON, one line without its end, as the journal keeps it
    status: str  #: `done`, `no` or `failed`
    seconds: float  #: wall-clock time that the job took on its worker


def kind_of(job: Job) -> str:
    """Return the job's kind (`import`, `validate`, ...), the empty string where it has none."""
    return str(_members(job).get("job", ""))


def _members(job: Job) -> dict[str, Any]:
    """Return what the line holds; nothing where it is no job, which `--serve` then says."""
    try:
        members = json.loads(job.line)
    except ValueError:
        return {}
    return members if isinstance(members, dict) else {}


def failed_line(job: Job, reason: str, cause: str) -> str:
    """Return the result line of a job whose process could not answer; keys as in `--serve`.

    `cause` is `crash`, `time`, `changed` or `internal`.
    """
    asked = _members(job)
    options = {
        name: value for name, value in asked.get("options", {}).items() if value is not False
    }
    result = {
        "hash": job.hash,
        "job": asked.get("job"),
        "status": "failed",
        "exit": None,
        "reason": reason,
        "cause": cause,
        "inputs": asked.get("inputs", []),
        "options": dict(sorted(options.items())),
        "outputs": sorted(asked.get("outputs", [])),
        "result": None,
        "files": [],
        "sha256": [],
    }
    return json.dumps(result, ensure_ascii=False, separators=(",", ":"))
