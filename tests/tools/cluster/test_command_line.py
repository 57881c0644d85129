"""What users type, and what they read when it cannot be used."""

import subprocess
from pathlib import Path

import pytest

from batches import job, run, write_jobs

RECIPES = Path(__file__).parents[3] / "tools" / "cluster" / "recipes"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--chunk", "nan"], "--chunk: nan is not 0.01 or more"),
        (["--time-limit", "0"], "--time-limit: 0 is not 0.001 or more"),
        (["--job-memory", "much"], "--job-memory: 'much' is no size such as 4GB or 512MB"),
        (["--job-memory", "0GB"], "--job-memory: '0GB' is no size such as 4GB or 512MB"),
        (["--workers", "1.5"], "--workers: '1.5' is not a number"),
        (["--workers", "2", "--scheduler", "tcp://127.0.0.1:1"], "--workers is for a cluster of"),
        (["--tls-ca", "ca.pem"], "--tls-ca needs --scheduler tls://HOST:PORT"),
        (["--scheduler", "tls://127.0.0.1:1"], "tls://127.0.0.1:1 needs --tls-ca FILE"),
        (["--scheduler", "localhost"], "--scheduler: 'localhost' is no address such as tcp://"),
        (["--scheduler", "http://127.0.0.1:1"], "'http://127.0.0.1:1' is no address such as"),
        (["--scheduler", "tcp://127.0.0.1:99999"], "'tcp://127.0.0.1:99999' is no address such as"),
        (["--roadbed", "no-such-program"], "--roadbed: no-such-program: no such program"),
        (["--roadbed", "true"], "true is not roadbed: its --version says"),
        (["--schedule", "tcp://127.0.0.1:1"], "unrecognized arguments"),
    ],
)
def test_wrong_usage_is_told_with_status_2(tmp_path: Path, arguments: list[str], said: str) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1)])
    ended = run(jobs, "-o", tmp_path / "out", *arguments)
    assert ended.returncode == 2
    assert said in ended.stderr.splitlines()[-1]
    assert not (tmp_path / "out").exists()


def test_certificates_that_are_none_are_told_with_status_2(tmp_path: Path) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1)])
    for folder in ("one", "other"):
        subprocess.run([RECIPES / "certificates", tmp_path / folder], check=True)
    one, key = tmp_path / "one", tmp_path / "other" / "cluster.key"
    for ca, said in (
        (jobs, f"--tls-ca: {jobs}: is no certificate (.pem)"),
        (one / "ca.pem", f"{one}/cluster.pem and {key} are no certificate and its key (.pem)"),
    ):
        files = ["--tls-ca", ca, "--tls-cert", one / "cluster.pem", "--tls-key", key]
        ended = run(jobs, "-o", tmp_path / "out", "--scheduler", "tls://127.0.0.1:1", *files)
        assert ended.returncode == 2
        assert ended.stderr.rstrip("\n").endswith(said)
        assert not (tmp_path / "out").exists()


def test_unusable_jobs_are_told_with_status_3_and_leave_nothing(tmp_path: Path) -> None:
    gone = run(tmp_path / "jobs.jsonl", "-o", tmp_path / "out")
    assert (gone.returncode, gone.stderr) == (
        3,
        f"roadbed-cluster: {tmp_path}/jobs.jsonl: no such file\n",
    )
    folder = run(tmp_path, "-o", tmp_path / "out")
    assert (folder.returncode, folder.stderr) == (
        3,
        f"roadbed-cluster: {tmp_path}: is a folder; `roadbed jobs` writes a file of jobs\n",
    )
    jobs = write_jobs(tmp_path / "jobs.jsonl", ["no job"])
    file = run(jobs, "-o", jobs)
    assert (file.returncode, file.stderr) == (
        3,
        f"roadbed-cluster: {jobs}: is no folder; name one for the results\n",
    )
    bad = run(jobs, "-o", tmp_path / "out")
    assert (bad.returncode, bad.stderr) == (3, f"{jobs}:1: not a job\n")
    assert not (tmp_path / "out").exists()


def test_help_ends_with_an_example(tmp_path: Path) -> None:
    for arguments in (["--help"], ["tables", "--help"]):
        shown = run(*arguments)
        assert shown.returncode == 0
        assert "example:\n  roadbed-cluster " in shown.stdout


def test_nothing_missing_starts_no_cluster(tmp_path: Path) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1)])
    assert run(jobs, "-o", tmp_path / "out", "--workers", 1).returncode == 0
    again = run(jobs, "-o", tmp_path / "out", "--scheduler", "tcp://127.0.0.1:1")
    assert (again.returncode, again.stderr) == (0, "")


def test_a_merge_that_fails_writes_no_tables(tmp_path: Path) -> None:
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1)])
    assert run(jobs, "-o", tmp_path / "out", "--workers", 1).returncode == 0
    (tmp_path / "out" / "tables" / "audit.parquet").unlink()
    (tmp_path / "out" / "unfinished").touch()
    (tmp_path / "out" / "results.jsonl").unlink()
    (tmp_path / "out" / "results.jsonl").mkdir()  # cannot be written
    assert run(jobs, "-o", tmp_path / "out").returncode == 3
    assert list((tmp_path / "out" / "tables").iterdir()) == []
