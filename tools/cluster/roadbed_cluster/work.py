"""What runs on a Dask worker: a chunk of jobs, one after another, in one process kept for them."""

import json
import threading
import time

from roadbed_cluster.job import Job, Result, failed_line
from roadbed_cluster.serve import NoAnswer, ServeOptions, ServeProcess

#: Processes that no chunk came for in this time are ended.
_IDLE_S = 60.0

_lock = threading.Lock()
_idle: list[tuple[ServeOptions, ServeProcess, float]] = []
_sweeper: threading.Timer | None = None


class WrongHash(Exception):
    """A worker's program, or a job's input there, is not the one that the run began with."""


def run_chunk(jobs: list[Job], options: ServeOptions) -> list[Result]:
    """Return the results of `jobs`, in order.

    A job whose process dies is tried again in a new one, `options.tries` times in all, and is then
    one failed result; a job past a limit is one at once. The jobs beside it do not notice.

    Raises:
        OSError: if the program cannot be started.
        WrongHash: if an answer is to another hash than was asked for.
    """
    process: ServeProcess | None = None
    results = []
    try:
        for job in jobs:
            begin = time.monotonic()
            line = None
            for attempt in range(1, options.tries + 1):
                process = process or _take(options)
                try:
                    line = process.ask(job.line)
                    break
                except NoAnswer as none:
                    process.close()
                    process = None
                    if attempt == options.tries or not none.may_differ:
                        line = failed_line(job, none.reason, none.cause)
                        break
            assert line is not None
            results.append(Result(line, _status(job, line), time.monotonic() - begin))
    finally:
        if process is not None:
            _give_back(options, process)
    return results


def end_idle_processes(idle_s: float = 0.0) -> None:
    """End the processes that have waited `idle_s` for a chunk."""
    now = time.monotonic()
    with _lock:
        ended = [entry for entry in _idle if now - entry[2] >= idle_s]
        _idle[:] = [entry for entry in _idle if now - entry[2] < idle_s]
    for _, process, _ in ended:
        process.close()


def _status(job: Job, line: str) -> str:
    answer = json.loads(line)
    if answer["hash"] != job.hash:
        raise WrongHash(
            f"a worker answered with hash {answer['hash']} where {job.hash} was asked for: another "
            f"roadbed there, or an input that changed since; the job: {job.line}"
        )
    return str(answer["status"])


def _take(options: ServeOptions) -> ServeProcess:
    with _lock:
        for index, (other, process, _) in enumerate(_idle):
            if other == options:
                del _idle[index]
                return process
    return ServeProcess(options)


def _give_back(options: ServeOptions, process: ServeProcess) -> None:
    global _sweeper
    with _lock:
        _idle.append((options, process, time.monotonic()))
        if _sweeper is None:
            _sweeper = threading.Timer(_IDLE_S, _sweep)
            _sweeper.daemon = True
            _sweeper.start()


def _sweep() -> None:
    global _sweeper
    end_idle_processes(_IDLE_S)
    with _lock:
        _sweeper = None
        if _idle:
            _sweeper = threading.Timer(_IDLE_S, _sweep)
            _sweeper.daemon = True
            _sweeper.start()
