"""Who can reach what a run starts."""

import subprocess
import sys
from pathlib import Path

import pytest

from batches import command, environment, job, write_jobs
from dask_processes import children_of, wait_until


def sockets_of(pids: set[int]) -> list[str]:
    """Return the local addresses at which processes listen, as in /proc/net/tcp*."""
    inodes = set()
    for pid in pids:
        for file in Path(f"/proc/{pid}/fd").iterdir():
            try:
                target = str(file.readlink())
            except OSError:
                continue
            if target.startswith("socket:["):
                inodes.add(target[8:-1])
    addresses = []
    for table in ("tcp", "tcp6"):
        for row in Path(f"/proc/net/{table}").read_text().splitlines()[1:]:
            fields = row.split()
            if fields[3] == "0A" and fields[9] in inodes:
                addresses.append(fields[1].split(":")[0])
    return addresses


def descendants(pid: int) -> set[int]:
    """Return `pid` and all that it started."""
    found = {pid}
    for child in children_of(pid):
        found |= descendants(child)
    return found


def test_a_cluster_of_its_own_listens_on_127_0_0_1_only(tmp_path: Path) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1), job(2, "sleep", seconds=4.0)])
    process = subprocess.Popen(
        command(jobs, "-o", tmp_path / "out", "--workers", 2, "--quiet"), env=environment()
    )
    wait_until((tmp_path / "out" / "journal" / "cluster.jsonl").exists, "a journal")
    wait_until(lambda: (tmp_path / "out/journal/cluster.jsonl").stat().st_size > 0, "a result")
    addresses = sockets_of(descendants(process.pid))
    assert process.wait() == 0
    assert len(addresses) >= 5  # a scheduler, two nannies, two workers
    assert set(addresses) == {"0100007F"}


@pytest.mark.campaign
def test_a_cluster_of_its_own_takes_no_client_without_its_key(tmp_path: Path) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1), job(2, "sleep", seconds=6.0)])
    process = subprocess.Popen(
        command(jobs, "-o", tmp_path / "out", "--workers", 1, "--quiet"), env=environment()
    )
    wait_until((tmp_path / "out" / "journal" / "cluster.jsonl").exists, "a journal")
    wait_until(lambda: (tmp_path / "out/journal/cluster.jsonl").stat().st_size > 0, "a result")
    ports = [
        int(row.split()[1].split(":")[1], 16)
        for row in Path("/proc/net/tcp").read_text().splitlines()[1:]
        if row.split()[3] == "0A" and row.split()[9] in inodes_of(process.pid)
    ]
    assert ports
    client = "import sys; from distributed import Client; Client(sys.argv[1], timeout=2)"
    for port in ports:
        for protocol in ("tcp", "tls"):
            tried = subprocess.run(
                [sys.executable, "-c", client, f"{protocol}://127.0.0.1:{port}"],
                capture_output=True,
                timeout=60,
            )
            assert tried.returncode != 0
    assert process.wait() == 0


def inodes_of(pid: int) -> set[str]:
    """Return the inodes of a process's sockets."""
    targets = (str(file.readlink()) for file in Path(f"/proc/{pid}/fd").iterdir())
    return {target[8:-1] for target in targets if target.startswith("socket:[")}
