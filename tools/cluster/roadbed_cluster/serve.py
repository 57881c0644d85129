"""One `roadbed batch --serve` process, asked one job at a time, within limits."""

import os
import select
import shutil
import signal
import subprocess
import time
from dataclasses import dataclass

_PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")
#: How often the memory of a process at work is looked at.
_LOOK_S = 0.05
_READ_BYTES = 1 << 20


@dataclass(frozen=True)
class ServeOptions:
    """What a worker starts, and how far it may go."""

    command: tuple[str, ...]  #: the program and its arguments
    folder: str | None = None  #: where it runs, so that inputs mean the same on every worker
    time_limit_s: float | None = None  #: per job; None: no limit
    memory_limit_mb: float | None = (
        None  #: of the process, without the files it maps; None: no limit
    )
    tries: int = 3  #: how often a job is tried whose process dies


class NoAnswer(Exception):
    """The process ended, or was ended, before it answered."""

    def __init__(self, reason: str, cause: str, may_differ: bool) -> None:
        """Say why in `reason` and `cause`; `may_differ`: trying again may end otherwise."""
        super().__init__(reason)
        self.reason = reason
        self.cause = cause
        self.may_differ = may_differ


class ServeProcess:
    """Keeps one process; it ends with its owner, however the owner ends."""

    def __init__(self, options: ServeOptions) -> None:
        """Start the process.

        Raises:
            OSError: if the program cannot be started.
        """
        self._options = options
        self._answers = 0
        self._unread = b""
        # A killed owner's pipe ends a waiting process; this also ends one that is at work.
        setpriv = shutil.which("setpriv")
        die_with_owner = [setpriv, "--pdeathsig", "KILL", "--"] if setpriv else []
        if shutil.which(options.command[0]) is None:
            raise FileNotFoundError(f"{options.command[0]}: no such program")
        self._process = subprocess.Popen(
            [*die_with_owner, *options.command],
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
            self._process.stdin.write(line.encode() + b"\n")
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
        while True:
            end = self._unread.find(b"\n")
            if end >= 0:
                answer, self._unread = self._unread[:end], self._unread[end + 1 :]
                return answer.decode()
            if poll.poll(1000 * _LOOK_S):
                data = os.read(output, _READ_BYTES)
                if not data:
                    raise self._end()
                self._unread += data
            else:
                self._check_memory()
            if deadline is not None and time.monotonic() > deadline:
                reason = f"took longer than the time limit of {limit_s:g} s"
                raise self._kill(reason, "time", False)

    def _check_memory(self) -> None:
        limit_mb = self._options.memory_limit_mb
        if limit_mb is not None and _private_mb(self._process.pid) > limit_mb:
            reason = f"took more memory than the limit of {limit_mb:g} MB"
            raise self._kill(reason, "memory", not self.is_fresh)

    def _kill(self, reason: str, cause: str, may_differ: bool) -> NoAnswer:
        self._process.kill()
        self._process.wait()
        return NoAnswer(reason, cause, may_differ)

    def _end(self) -> NoAnswer:
        """Collect a process that closed its output."""
        try:
            status = self._process.wait(timeout=1.0)
        except subprocess.TimeoutExpired:
            return self._kill("crashed: closed its output", "crash", True)
        if status < 0:
            return NoAnswer(f"crashed: {signal.Signals(-status).name}", "crash", True)
        return NoAnswer(f"crashed: exit status {status}", "crash", True)


def _private_mb(pid: int) -> float:
    """Return the resident memory of a process that is not a file's, in MB; 0 once it is gone."""
    try:
        with open(f"/proc/{pid}/statm", encoding="ascii") as statm:  # noqa: PTH123
            _, resident, shared, *_ = statm.read().split()
    except (OSError, ValueError):
        return 0.0
    return (int(resident) - int(shared)) * _PAGE_BYTES / 1e6
