"""Dask's own programs on 127.0.0.1, each a process that a test may kill by its pid."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import TracebackType

from distributed import Client

from warm import WarmProcess, dask_program

Process = WarmProcess | subprocess.Popen[bytes]
WAIT_S = 60.0


def wait_until(holds: Callable[[], object], what: str) -> None:
    """Return once `holds()` is true; fail after a minute."""
    end = time.monotonic() + WAIT_S
    while not holds():
        assert time.monotonic() < end, f"waited {WAIT_S:g} s in vain: {what}"
        time.sleep(0.05)


def children_of(pid: int) -> list[int]:
    """Return the pids of the processes that `pid` started."""
    found = []
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        with suppress(FileNotFoundError, ProcessLookupError):  # it has ended meanwhile
            found += [int(child) for child in task.read_text().split()]
    return found


def command_of(pid: int) -> str:
    """Return the command line of a process, empty once it is gone."""
    try:
        return Path(f"/proc/{pid}/cmdline").read_text().replace("\0", " ")
    except OSError:
        return ""


class DaskProcesses:
    """A scheduler and hosts of workers; a host is a nanny with the one worker that it looks after.

    Whatever is left of them ends with the `with` block.
    """

    def __init__(self, folder: Path, are_forked: bool = True) -> None:
        """Keep the scheduler's file and every log below `folder`.

        Forked from one that has imported all, they start faster, but share memory.
        """
        self._folder = folder
        self._are_forked = are_forked
        self._started = 0
        self._processes: list[Process] = []
        self._pid_files: dict[int, Path] = {}
        self._environment = {
            **os.environ,
            "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "0",
            "DASK_DISTRIBUTED__SCHEDULER__HTTP__ROUTES": "[]",
            "DASK_DISTRIBUTED__WORKER__HTTP__ROUTES": "[]",
        }
        self.scheduler = self.start_scheduler()

    def start_scheduler(self) -> Process:
        """Start a scheduler at a free port; `address` names it."""
        file = self._folder / f"scheduler{self._started}.json"
        process = self._start(
            "scheduler", "--no-dashboard", "--port", "0", "--scheduler-file", str(file)
        )
        wait_until(file.exists, "a scheduler")
        time.sleep(0.05)
        self.address = json.loads(file.read_text())["address"]
        return process

    def start_host(self) -> Process:
        """Start a nanny with a worker of one slot."""
        name = f"host{self._started}"
        host = self._start(
            "worker", self.address, "--no-dashboard", "--nanny", "--nthreads", "1", "--name", name,
            "--memory-limit", "0", "--local-directory", str(self._folder),
            "--preload", str(Path(__file__).with_name("write_pid.py")),
        )  # fmt: skip
        self._pid_files[host.pid] = self._folder / f"{name}.pid"
        return host

    def start_hosts(self, count: int) -> list[Process]:
        """Start hosts and return once their workers are at the scheduler."""
        hosts = [self.start_host() for _ in range(count)]
        with Client(self.address) as client:
            client.wait_for_workers(count, timeout=WAIT_S)
        return hosts

    def worker_of(self, host: Process) -> int:
        """Return the pid of the worker that a nanny looks after now."""
        found: list[int] = []

        def look() -> bool:
            file = self._pid_files[host.pid]
            found[:] = [int(file.read_text())] if file.is_file() else []
            return bool(found) and command_of(found[0]) != ""

        wait_until(look, "a worker")
        return found[0]

    def kill_host(self, host: Process) -> None:
        """Kill a nanny and its worker with -9, as where a machine loses power."""
        worker = self.worker_of(host)
        os.kill(host.pid, signal.SIGKILL)
        os.kill(worker, signal.SIGKILL)
        host.wait()

    def __enter__(self) -> "DaskProcesses":
        """Return itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Kill what still runs; a worker ends when its nanny is gone."""
        for process in self._processes:
            process.kill()
        for process in self._processes:
            process.wait()

    def _start(self, *arguments: str) -> Process:
        self._started += 1
        words = [*arguments, "--host", "127.0.0.1", "--dashboard-address", "127.0.0.1:0"]
        log = self._folder / f"{arguments[0]}{self._started}.log"
        process: Process
        if self._are_forked:
            process = WarmProcess(dask_program, words, self._environment, log)
        else:
            command = [sys.executable, "-m", "dask", *words]
            with log.open("wb") as output:
                process = subprocess.Popen(
                    command, stdout=output, stderr=output, env=self._environment
                )
        self._processes.append(process)
        return process
