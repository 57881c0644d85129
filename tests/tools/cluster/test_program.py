"""The same with roadbed itself: any number of workers, and kills, give the sequential bytes."""

import json
import os
import signal
import subprocess
from pathlib import Path

import pytest

from batches import start, write_jobs
from dask_processes import DaskProcesses, wait_until
from warm import WarmProcess

DATA = Path(__file__).parents[3] / "data"
PROGRAM = os.environ.get("ROADBED_PROGRAM", "roadbed")
#: What a batch writes that must not depend on how it was run.
SAME = ["results.jsonl", "summary.json", "index.html"]


def roadbed(*words: object, **options: int) -> subprocess.CompletedProcess[str]:
    """Run roadbed, and return its output and status."""
    return subprocess.run(
        [PROGRAM, *map(str, words)], capture_output=True, text=True, timeout=300, check=False
    )


@pytest.fixture(autouse=True)
def _needs_roadbed() -> None:
    if not Path(PROGRAM).is_file() or "--list-missing" not in roadbed("batch", "--help").stdout:
        pytest.skip("no roadbed is built; ROADBED_PROGRAM names it")


def mixed_jobs(folder: Path, audits: int) -> Path:
    """Write jobs of every kind, of which some cannot be done."""
    drive, walls = folder / "drive", folder / "walls.bt"
    gap = DATA / "scenarios" / "narrow_gap.json"
    assert roadbed("--quiet", "simulate", gap, "-o", drive).returncode == 0
    cloud = [gap.with_suffix(".pcd"), "--resolution", 0.4]
    assert roadbed("occupancy", "build", *cloud, "-o", walls).returncode == 0
    town = str(DATA / "town.xodr")
    audit = {"occupancy": str(walls), "trajectory": str(drive / "trajectory.csv")}
    way = {"from": "150,198", "to": "lane:7/0/1@35"}
    jobs = [
        {"job": "import", "inputs": [town]},
        {"job": "import", "inputs": [str(folder / "gone.xodr")]},
        {"job": "validate", "inputs": [str(DATA / "crossing.osm")], "outputs": ["sarif"]},
        {"job": "route", "inputs": [town], "options": way, "outputs": ["output"]},
        {"job": "simulate", "inputs": [str(DATA / "scenarios" / "lane_change.json")]},
        {"job": "audit", "options": {**audit, "trajectory": str(folder / "gone.csv")}},
    ]
    for number in range(audits):
        inflated = {**audit, "inflate": 1.5 * number / audits}
        jobs.append({"job": "audit", "options": inflated, "outputs": ["certificate"]})
    return write_jobs(folder / "jobs.jsonl", [*map(json.dumps, jobs), "not a job"])


def contents(output: Path) -> dict[str, bytes]:
    """Return what stands in the files of a folder of results, but for journals and times."""
    files = [output / name for name in SAME]
    for folder in ("files", "tables"):
        files += [path for path in (output / folder).rglob("*") if path.is_file()]
    return {str(path.relative_to(output)): path.read_bytes() for path in files}


def sequential(jobs: Path, output: Path) -> dict[str, bytes]:
    """Return what `roadbed batch` alone makes of the jobs."""
    assert roadbed("batch", jobs, "-o", output, "--threads", 1).returncode == 1  # some failed
    tables = start("tables", output)
    assert len(tables.communicate(timeout=300)[0].splitlines()) == 5
    assert tables.wait() == 0
    return contents(output)


def start_run(jobs: Path, output: Path, *arguments: object) -> WarmProcess:
    """Start roadbed-cluster with roadbed."""
    return start(jobs, "-o", output, "--quiet", "--roadbed", PROGRAM, *arguments)


def test_jobs_of_every_kind_give_the_bytes_of_the_sequential_run(tmp_path: Path) -> None:
    jobs = mixed_jobs(tmp_path, audits=4)
    run = start_run(jobs, tmp_path / "out", "--workers", 2)
    _, said = run.communicate(timeout=300)
    assert (run.returncode, said) == (1, "")
    assert contents(tmp_path / "out") == sequential(jobs, tmp_path / "sequential")


@pytest.mark.campaign
def test_a_thousand_audits_survive_five_workers_a_host_and_the_scheduler(tmp_path: Path) -> None:
    jobs = mixed_jobs(tmp_path, audits=1000)
    journal = tmp_path / "out" / "journal" / "cluster.jsonl"

    def wait_for(more: int) -> None:
        def count() -> int:
            return journal.read_bytes().count(b"\n") if journal.exists() else 0

        goal = count() + more
        wait_until(lambda: count() >= goal or run.poll() is not None, "results")
        assert run.poll() is None, "the run ended before the fault"

    (tmp_path / "dask").mkdir()
    with DaskProcesses(tmp_path / "dask") as dask:
        hosts = dask.start_hosts(3)
        run = start_run(jobs, tmp_path / "out", "--scheduler", dask.address, "--chunk", 0.3)
        for kill in range(5):
            wait_for(30)
            os.kill(dask.worker_of(hosts[1 + kill % 2]), signal.SIGKILL)
        wait_for(30)
        dask.kill_host(hosts[0])
        wait_for(30)
        dask.scheduler.kill()
        _, said = run.communicate(timeout=120)
        assert run.returncode == 3
        assert said.startswith("roadbed-cluster: the scheduler is gone after ")
        dask.start_scheduler()
        dask.start_hosts(2)
        run = start_run(jobs, tmp_path / "out", "--scheduler", dask.address)
        assert run.communicate(timeout=300)[1] == ""
    hashes = [json.loads(line)["hash"] for line in journal.read_text().splitlines()]
    assert len(set(hashes)) == len(hashes) == 1006
    assert contents(tmp_path / "out") == sequential(jobs, tmp_path / "sequential")
