#!/usr/bin/env python3
"""Measures what batches cost; usage: measure.py [ROADBED].

Prints what the README's tables hold: what a job costs beside its work, how busy two workers are,
what the scheduler, the journal and the tables take a job, and the memory of client and workers by
the number of jobs. Jobs of the stand-in; with the program ROADBED, 1,000 and 4,000 audits and 300
simulations of data/ too.
"""

import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil
from distributed import Client

from batches import STAND_IN, job, write_jobs
from dask_processes import DaskProcesses, Process
from roadbed_cluster import tables
from roadbed_cluster.batch import Batch
from roadbed_cluster.chunks import Chunks
from roadbed_cluster.dispatch import Dispatcher
from roadbed_cluster.job import Job, Result
from roadbed_cluster.journal import Journal
from roadbed_cluster.progress import Progress
from roadbed_cluster.serve import ServeOptions, version_of
from roadbed_cluster.work import run_chunk

SLOTS = 2
DATA = Path(__file__).parents[3] / "data"


class WatchedChunks(Chunks):
    """Sums what the jobs took on their workers, and counts the chunks."""

    work_s = 0.0
    count = 0

    def observe(self, jobs: list[Job], results: list[Result]) -> None:
        """Learn from a finished chunk."""
        self.work_s += sum(result.seconds for result in results)
        self.count += 1
        super().observe(jobs, results)


@contextmanager
def cluster(folder: Path) -> Iterator[tuple[DaskProcesses, Client]]:
    """Give a scheduler, two workers and a client."""
    folder.mkdir()
    with DaskProcesses(folder, are_forked=False) as dask:
        dask.start_hosts(SLOTS)
        with Client(dask.address) as client:
            yield dask, client


def peak_mb(pid: int) -> float:
    """Return the largest resident size that a process had."""
    for line in Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmHWM"):
            return int(line.split()[1]) / 1000
    return 0.0


def cpu_s(process: Process) -> float:
    """Return the processor time of a process so far."""
    times = psutil.Process(process.pid).cpu_times()
    return float(times.user + times.system)


def batch_row(name: str, program: str, jobs: Path, folder: Path) -> None:
    """Run a batch on two workers that are there already, and print its row."""
    folder.mkdir()
    batch = Batch((program,), jobs, folder / "out")
    with cluster(folder / "dask") as (dask, client):
        chunks = WatchedChunks(batch.missing(), 1.5)
        before_s = cpu_s(dask.scheduler)
        with Journal(batch.output) as journal:
            serve = ServeOptions(
                (program,), version_of((program,)), str(batch.output), journal.mark, str(Path.cwd())
            )
            dispatcher = Dispatcher(client, chunks, journal, serve, Progress(True), 60.0)
            begin, own_s = time.monotonic(), time.process_time()
            dispatcher.run()
            wall_s, own_s = time.monotonic() - begin, time.process_time() - own_s
        scheduler_s = cpu_s(dask.scheduler) - before_s
        peaks = client.run(lambda: (os.getpid(), [c.pid for c in psutil.Process().children()]))
        worker_mb = max(peak_mb(pid) for pid, _ in peaks.values())
        serve_mb = max(peak_mb(child) for _, children in peaks.values() for child in children)
    done = dispatcher.by_status.total()
    size = (batch.output / "journal" / "cluster.jsonl").stat().st_size
    overhead_ms = 1000 * (SLOTS * wall_s - chunks.work_s) / done
    print(
        f"| {name} | {done} | {chunks.count} | {1000 * chunks.work_s / done:.2f} | {wall_s:.1f} | "
        f"{overhead_ms:.2f} | {100 * chunks.work_s / SLOTS / wall_s:.1f} % | "
        f"{1000 * own_s / done:.3f} | {1000 * scheduler_s / chunks.count:.2f} | "
        f"{worker_mb:.0f} | {serve_mb:.0f} | {peak_mb(os.getpid()):.0f} | {size / done:.0f} |",
        flush=True,
    )


def scheduler_row(folder: Path) -> None:
    """Print what the scheduler takes for a chunk that does nothing."""
    tasks = 5000
    with cluster(folder) as (dask, client):
        before_s = cpu_s(dask.scheduler)
        begin = time.monotonic()
        for start in range(0, tasks, 500):
            futures = [
                client.submit(run_chunk, [], ServeOptions(("none",), "", "", "", ""), pure=False)
                for _ in range(start, start + 500)
            ]
            client.gather(futures)
        wall_s = time.monotonic() - begin
        taken_s = cpu_s(dask.scheduler) - before_s
    print(f"scheduler: {1000 * taken_s / tasks:.3f} ms of processor a chunk, so at most "
          f"{tasks / taken_s:.0f} chunks a second; with client and workers on the same cores "
          f"{tasks / wall_s:.0f} a second")  # fmt: skip


def listing_row(program: str, jobs: Path, folder: Path) -> None:
    """Print how many jobs a second are told to be missing, and the memory that takes."""
    count = sum(1 for _ in jobs.open())
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    found = sum(1 for _ in Batch((program,), jobs, folder / "listing").missing())
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    taken_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"listing, jobs: {count / taken_s:.0f} a second ({found} of {count})")


def rate(what: str, count: int, work: Callable[[], object]) -> None:
    """Print how many of `count` things `work` does a second of processor time."""
    before_s = time.process_time()
    work()
    print(f"{what}: {count / (time.process_time() - before_s):.0f} a second")


def client_rows(folder: Path) -> None:
    """Print the rates of what the client alone does."""
    count = 50_000
    line = json.dumps({"hash": "0" * 32, "job": "audit", "status": "done", "exit": 0,
                       "reason": "", "cause": None, "inputs": [], "options": {"inflate": 0.2},
                       "outputs": [], "result": {"verdict": "clear", "least_clearance_m": 0.5},
                       "files": []})  # fmt: skip
    with Journal(folder / "rates") as journal:
        chunks = [[line] * 100] * (count // 100)
        rate("journal, lines", count, lambda: [journal.append(chunk) for chunk in chunks])
    (folder / "rates" / "results.jsonl").write_text(f"{line}\n" * count, encoding="utf-8")
    rate("tables, rows", count, lambda: tables.write_tables(folder / "rates"))
    size = (folder / "rates" / "tables" / "audit.parquet").stat().st_size
    print(f"tables: {size / count:.1f} bytes a row like all others, {len(line)} bytes as JSON")


def write_audits(path: Path, folder: Path, program: str, count: int) -> Path:
    """Write audits of the drive across the town, each inflated by another length."""
    drive = folder / "drive"
    if not drive.exists():
        words = [program, "--quiet", "simulate", DATA / "drive.json", "-o", drive]
        subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    options = {"occupancy": str(DATA / "town.bt"), "trajectory": str(drive / "trajectory.csv")}
    return write_jobs(path, (
        json.dumps({"job": "audit", "options": {**options, "inflate": number / count}})
        for number in range(count)
    ))  # fmt: skip


def write_simulations(path: Path, folder: Path, count: int) -> Path:
    """Write simulations of the scenarios, with as many seeds as it takes."""
    data = folder / "data"
    shutil.copytree(DATA, data)
    scenarios = sorted((data / "scenarios").glob("*.json"))
    lines = []
    for number in range(count):
        scenario = scenarios[number % len(scenarios)]
        seeded = scenario.with_name(f"{number}.json")
        seeded.write_text(json.dumps({**json.loads(scenario.read_text()), "seed": number}))
        lines.append(json.dumps({"job": "simulate", "inputs": [str(seeded)]}))
    return write_jobs(path, lines)


def main() -> int:
    """Print all."""
    if len(sys.argv) > 2 or sys.argv[1:2] == ["--help"]:
        print(__doc__)
        return 2
    program = sys.argv[1] if len(sys.argv) == 2 else None
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores at the start")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scheduler_row(folder / "scheduler")
        print("| batch | jobs | chunks | work [ms a job] | wall [s] | overhead [ms a job] | "
              "two workers busy | client [ms a job] | scheduler [ms a chunk] | "
              "worker [MB] | roadbed [MB] | client [MB] | journal [bytes a job] |")  # fmt: skip
        print("|---" * 13 + "|")
        jobs = folder / "jobs.jsonl"
        for count in (1000, 10_000):
            write_jobs(jobs, (job(i) for i in range(count)))
            batch_row("stand-in, no work", str(STAND_IN), jobs, folder / f"none{count}")
        write_jobs(jobs, (job(i, "sleep", seconds=0.02) for i in range(1000)))
        batch_row("stand-in, 20 ms", str(STAND_IN), jobs, folder / "sleep")
        if program is not None:
            for count in (1000, 4000):
                write_audits(jobs, folder, program, count)
                batch_row("audits", program, jobs, folder / f"audits{count}")
            write_audits(jobs, folder, program, 100_000)
            listing_row(program, jobs, folder)
            write_simulations(jobs, folder, 300)
            batch_row("simulations", program, jobs, folder / "simulations")
        client_rows(folder)
    print(f"load {os.getloadavg()[0]:.1f} at the end")
    return 0


if __name__ == "__main__":
    sys.exit(main())
