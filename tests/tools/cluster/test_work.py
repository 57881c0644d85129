"""A chunk's process: kept for the next job, replaced when it dies."""

import json
import threading
from dataclasses import replace
from pathlib import Path

import pytest

from batches import STAND_IN, job
from roadbed_cluster import serve
from roadbed_cluster.job import Job
from roadbed_cluster.serve import ServeOptions, WrongWorker
from roadbed_cluster.work import end_idle_processes, run_chunk
from stand_in import hash_of


def options(folder: Path, program: Path = STAND_IN, **limits: str) -> ServeOptions:
    """Return options that start the stand-in."""
    (folder / "unfinished").write_text("mark")
    return ServeOptions(
        (str(program),), "roadbed stand-in 1", str(folder), "mark", str(folder), **limits
    )


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
    keeper = tmp_path / "keeper"  # has room for one job, and lets go of nothing
    keeper.write_text(
        "#!/usr/bin/env python3\n"
        "import json, sys\n"
        "if sys.argv[1] == '--version': print('roadbed stand-in 1'), sys.exit()\n"
        "for count, line in enumerate(sys.stdin):\n"
        "    answer = {'hash': json.loads(line)['hash'], 'status': 'done'}\n"
        "    if count: answer |= {'status': 'failed', 'cause': 'memory'}\n"
        "    print(json.dumps(answer), flush=True)\n"
    )
    keeper.chmod(0o755)
    jobs = [Job(h, f'{{"job":"audit","hash":"{h}"}}') for h in "abc"]
    found = run_chunk(jobs, options(tmp_path, keeper))
    end_idle_processes()
    assert [result.status for result in found] == ["done"] * 3


def test_an_answer_that_is_no_result_is_that_jobs_failed_line(tmp_path: Path) -> None:
    found = run_chunk(asked(job(1), job(2, "babble"), job(3)), options(tmp_path))
    end_idle_processes()
    assert [result.status for result in found] == ["done", "failed", "done"]
    assert json.loads(found[1].line)["cause"] == "internal"


def test_a_job_that_changed_meanwhile_has_failed(tmp_path: Path) -> None:
    (found,) = run_chunk([Job("0" * 64, job(1))], options(tmp_path))
    end_idle_processes()
    assert (found.status, json.loads(found.line)["cause"]) == ("failed", "changed")


def test_files_of_a_job_that_died_are_removed(tmp_path: Path) -> None:
    (asked_job,) = asked(job(1, "crash"))
    folder = tmp_path / "files" / asked_job.hash[:2]
    (folder / asked_job.hash).mkdir(parents=True)
    for name in (f"{asked_job.hash}.json", f".{asked_job.hash}.part", "another.json"):
        (folder / name).touch()
    run_chunk([asked_job], options(tmp_path))
    end_idle_processes()
    assert [path.name for path in folder.iterdir()] == ["another.json"]


def test_a_worker_that_outlives_its_run_leaves_the_files_of_the_next_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(serve, "_SEEN_S", 0.0)
    mine = options(tmp_path)
    slow, after = asked(job(1, "crash", seconds=1.0), job(2))
    (tmp_path / "files" / slow.hash[:2]).mkdir(parents=True)
    kept = tmp_path / "files" / slow.hash[:2] / f".{slow.hash}.part"
    kept.touch()
    next_run = threading.Timer(0.5, (tmp_path / "unfinished").write_text, ["of the next run"])
    next_run.start()
    with pytest.raises(WrongWorker, match="is not the same folder"):
        run_chunk([slow, after], replace(mine, tries=1))
    end_idle_processes()
    assert kept.exists()


def test_another_folder_under_the_same_path_stops_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(serve, "_SEEN_S", 0.0)
    mine = options(tmp_path)
    (tmp_path / "unfinished").write_text("of another run")
    with pytest.raises(WrongWorker, match="is not the same folder on a worker as here"):
        run_chunk(asked(job(1)), mine)


def test_another_program_on_a_worker_stops_the_run(tmp_path: Path) -> None:
    with pytest.raises(WrongWorker, match="no-such-program cannot be run"):
        run_chunk(asked(job(1)), options(tmp_path, Path("no-such-program")))
    other = replace(options(tmp_path), version="roadbed stand-in 2")
    with pytest.raises(
        WrongWorker, match="is 'roadbed stand-in 1' on a worker, 'roadbed stand-in 2' here"
    ):
        run_chunk(asked(job(1)), other)
