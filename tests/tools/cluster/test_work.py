"""A chunk's process: kept for the next job, replaced when it dies."""

from pathlib import Path

import pytest

from batches import STAND_IN, job
from roadbed_cluster.job import Job
from roadbed_cluster.serve import ServeOptions
from roadbed_cluster.work import WrongHash, end_idle_processes, run_chunk
from stand_in import hash_of


def options(folder: Path, **limits: float) -> ServeOptions:
    """Return options that start the stand-in."""
    return ServeOptions((str(STAND_IN), "batch", "--serve", "-o", str(folder)), **limits)


def asked(*lines: str) -> list[Job]:
    """Return jobs with their hashes."""
    return [Job(hash_of(line), line) for line in lines]


def test_a_chunk_answers_in_order_around_crashes(tmp_path: Path) -> None:
    jobs = asked(job(1), job(2, "crash"), job(3, "no"), job(4, "exit"), job(5))
    found = run_chunk(jobs, options(tmp_path))
    end_idle_processes()
    assert [result.status for result in found] == ["done", "failed", "no", "failed", "done"]
    assert [hash_ in result.line for (hash_, _), result in zip(jobs, found, strict=True)] == [
        True
    ] * 5


def test_memory_held_from_jobs_before_is_not_blamed_on_the_next(tmp_path: Path) -> None:
    # The second job fits a process of its own, not one that still holds the first's memory.
    keeper = tmp_path / "keeper.py"
    keeper.write_text(
        "import json, sys, time\n"
        "held = []\n"
        "for line in sys.stdin:\n"
        "    held.append(b'\\1' * 60_000_000)\n"
        "    time.sleep(0.3)\n"
        "    h = json.loads(line)['hash']\n"
        "    print(json.dumps({'hash': h, 'status': 'done'}), flush=True)\n"
    )
    jobs = [Job(h, f'{{"job":"audit","hash":"{h}"}}') for h in "abc"]
    found = run_chunk(jobs, ServeOptions(("python3", str(keeper)), memory_limit_mb=100.0))
    end_idle_processes()
    assert [result.status for result in found] == ["done"] * 3


def test_an_answer_to_another_job_stops_the_run(tmp_path: Path) -> None:
    with pytest.raises(WrongHash, match="another roadbed there"):
        run_chunk([Job("0" * 32, job(1))], options(tmp_path))
    end_idle_processes()


def test_a_program_that_is_not_there_stops_the_run(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="no-such-program: no such program"):
        run_chunk(asked(job(1)), ServeOptions(("no-such-program",)))
