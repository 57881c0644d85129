"""Processes that start in milliseconds: forked from one that has imported Dask and Parquet.

Importing them takes a second of processor time, and the tests start some fifty processes. What runs
in them is what users run, and each is a process of its own that a test may kill by its pid; so are
the workers that nannies fork from the same process.
"""

import multiprocessing
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from multiprocessing import forkserver
from pathlib import Path

#: What a process runs: takes the arguments, returns the exit status.
Program = Callable[[Sequence[str]], int]
#: Lets a nanny, too, have its worker forked.
FORKED = {"DASK_DISTRIBUTED__WORKER__MULTIPROCESSING_METHOD": "forkserver"}

_context = multiprocessing.get_context("forkserver")
_context.set_forkserver_preload(
    ["pytest", "numpy", "pandas", "distributed.cli.dask_scheduler", "distributed.cli.dask_worker",
     "roadbed_cluster.connection", "roadbed_cluster.dispatch", "roadbed_cluster.tables",
     "roadbed_cluster.command_line"]
)  # fmt: skip


def dask_program(arguments: Sequence[str]) -> int:
    """Be `dask`."""
    import dask.__main__

    sys.argv = ["dask", *arguments]
    dask.__main__.main()
    return 0


def roadbed_cluster(arguments: Sequence[str]) -> int:
    """Be `roadbed-cluster`."""
    from roadbed_cluster.command_line import main

    return main(arguments)


class WarmProcess:
    """A program in a process of its own, its output in two files; used as `subprocess.Popen` is."""

    def __init__(
        self,
        program: Program,
        arguments: Sequence[object],
        environment: dict[str, str],
        log: Path,
    ) -> None:
        """Start it; its output goes to `log`, what it says on stderr to `log` with `.err`."""
        self._log, self._errors = log, log.with_suffix(".err")
        words = [str(word) for word in arguments]
        self._process = _context.Process(
            target=_become,
            args=(program, words, {**environment, **FORKED}, str(Path.cwd()), log, self._errors),
        )
        self._process.start()

    @property
    def pid(self) -> int:
        """Its pid."""
        assert self._process.pid is not None
        return self._process.pid

    @property
    def returncode(self) -> int | None:
        """Its exit status, minus the signal where one killed it; None while it runs."""
        return self._process.exitcode

    def poll(self) -> int | None:
        """Return its exit status, None while it runs."""
        return self._process.exitcode

    def kill(self) -> None:
        """Kill it with -9."""
        self._process.kill()

    def terminate(self) -> None:
        """Ask it to end."""
        self._process.terminate()

    def wait(self, timeout: float | None = None) -> int:
        """Return its exit status once it has ended."""
        self._process.join(timeout)
        if self._process.exitcode is None:
            raise subprocess.TimeoutExpired(str(self._log), timeout or 0.0)
        return self._process.exitcode

    def communicate(self, timeout: float) -> tuple[str, str]:
        """Return what it said on stdout and on stderr once it has ended."""
        self.wait(timeout)
        return self._log.read_text(), self._errors.read_text()


def _become(
    program: Program,
    arguments: list[str],
    environment: dict[str, str],
    folder: str,
    output: Path,
    errors: Path,
) -> None:
    """Run a program as if it were started with that environment, folder and output."""
    import dask.config

    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    dask.config.refresh()
    for number, path in ((1, output), (2, errors)):
        file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND, 0o644)
        os.dup2(file, number)
        os.close(file)
    # Python 3.11 would start another fork server here, where the one that this is from serves.
    forkserver._forkserver.ensure_running = lambda: None  # type: ignore[method-assign]
    sys.exit(program(arguments))
