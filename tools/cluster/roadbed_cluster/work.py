"""What runs on a Dask worker: a chunk of jobs, one after another, in one process kept for them."""

import json
import shutil
import threading
import time
from pathlib import Path
from typing import Any

from roadbed_cluster.job import Job, Result, failed_line
from roadbed_cluster.serve import (
    NoAnswer,
    ServeOptions,
    ServeProcess,
    check_folder,
    is_at_work,
)

#: Processes that no chunk came for in this time are ended.
_IDLE_S = 60.0

_lock = threading.Lock()
_idle: list[tuple[ServeOptions, ServeProcess, float]] = []
_sweeper: threading.Timer | None = None


def run_chunk(jobs: list[Job], options: ServeOptions) -> list[Result]:
    """Return the results of `jobs`, in order.

    Raises:
        WrongWorker: if the worker has not what the client has.
    """
    with _Slot(options) as slot:
        return [slot.bring(job) for job in jobs]


def end_idle_processes(idle_s: float = 0.0) -> None:
    """End the processes that have waited `idle_s` for a chunk."""
    now = time.monotonic()
    with _lock:
        ended = [entry for entry in _idle if now - entry[2] >= idle_s]
        _idle[:] = [entry for entry in _idle if now - entry[2] < idle_s]
    for _, process, _ in ended:
        process.close()


class _Slot:
    """Brings jobs to their results in a process that is replaced when it dies."""

    def __init__(self, options: ServeOptions) -> None:
        self._options = options
        self._process: ServeProcess | None = None

    def __enter__(self) -> "_Slot":
        return self

    def __exit__(self, *error: object) -> None:
        if self._process is not None:
            _give_back(self._options, self._process)

    def bring(self, job: Job) -> Result:
        """Return a job's result.

        A job whose process dies is tried again in a new one, `tries` times in all, and has then
        failed; one past its time has failed at once. The jobs beside it do not notice.
        """
        check_folder(self._options)
        begin = time.monotonic()
        for _ in range(self._options.tries):
            try:
                line = self._ask(job)
                break
            except NoAnswer as none:
                self._end_process()
                # A worker may outlive its scheduler; by now these may be files of a later run.
                if is_at_work(self._options):
                    remove_files_of(job.hash, self._options.output)
                line = failed_line(job, none.reason, none.cause)
                if none.cause != "crash":
                    break
        return Result(line, str(json.loads(line)["status"]), time.monotonic() - begin)

    def _ask(self, job: Job) -> str:
        """Return the answer of a process; of a new one where it may depend on jobs before."""
        process = self._process = self._process or _take(self._options)
        was_fresh = process.is_fresh
        line = process.ask(job.line)
        answer = _result_in(line)
        if answer["hash"] != job.hash:
            remove_files_of(str(answer["hash"]), self._options.output)
            return failed_line(job, "an input changed while the job ran", "changed")
        if answer.get("cause") != "memory":
            return line
        self._end_process()  # its heap may be in pieces
        return line if was_fresh else self._ask(job)

    def _end_process(self) -> None:
        if self._process is not None:
            self._process.close()
            self._process = None


def _result_in(line: str) -> dict[str, Any]:
    """Return what a line of an answer holds.

    Raises:
        NoAnswer: if it is no result; what its process says next is none either.
    """
    try:
        answer = json.loads(line)
    except ValueError:
        answer = None
    if not isinstance(answer, dict) or not {"hash", "status"} <= answer.keys():
        raise NoAnswer("its process answered with no result", "internal")
    return answer


def remove_files_of(hash_: str, output: str) -> None:
    """Remove whatever a job left below the folder of results, half-written files too."""
    folder = Path(output) / "files" / hash_[:2]
    for path in [*folder.glob(f"{hash_}*"), *folder.glob(f".{hash_}*")]:
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


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
