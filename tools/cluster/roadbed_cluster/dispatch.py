"""Chunks go out to the cluster, results come back into the journal, whatever dies in between."""

import asyncio
import queue
import time
from collections import Counter, deque
from collections.abc import Hashable
from dataclasses import dataclass

from distributed import Client, Future, KilledWorker

from roadbed_cluster.chunks import Chunks
from roadbed_cluster.errors import RunStopped
from roadbed_cluster.job import Job, Result, failed_line
from roadbed_cluster.journal import Journal
from roadbed_cluster.progress import Progress
from roadbed_cluster.serve import ServeOptions
from roadbed_cluster.work import run_chunk

_LOOK_S = 1.0
_DIED = "its worker died every time it was tried"


@dataclass
class _Chunk:
    jobs: list[Job]
    deaths: int = 0  # of workers that had it, while it was of one job
    is_alone: bool = False  # nothing else was out with it


class Dispatcher:
    """Keeps every slot of a cluster busy with two chunks, and no more, until no job is left.

    A chunk whose worker died is cut in two and goes out again, so that a job that kills its
    workers ends up in a chunk of its own. Where that chunk's workers died `tries` times, which may
    be the fault of a neighbour, it waits until all else is done and goes out once more, alone: if
    its worker dies then too, the job has failed. Memory is bounded by the chunks that are out, not
    by the number of jobs.
    """

    def __init__(
        self,
        client: Client,
        chunks: Chunks,
        journal: Journal,
        serve: ServeOptions,
        progress: Progress,
        wait_for_workers_s: float,
    ) -> None:
        """Take what is needed; nothing is sent before `run`."""
        self._client = client
        self._chunks = chunks
        self._journal = journal
        self._serve = serve
        self._progress = progress
        self._wait_for_workers_s = wait_for_workers_s
        self._out: dict[Hashable, _Chunk] = {}
        self._again: deque[_Chunk] = deque()
        self._suspects: deque[_Chunk] = deque()
        self._is_all_sent = False
        self._ended: queue.SimpleQueue[Future] = queue.SimpleQueue()
        self._slots = 0
        self._slots_seen_s = float("-inf")
        self._worker_seen_s = time.monotonic()
        #: How many jobs ended how, in this run.
        self.by_status: Counter[str] = Counter()

    def run(self) -> None:
        """Return once every job has its result in the journal.

        Raises:
            RunStopped: if the scheduler is gone, no worker is there for long, a worker cannot
                serve, or the journal cannot be written.
        """
        while self._out or self._again or self._suspects or not self._is_all_sent:
            self._look_for_workers()
            self._send()
            if self._out or self._slots == 0:
                self._collect()

    def _send(self) -> None:
        while len(self._out) < 2 * self._slots:
            chunk = self._next_chunk()
            if chunk is None:
                return
            future = self._client.submit(run_chunk, chunk.jobs, self._serve, pure=False)
            self._out[future.key] = chunk
            future.add_done_callback(self._ended.put)

    def _next_chunk(self) -> _Chunk | None:
        if self._again:
            return self._again.popleft()
        if not self._is_all_sent:
            jobs = self._chunks.take(self._slots)
            if jobs:
                return _Chunk(jobs)
            self._is_all_sent = True
        if self._suspects and not self._out:
            chunk = self._suspects.popleft()
            chunk.is_alone = True
            return chunk
        return None

    def _collect(self) -> None:
        ended = self._wait_for_some()
        finished = [future for future in ended if future.status == "finished"]
        if finished:
            self._keep(finished)
        for future in ended:
            if future.status != "finished":
                self._give_again(future)

    def _wait_for_some(self) -> list[Future]:
        try:
            ended = [self._ended.get(timeout=_LOOK_S)]
        except queue.Empty:
            return []
        while not self._ended.empty():
            ended.append(self._ended.get())
        return ended

    def _keep(self, futures: list[Future]) -> None:
        """Bring results home, in one request for all that are ready."""
        lines: list[str] = []
        chunks = [self._out.pop(future.key) for future in futures]
        try:
            gathered = self._client.gather(futures)
        except (Exception, asyncio.CancelledError):  # they died with their worker or scheduler
            self._check_scheduler()
            self._again.extend(chunks)
            return
        for chunk, results in zip(chunks, gathered, strict=True):
            self._chunks.observe(chunk.jobs, results)
            self.by_status.update(result.status for result in results)
            lines.extend(result.line for result in results)
        self._journal.append(lines)
        self._progress.show(self.by_status.total())

    def _give_again(self, future: Future) -> None:
        self._check_scheduler()
        chunk = self._out.pop(future.key)
        if future.status == "error":
            error = future.exception()
            if not isinstance(error, KilledWorker):
                raise RunStopped(f"a worker cannot do its jobs: {error}")
            chunk.deaths += len(chunk.jobs) == 1
        if chunk.is_alone and chunk.deaths > self._serve.tries:
            self._fail(chunk.jobs[0])
        elif chunk.deaths >= self._serve.tries:
            self._suspects.append(chunk)
        elif len(chunk.jobs) > 1:
            middle = len(chunk.jobs) // 2
            self._again.extend((_Chunk(chunk.jobs[:middle]), _Chunk(chunk.jobs[middle:])))
        else:
            self._again.append(chunk)

    def _fail(self, job: Job) -> None:
        result = Result(failed_line(job, _DIED, "crash"), "failed", 0.0)
        self._journal.append([result.line])
        self.by_status[result.status] += 1

    def _look_for_workers(self) -> None:
        """Count the slots, which come and go, once in a while."""
        self._check_scheduler()
        now = time.monotonic()
        if now - self._slots_seen_s < _LOOK_S:
            return
        try:
            self._slots = sum(self._client.nthreads().values())
        except (OSError, TimeoutError) as error:
            raise self._scheduler_gone() from error
        self._slots_seen_s = time.monotonic()
        if self._slots > 0:
            self._worker_seen_s = self._slots_seen_s
        elif now - self._worker_seen_s > self._wait_for_workers_s:
            raise RunStopped(
                f"no worker at the scheduler for {self._wait_for_workers_s:g} s; "
                "start some and run the same command again"
            )

    def _check_scheduler(self) -> None:
        if self._client.status != "running":
            raise self._scheduler_gone()

    def _scheduler_gone(self) -> RunStopped:
        return RunStopped(
            f"the scheduler is gone after {self.by_status.total()} results, which are kept; "
            "start one and run the same command again"
        )
