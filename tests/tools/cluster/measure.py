#!/usr/bin/env python3
"""Measures what batches cost; usage: measure.py [ROADBED].

Prints the tables of tools/cluster/README.md: what a job costs beside its work, how busy two workers
are, the memory of client and workers by the number of jobs, and what the scheduler, listing,
merging, the journal and the tables take. Jobs of the stand-in; with the program ROADBED, audits and
simulations of data/ too.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import psutil
from distributed import Client

from batches import STAND_IN, job, write_jobs
from dask_processes import DaskProcesses
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


def cpu_s(pid: int) -> float:
    """Return the processor time of a process so far."""
    times = psutil.Process(pid).cpu_times()
    return float(times.user + times.system)


def served_by(client: Client) -> tuple[list[int], list[int]]:
    """Return the pids of the workers, and of the programs that they started."""

    def look() -> tuple[int, list[int]]:
        return os.getpid(), [child.pid for child in psutil.Process().children()]

    found = client.run(look).values()
    return [pid for pid, _ in found], [child for _, children in found for child in children]


def batch_row(name: str, program: str, jobs: Path, folder: Path) -> None:
    """Run a batch on two workers that are there already, and print its row."""
    folder.mkdir()
    batch = Batch((program,), jobs, folder / "out")
    with cluster(folder / "dask") as (_, client):
        chunks = WatchedChunks(batch.missing(), 1.5)
        with Journal(batch.output) as journal:
            serve = ServeOptions(
                (program,), version_of((program,)), str(batch.output), journal.mark, str(Path.cwd())
            )
            dispatcher = Dispatcher(client, chunks, journal, serve, Progress(True), 60.0)
            begin, own_s = time.monotonic(), time.process_time()
            dispatcher.run()
            wall_s, own_s = time.monotonic() - begin, time.process_time() - own_s
        workers, programs = served_by(client)
        worker_mb, program_mb = (max(map(peak_mb, pids)) for pids in (workers, programs))
        program_s = sum(cpu_s(pid) for pid in programs)
    done = dispatcher.by_status.total()
    overhead_ms = 1000 * (SLOTS * wall_s - chunks.work_s) / done
    print(
        f"| {name} | {done:,} | {chunks.count} | {1000 * chunks.work_s / done:.2f} | "
        f"{1000 * program_s / done:.2f} | {overhead_ms:.2f} | "
        f"{100 * chunks.work_s / SLOTS / wall_s:.1f} % | {100 * program_s / wall_s:.0f} % | "
        f"{1000 * own_s / done:.3f} | {worker_mb:.0f} | {program_mb:.0f} | "
        f"{peak_mb(os.getpid()):.0f} |",
        flush=True,
    )


def rate_row(what: str, count: int, seconds: float, note: str = "") -> None:
    """Print the row of what takes `seconds` of processor time for `count` things."""
    each = f"{1e6 * seconds / count:.1f}"
    print(f"| {what} | {each} | {float(f'{count / seconds:.2g}'):,.0f} | {note} |", flush=True)


def scheduler_row(folder: Path) -> None:
    """Print what the scheduler takes for a chunk that does nothing."""
    tasks = 5000
    with cluster(folder) as (dask, client):
        before_s = cpu_s(dask.scheduler.pid)
        for start in range(0, tasks, 500):
            futures = [
                client.submit(run_chunk, [], ServeOptions(("none",), "", "", "", ""), pure=False)
                for _ in range(start, start + 500)
            ]
            client.gather(futures)
        taken_s = cpu_s(dask.scheduler.pid) - before_s
    rate_row("scheduler: a chunk out and back", tasks, taken_s)


def run_child(command: list[str]) -> tuple[bytes, float, float]:
    """Return what a command prints, its processor time, and its peak memory in MB."""
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        printed = process.stdout.read()
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode in (0, 1)
    return printed, used.ru_utime + used.ru_stime, used.ru_maxrss / 1000


def batch_rows(program: str, folder: Path) -> None:
    """Print what `roadbed batch` takes to list jobs, and to merge their results."""
    few, many = (list_and_merge(program, folder, count) for count in (100_000, 200_000))
    for what, less, more in zip(
        ("list-missing`: a job", "merge`: a result"), few, many, strict=True
    ):
        # The difference, as a process's peak begins with that of who started it.
        each = 1e6 * (more[1] - less[1]) / 100_000
        rate_row(f"`roadbed batch --{what}", 200_000, more[0], f"{each:.0f} bytes of memory")


def list_and_merge(program: str, folder: Path, count: int) -> list[tuple[float, float]]:
    """Return the processor time and the peak memory in MB of listing, and of merging."""
    output = folder / f"many{count}"
    jobs = write_audits(folder / "many.jsonl", folder, program, count)
    batch = [program, "batch", str(jobs), "-o", str(output)]
    listed, *listing = run_child([*batch, "--list-missing"])
    (output / "journal").mkdir(parents=True)
    with (output / "journal" / "cluster.jsonl").open("wb") as journal:
        for row in listed.splitlines():
            hash_, line = row.split(b"\t")
            options = json.loads(line)["options"]
            journal.write(result_line(hash_.decode(), options).encode() + b"\n")
    _, *merging = run_child([*batch, "--merge", "--quiet"])
    return [(listing[0], listing[1]), (merging[0], merging[1])]


def result_line(hash_: str, options: dict[str, object]) -> str:
    """Return the result of an audit as the journal holds it."""
    return json.dumps({"hash": hash_, "job": "audit", "status": "done", "exit": 0, "reason": "",
                       "cause": None, "inputs": [], "options": options, "outputs": [],
                       "result": {"verdict": "clear", "least_clearance_m": 0.5},
                       "files": [], "sha256": []})  # fmt: skip


def client_rows(folder: Path) -> None:
    """Print what journal and tables take."""
    count = 50_000
    line = result_line("0" * 32, {"inflate": 0.2})
    with Journal(folder / "rates") as journal:
        before_s = time.process_time()
        for _ in range(count // 100):
            journal.append([line] * 100)
        rate_row("journal: a result", count, time.process_time() - before_s, f"{len(line)} bytes")
    (folder / "rates" / "results.jsonl").write_text(f"{line}\n" * count, encoding="utf-8")
    before_s = time.process_time()
    tables.write_tables(folder / "rates")
    rate_row("Parquet: a row", count, time.process_time() - before_s)


def write_audits(path: Path, folder: Path, program: str, count: int) -> Path:
    """Write audits of a drive between two walls, each inflated by another length."""
    drive, walls = folder / "drive", folder / "walls.bt"
    if not drive.exists():
        gap = DATA / "scenarios" / "narrow_gap.json"
        for words in (["simulate", gap, "-o", drive],
                      ["occupancy", "build", gap.with_suffix(".pcd"), "--resolution", "0.4",
                       "-o", walls]):  # fmt: skip
            subprocess.run([program, "--quiet", *words], check=True, stdout=subprocess.DEVNULL)
    options = {"occupancy": str(walls), "trajectory": str(drive / "trajectory.csv")}
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


def machine() -> str:
    """Return the date and what this was measured on."""
    memory_gb = psutil.virtual_memory().total / 1e9
    return f"{time.strftime('%Y-%m-%d')}, {os.cpu_count()} cores, {memory_gb:.0f} GB"


def print_batches(folder: Path, program: str | None) -> None:
    """Print the table of batches."""
    print("| batch | jobs | chunks | work [ms a job] | its processor time [ms a job] | "
          "overhead [ms a job] | two workers busy | processor time of the work by wall time | "
          "client [ms a job] | worker [MB] | roadbed [MB] | client [MB] |")  # fmt: skip
    print("|---" * 12 + "|")
    jobs = folder / "jobs.jsonl"
    for count in (1000, 10_000):
        write_jobs(jobs, (job(i) for i in range(count)))
        batch_row("stand-in: nothing to do", str(STAND_IN), jobs, folder / f"none{count}")
    write_jobs(jobs, (job(i, "sleep", seconds=0.02) for i in range(1000)))
    batch_row("stand-in: 20 ms each", str(STAND_IN), jobs, folder / "sleep")
    if program is not None:
        for count in (1000, 10_000):
            write_audits(jobs, folder, program, count)
            batch_row("roadbed: audits", program, jobs, folder / f"audits{count}")
        write_simulations(jobs, folder, 300)
        batch_row("roadbed: simulations", program, jobs, folder / "simulations")


def print_rates(folder: Path, program: str | None) -> None:
    """Print the table of what a thing takes."""
    print("| what | processor time [µs] | a second | |\n|---|---|---|---|")
    scheduler_row(folder / "scheduler")
    if program is not None:
        batch_rows(program, folder)
    client_rows(folder)


def main() -> int:
    """Print all."""
    if len(sys.argv) > 2 or sys.argv[1:2] == ["--help"]:
        print(__doc__)
        return 2
    program = sys.argv[1] if len(sys.argv) == 2 else None
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as name:
        print_batches(Path(name), program)
        print()
        print_rates(Path(name), program)
    print(f"\n{machine()}, load {load:.1f} at the start, {os.getloadavg()[0]:.1f} at the end")
    return 0


if __name__ == "__main__":
    sys.exit(main())
