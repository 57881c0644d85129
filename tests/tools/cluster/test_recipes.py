"""The recipes for ssh and Slurm, tried for real on this host."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from batches import STAND_IN, job, journal, run_sequentially, write_jobs

RECIPES = Path(__file__).parents[3] / "tools" / "cluster" / "recipes"
pytestmark = pytest.mark.campaign


def go(tmp_path: Path, *recipe: object, **environment: str) -> None:
    """Run a recipe on 200 jobs and compare with the sequential run."""
    certificates = tmp_path / "certificates"
    subprocess.run([RECIPES / "certificates", certificates], check=True)
    jobs = write_jobs(tmp_path / "jobs.jsonl", (job(seed) for seed in range(200)))
    words = [certificates if word == "CERTIFICATES" else word for word in recipe]
    ended = subprocess.run(
        [*map(str, words), str(jobs), "-o", str(tmp_path / "out")],
        env={**os.environ, "ROADBED": str(STAND_IN), "PYTHON": sys.executable, **environment},
        capture_output=True, text=True, timeout=180,
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr
    assert "200 jobs in " in ended.stderr
    assert len(journal(tmp_path / "out")) == 200
    merged = (tmp_path / "out" / "results.jsonl").read_bytes()
    assert merged == run_sequentially(jobs, tmp_path / "sequential")


@pytest.mark.skipif(not Path("/usr/sbin/sshd").exists(), reason="openssh-server is not installed")
@pytest.mark.skipif(os.getuid() != 0, reason="sshd wants root")
def test_hosts_reached_by_ssh_give_the_bytes_of_the_sequential_run(tmp_path: Path) -> None:
    folder = tmp_path / "sshd"
    go(tmp_path, RECIPES / "one_host_ssh", folder, RECIPES / "ssh", "CERTIFICATES", "node1,node2",
       ROADBED_SSH=f"ssh -F {folder}/config", ROADBED_SLOTS="1")  # fmt: skip


@pytest.mark.skipif(shutil.which("slurmctld") is None, reason="slurm-wlm is not installed")
@pytest.mark.skipif(os.getuid() != 0, reason="slurmd wants root")
def test_workers_that_slurm_starts_give_the_bytes_of_the_sequential_run(tmp_path: Path) -> None:
    go(tmp_path, RECIPES / "one_node_slurm", tmp_path / "slurm", sys.executable, RECIPES / "slurm",
       "2", "CERTIFICATES")  # fmt: skip
