"""One `roadbed batch --serve` process, asked one job at a time, within limits."""

import math
import os
import select
import shutil
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

from roadbed_cluster.journal import MARK

_READ_BYTES = 1 << 20
#: A network file system may take so long to show a file to other hosts.
_SEEN_S = 10.0


@dataclass(frozen=True)
class ServeOptions:
    """What a worker starts, and how far it may go."""

    program: tuple[str, ...]  #: `roadbed`, or an interpreter and a script
    version: str  #: what `roadbed --version` begins with where the run was started
    output: str  #: folder of the results
    mark: str  #: what its file `unfinished` holds during the run
    folder: str  #: where the program runs, so that inputs mean the same on every worker
    time_limit_s: float | None = None  #: per job; None: no limit
    job_memory: str | None = None  #: per job, such as `2GB`; None: no limit
    tries: int = 3  #: how often a job is tried whose process dies

    def command(self) -> list[str]:
        """Return the command of the process that serves."""
        words = [*self.program, "batch", "--serve", "-o", self.output]
        return words if self.job_memory is None else [*words, "--job-memory", self.job_memory]


class WrongWorker(Exception):
    """A worker that has not what the client has: the program, its version, the folder."""


def version_of(program: tuple[str, ...]) -> str:
    """Return the first line of `roadbed --version`.

    Raises:
        WrongWorker: if it cannot be run, or is another program.
    """
    try:
        shown = subprocess.run(
            [*program, "--version"], capture_output=True, text=True, check=True, timeout=60
        )
    except (OSError, subprocess.SubprocessError) as error:
        raise WrongWorker(f"{program[0]} cannot be run: {error}") from error
    first = shown.stdout.partition("\n")[0]
    if not first.startswith("roadbed "):
        raise WrongWorker(f"{program[0]} is not roadbed: its --version says {first!r}")
    return first


def _check(options: ServeOptions) -> None:
    """Refuse a worker whose program or folder is not that of the run."""
    found = version_of(options.program)
    if found != options.version:
        raise WrongWorker(
            f"{options.program[0]} is {found!r} on a worker, {options.version!r} here"
        )
    check_folder(options)


def is_at_work(options: ServeOptions) -> bool:
    """Return whether the folder of results is, as seen here, that of the run, and no later one."""
    try:
        return (Path(options.output) / MARK).read_text(encoding="ascii") == options.mark
    except OSError:
        return False


def check_folder(options: ServeOptions) -> None:
    """Refuse a folder of results that is not the run's, or has become that of a later run.

    Raises:
        WrongWorker: if it stays so.
    """
    end = time.monotonic() + _SEEN_S
    while not is_at_work(options):
        if time.monotonic() > end:
            raise WrongWorker(f"{options.output} is not the same folder on a worker as here")
        time.sleep(0.1)


class NoAnswer(Exception):
    """The process ended, or was ended, before it answered."""

    def __init__(self, reason: str, cause: str) -> None:
        """Say why in `reason`, and `cause`: `crash`, `time` or `internal`."""
        super().__init__(reason)
        self.reason = reason
        self.cause = cause


class ServeProcess:
    """Keeps one process; it ends with its owner, however the owner ends."""

    def __init__(self, options: ServeOptions) -> None:
        """Start the process.

        Raises:
            WrongWorker: if there is no program of the right version, or another folder of results.
        """
        _check(options)
        self._options = options
        self._answers = 0
        self._unread = b""
        # A killed owner's pipe ends a waiting process; this also ends one that is at work.
        setpriv = shutil.which("setpriv")
        die_with_owner = [setpriv, "--pdeathsig", "KILL", "--"] if setpriv else []
        self._process = subprocess.Popen(
            [*die_with_owner, *options.command()],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            bufsize=0,
            cwd=options.folder,
        )

    @property
    def is_fresh(self) -> bool:
        """Whether it has answered nothing yet, so that all it holds is the present job's."""
        return self._answers == 0

    def ask(self, line: str) -> str:
        """Return the answer to the job `line`.

        Raises:
            NoAnswer: if the process died, or ran past a limit and was killed.
        """
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(line.encode(errors="surrogateescape") + b"\n")
        except BrokenPipeError:
            raise self._end() from None
        answer = self._read_line()
        self._answers += 1
        return answer

    def close(self) -> None:
        """End the process: by closing its input, then by force."""
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.close()
        try:
            self._process.wait(timeout=1.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._process.stdout.close()

    def _read_line(self) -> str:
        assert self._process.stdout is not None
        output = self._process.stdout.fileno()
        limit_s = self._options.time_limit_s
        deadline = None if limit_s is None else time.monotonic() + limit_s
        poll = select.poll()
        poll.register(output, select.POLLIN)
        while (end := self._unread.find(b"\n")) < 0:
            left_s = None if deadline is None else max(0.0, deadline - time.monotonic())
            if not poll.poll(None if left_s is None else math.ceil(1000 * left_s)):
                limit = repr(float(limit_s or 0.0)).removesuffix(".0")
                raise self._kill(f"took longer than {limit} s", "time")
            data = os.read(output, _READ_BYTES)
            if not data:
                raise self._end()
            self._unread += data
        answer, self._unread = self._unread[:end], self._unread[end + 1 :]
        return answer.decode(errors="surrogateescape")

    def _kill(self, reason: str, cause: str) -> NoAnswer:
        self._process.kill()
        self._process.wait()
        return NoAnswer(reason, cause)

    def _end(self) -> NoAnswer:
        """Collect a process that closed its output."""
        try:
            status = self._process.wait(timeout=1.0)
        except subprocess.TimeoutExpired:
            return self._kill("its process closed its output", "crash")
        if status >= 0:
            return NoAnswer(f"its process ended with exit status {status}", "crash")
        return NoAnswer(f"killed by signal {-status} ({signal.Signals(-status).name})", "crash")
