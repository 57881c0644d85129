"""Chunks hold the work that was asked for, and every job once."""

import json
import random

from roadbed_cluster.chunks import Chunks
from roadbed_cluster.job import Job, Result


def jobs_of(kinds: list[str]) -> list[Job]:
    """Return a job of each kind."""
    return [Job(f"{i:064x}", json.dumps({"job": kind})) for i, kind in enumerate(kinds)]


def take_all(chunks: Chunks, cost_s: dict[str, float], slots: int) -> list[list[Job]]:
    """Return all chunks, observed as they are taken."""
    taken = []
    while chunk := chunks.take(slots):
        taken.append(chunk)
        costs = (cost_s[json.loads(job.line)["job"]] for job in chunk)
        chunks.observe(chunk, [Result("", "done", cost) for cost in costs])
    return taken


def test_every_job_is_in_one_chunk_in_order() -> None:
    kinds = random.Random(1).choices(["audit", "simulate"], k=5000)
    jobs = jobs_of(kinds)
    taken = take_all(Chunks(iter(jobs), 1.5), {"audit": 0.003, "simulate": 0.4}, slots=2)
    assert [job for chunk in taken for job in chunk] == jobs


def test_chunks_take_the_time_asked_for_once_it_is_known() -> None:
    taken = take_all(Chunks(iter(jobs_of(["audit"] * 9000)), 1.5), {"audit": 0.01}, slots=2)
    assert len(taken[0]) == 1
    for chunk in taken[1:20]:
        assert 140 <= len(chunk) <= 150


def test_the_last_chunks_shrink_so_that_slots_end_together() -> None:
    taken = take_all(Chunks(iter(jobs_of(["audit"] * 1000)), 1.5), {"audit": 0.01}, slots=4)
    assert len(taken[-1]) <= 2
    for index, chunk in enumerate(taken[1:], 1):
        left = sum(map(len, taken[index:]))
        assert len(chunk) <= max(1, left / 12 + 1)


def test_jobs_longer_than_a_chunk_go_alone() -> None:
    taken = take_all(Chunks(iter(jobs_of(["import"] * 50)), 1.5), {"import": 5.0}, slots=2)
    assert all(len(chunk) == 1 for chunk in taken)


def test_only_a_bounded_number_of_jobs_is_read_ahead() -> None:
    read = 0

    def endless():  # noqa: ANN202
        nonlocal read
        while True:
            read += 1
            yield Job(str(read), '{"job":"audit"}')

    chunks = Chunks(endless(), 1.5)
    for _ in range(10):
        chunk = chunks.take(1000)
        chunks.observe(chunk, [Result("", "done", 0.0)] * len(chunk))
    assert read < 30_000
