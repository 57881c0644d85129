"""Who can reach what a run starts."""

import socket
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from batches import command, environment, job, write_jobs
from dask_processes import children_of, wait_until


def sockets_of(pids: set[int]) -> list[tuple[str, int]]:
    """Return the local addresses and ports at which processes listen, as in /proc/net/tcp*."""
    inodes = set()
    for pid in pids:
        with suppress(FileNotFoundError, ProcessLookupError):  # it has ended meanwhile
            for file in Path(f"/proc/{pid}/fd").iterdir():
                with suppress(FileNotFoundError):  # it has been closed meanwhile
                    target = str(file.readlink())
                    inodes.add(target[8:-1] if target.startswith("socket:[") else "")
    found = []
    for table in ("tcp", "tcp6"):
        for row in Path(f"/proc/net/{table}").read_text().splitlines()[1:]:
            fields = row.split()
            if fields[3] == "0A" and fields[9] in inodes:
                address, port = fields[1].split(":")
                found.append((address, int(port, 16)))
    return found


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
    sockets = sockets_of(descendants(process.pid))
    assert process.wait() == 0
    assert len(sockets) >= 5  # a scheduler, two nannies, two workers
    assert {address for address, _ in sockets} == {"0100007F"}


def test_a_cluster_of_its_own_does_not_ask_for_the_port_of_dasks_page(tmp_path: Path) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1)])
    with socket.socket() as other:
        with suppress(OSError):  # it may be somebody else's already
            other.bind(("127.0.0.1", 8787))
            other.listen()
        words = command(jobs, "-o", tmp_path / "out", "--workers", 1, "--quiet")
        done = subprocess.run(words, env=environment(), capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.campaign
def test_a_cluster_of_its_own_takes_no_client_without_its_key(tmp_path: Path) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1), job(2, "sleep", seconds=6.0)])
    process = subprocess.Popen(
        command(jobs, "-o", tmp_path / "out", "--workers", 1, "--quiet"), env=environment()
    )
    wait_until((tmp_path / "out" / "journal" / "cluster.jsonl").exists, "a journal")
    wait_until(lambda: (tmp_path / "out/journal/cluster.jsonl").stat().st_size > 0, "a result")
    ports = [port for _, port in sockets_of({process.pid})]
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
