"""What dies is done again: nothing lost, nothing twice, the bytes of the sequential run."""

import os
import resource
import signal
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest

from batches import job, journal, results, run, run_sequentially, start, write_jobs
from dask_processes import DaskProcesses, children_of, command_of, wait_until
from warm import roadbed_cluster

JOBS = 1000
SLEEP_S = 0.04


@pytest.fixture
def dask(tmp_path: Path) -> Iterator[DaskProcesses]:
    """Give a scheduler on 127.0.0.1 with no worker yet."""
    folder = tmp_path / "dask"
    folder.mkdir()
    with DaskProcesses(folder) as processes:
        yield processes


class Run:
    """A run in the background, watched through its journal."""

    def __init__(self, jobs: Path, output: Path, *arguments: object) -> None:
        """Start it."""
        self.output = output
        self.process = start(jobs, "-o", output, "--quiet", *arguments)

    def done(self) -> int:
        """Return how many results it has kept."""
        try:
            return len(journal(self.output))
        except (FileNotFoundError, ValueError):
            return 0

    def wait_for(self, more: int) -> None:
        """Return once it has kept `more` results than now."""
        goal = self.done() + more
        wait_until(lambda: self.done() >= goal or self.process.poll() is not None, "results")
        assert self.process.poll() is None, f"the run ended before the fault: {self.end()}"

    def end(self) -> tuple[int, str]:
        """Return its exit status and what it said."""
        _, said = self.process.communicate(timeout=300)
        return self.process.wait(), said


def same_as_sequential(jobs: Path, output: Path) -> bool:
    """Return whether results and their number are those of `roadbed batch` alone."""
    hashes = journal(output)
    expected = run_sequentially(jobs, output.with_name("sequential"))
    assert len(set(hashes)) == len(hashes), "a result is in the journal twice"
    return (output / "results.jsonl").read_bytes() == expected


def sleeping_jobs(folder: Path, count: int) -> Path:
    """Write `count` jobs of 40 ms."""
    lines = (job(seed, "sleep", seconds=SLEEP_S) for seed in range(count))
    return write_jobs(folder / "jobs.jsonl", lines)


def go_through(tmp_path: Path, dask: DaskProcesses, jobs: int, kills: int, step: int) -> None:
    """Kill `kills` workers, a host, the scheduler and the client; compare what comes out."""
    jobs_file = sleeping_jobs(tmp_path, jobs)
    hosts = dask.start_hosts(3)
    first = Run(jobs_file, tmp_path / "out", "--scheduler", dask.address, "--chunk", 0.3)
    for kill in range(kills):
        first.wait_for(step)
        os.kill(dask.worker_of(hosts[1 + kill % 2]), signal.SIGKILL)
    first.wait_for(step)
    dask.kill_host(hosts[0])
    first.wait_for(step)
    dask.scheduler.kill()
    status, said = first.end()
    assert status == 3
    assert said.startswith("roadbed-cluster: the scheduler is gone after ")
    assert len(said.splitlines()) == 1
    assert first.done() < jobs

    dask.start_scheduler()
    dask.start_hosts(1)
    second = Run(jobs_file, tmp_path / "out", "--scheduler", dask.address)
    second.wait_for(step)
    second.process.kill()
    second.process.wait()
    third = Run(jobs_file, tmp_path / "out", "--scheduler", dask.address)
    assert third.end() == (0, "")
    assert len(journal(tmp_path / "out")) == jobs
    assert same_as_sequential(jobs_file, tmp_path / "out")


def test_a_batch_survives_its_worker_host_scheduler_and_client(
    tmp_path: Path, dask: DaskProcesses
) -> None:
    go_through(tmp_path, dask, jobs=400, kills=1, step=20)


@pytest.mark.campaign
def test_a_thousand_jobs_survive_five_workers_a_host_the_scheduler_and_the_client(
    tmp_path: Path, dask: DaskProcesses
) -> None:
    go_through(tmp_path, dask, jobs=JOBS, kills=5, step=40)


@pytest.mark.parametrize(
    "workers",
    [pytest.param(1, marks=pytest.mark.campaign), 2, pytest.param(4, marks=pytest.mark.campaign)],
)
def test_any_number_of_workers_gives_the_bytes_of_the_sequential_run(
    tmp_path: Path, workers: int
) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", (job(seed % 180) for seed in range(200)))
    ended = run(jobs, "-o", tmp_path / "out", "--workers", workers)
    assert ended.returncode == 0, ended.stderr
    assert "180 jobs in " in ended.stderr and ": 180 done" in ended.stderr
    assert same_as_sequential(jobs, tmp_path / "out")


@pytest.mark.campaign
def test_a_second_run_does_only_what_changed(tmp_path: Path) -> None:
    source = tmp_path / "map.txt"
    source.write_text("a map")
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1), job(2, inputs=[source])])
    assert run(jobs, "-o", tmp_path / "out", "--workers", 1).returncode == 0
    source.write_text("a changed map")
    again = run(jobs, "-o", tmp_path / "out", "--workers", 1)
    assert again.returncode == 0
    assert again.stderr.splitlines()[-1].endswith(": 1 done")


def test_a_job_that_misbehaves_is_one_failed_line_with_its_reason(tmp_path: Path) -> None:
    bad = {
        "crash": "killed by signal 11 (SIGSEGV)",
        "exit": "its process ended with exit status 3",
        "hang": "took longer than 8 s",
        "eat": "out of memory",
    }
    lines = []
    for seed, do in enumerate(bad):
        lines += [job(2 * seed), job(2 * seed + 1, do), job(100 + seed, "chatter")]
    lines.append(job(200, inputs=[tmp_path / "gone.xodr"]))
    jobs = write_jobs(tmp_path / "jobs.jsonl", lines)
    ended = run(
        jobs, "-o", tmp_path / "out", "--workers", 2, "--time-limit", 8, "--job-memory", "200MB"
    )
    assert ended.returncode == 0, ended.stderr
    found = results(tmp_path / "out")
    assert len(found) == len(lines)
    for result in found:
        do = result["options"]["do"]
        if result["inputs"]:
            assert (result["status"], result["reason"]) == (
                "failed",
                f"{tmp_path / 'gone.xodr'}: no such file",
            )
        elif do in bad:
            assert (result["status"], result["reason"]) == ("failed", bad[do])
        else:
            assert result["status"] == "done"


def test_a_job_that_kills_its_workers_takes_no_other_job_along(
    tmp_path: Path, dask: DaskProcesses
) -> None:
    lines = [job(seed, "kill-worker" if seed == 17 else "answer") for seed in range(40)]
    jobs = write_jobs(tmp_path / "jobs.jsonl", lines)
    dask.start_hosts(2)
    ended = run(jobs, "-o", tmp_path / "out", "--scheduler", dask.address, "--tries", 1)
    assert ended.returncode == 0, ended.stderr
    failed = [result for result in results(tmp_path / "out") if result["status"] == "failed"]
    assert [result["options"]["seed"] for result in failed] == [17]
    assert failed[0]["reason"] == "its worker died every time it was tried"
    assert len(journal(tmp_path / "out")) == 40


def test_a_worker_that_is_killed_takes_its_roadbed_along(
    tmp_path: Path, dask: DaskProcesses
) -> None:
    (host,) = dask.start_hosts(1)
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1), job(2, "hang")])
    batch = Run(jobs, tmp_path / "out", "--scheduler", dask.address)
    batch.wait_for(1)
    worker = dask.worker_of(host)
    serving = [pid for pid in children_of(worker) if "--serve" in command_of(pid)]
    assert len(serving) == 1
    os.kill(worker, signal.SIGKILL)
    wait_until(lambda: not command_of(serving[0]), "the end of a served process")
    batch.process.kill()
    batch.process.wait()


def with_small_files(arguments: Sequence[str]) -> int:
    """Be `roadbed-cluster` where no file can grow past 15 kB."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (15_000, 15_000))
    return roadbed_cluster(arguments)


def test_a_full_disk_under_the_journal_stops_with_a_line_and_resumes(tmp_path: Path) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", (job(seed) for seed in range(150)))
    limited = start(jobs, "-o", tmp_path / "out", "--workers", 1, program=with_small_files)
    _, said = limited.communicate(timeout=120)
    assert limited.returncode == 3
    assert said == (
        f"roadbed-cluster: {tmp_path}/out/journal/cluster.jsonl: File too large; "
        "make room and run the same command again\n"
    )
    kept = journal(tmp_path / "out")
    assert len(kept) < 150
    assert run(jobs, "-o", tmp_path / "out", "--workers", 1).returncode == 0
    assert journal(tmp_path / "out")[: len(kept)] == kept
    assert same_as_sequential(jobs, tmp_path / "out")


@pytest.mark.campaign
def test_a_full_disk_under_a_job_is_that_jobs_failed_line(
    tmp_path: Path, small_disk: Callable[[], Path]
) -> None:
    output = small_disk() / "out"
    lines = [job(1, "write", lines=10), job(2, "write", lines=200_000), job(3, "write", lines=10)]
    jobs = write_jobs(tmp_path / "jobs.jsonl", lines)
    assert run(jobs, "-o", output, "--workers", 1).returncode == 0
    found = results(output)
    assert [result["status"] for result in found] == ["done", "failed", "done"]
    assert found[1]["reason"].endswith("No space left on device")


@pytest.mark.campaign
def test_a_torn_last_line_is_cut_off_and_done_again(tmp_path: Path) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", (job(seed) for seed in range(50)))
    assert run(jobs, "-o", tmp_path / "out", "--workers", 1).returncode == 0
    path = tmp_path / "out" / "journal" / "cluster.jsonl"
    path.write_bytes(path.read_bytes()[:-30])
    again = run(jobs, "-o", tmp_path / "out", "--workers", 1)
    assert again.stderr.endswith(": 1 done\n")
    assert same_as_sequential(jobs, tmp_path / "out")


@pytest.mark.campaign
def test_two_runs_into_one_folder_do_not_mix(tmp_path: Path) -> None:
    jobs = sleeping_jobs(tmp_path, 200)
    first = Run(jobs, tmp_path / "out", "--workers", 1)
    first.wait_for(1)
    second = run(jobs, "-o", tmp_path / "out", "--workers", 1)
    assert second.returncode == 3
    assert "another run is at work in it" in second.stderr
    assert first.end() == (0, "")
    assert same_as_sequential(jobs, tmp_path / "out")


def test_a_run_waits_for_its_first_worker(tmp_path: Path, dask: DaskProcesses) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", (job(seed) for seed in range(20)))
    early = Run(jobs, tmp_path / "out", "--scheduler", dask.address)
    wait_until((tmp_path / "out" / "journal").exists, "the start of a run")
    dask.start_hosts(1)
    assert early.end() == (0, "")
    assert len(journal(tmp_path / "out")) == 20


@pytest.mark.campaign
def test_no_worker_and_no_scheduler_are_one_line_each(tmp_path: Path, dask: DaskProcesses) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1)])
    idle = run(jobs, "-o", tmp_path / "out", "--scheduler", dask.address, "--wait", 1)
    assert idle.returncode == 3
    assert idle.stderr.startswith("roadbed-cluster: no worker at the scheduler for 1 s")
    dask.scheduler.kill()
    dask.scheduler.wait()
    gone = run(jobs, "-o", tmp_path / "out", "--scheduler", dask.address)
    assert gone.returncode == 3
    assert gone.stderr.startswith(f"roadbed-cluster: {dask.address}: no scheduler answers")
    assert len(gone.stderr.splitlines()) == 1
