"""Batches of jobs for tests, and the command under test as users run it."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from warm import Program, WarmProcess, roadbed_cluster

STAND_IN = Path(__file__).with_name("stand_in.py")
_LOGS = tempfile.TemporaryDirectory()


def job(seed: int, do: str = "answer", inputs: Iterable[Path] = (), **options: object) -> str:
    """Return the line of a job for the stand-in."""
    asked = {
        "job": "audit",
        "inputs": [str(path) for path in inputs],
        "options": {"do": do, "seed": seed, **options},
        "outputs": [],
    }
    return json.dumps(asked)


def write_jobs(path: Path, lines: Iterable[str]) -> Path:
    """Write a file of jobs."""
    path.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
    return path


def command(*arguments: object) -> list[str]:
    """Return the command line of `roadbed-cluster` with the stand-in as its program."""
    return [sys.executable, "-m", "roadbed_cluster", *map(str, arguments)]


def environment() -> dict[str, str]:
    """Return the environment in which the stand-in is roadbed."""
    return {**os.environ, "ROADBED": str(STAND_IN)}


def start(*arguments: object, program: Program = roadbed_cluster) -> WarmProcess:
    """Start `roadbed-cluster` with the stand-in as its program."""
    log = Path(tempfile.mkdtemp(dir=_LOGS.name)) / "log"
    return WarmProcess(program, arguments, environment(), log)


def run(*arguments: object) -> subprocess.CompletedProcess[str]:
    """Run `roadbed-cluster` to its end."""
    process = start(*arguments)
    output, errors = process.communicate(timeout=300)
    return subprocess.CompletedProcess(list(arguments), process.wait(), output, errors)


def run_sequentially(jobs: Path, output: Path) -> bytes:
    """Return the results that `roadbed batch` alone writes."""
    subprocess.run([STAND_IN, "batch", jobs, "-o", output], check=True)
    return (output / "results.jsonl").read_bytes()


def results(output: Path) -> list[dict[str, Any]]:
    """Return the merged results of a folder."""
    lines = (output / "results.jsonl").read_text(encoding="utf-8").splitlines()
    return [json.loads(line) for line in lines]


def journal(output: Path) -> list[str]:
    """Return the hashes in a folder's journal, in the order they came."""
    lines = (output / "journal" / "cluster.jsonl").read_text(encoding="utf-8").splitlines()
    return [json.loads(line)["hash"] for line in lines]
