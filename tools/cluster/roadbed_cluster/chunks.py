"""How many jobs go to a worker at once: about a second and a half of work."""

from collections import deque
from collections.abc import Iterator

from roadbed_cluster.job import Job, Result, kind_of

#: The most jobs in one chunk, so that a chunk of jobs that take no time stays small.
_MOST_JOBS = 2000
#: Jobs read ahead of those handed out: enough for the last chunks to be cut evenly.
_READ_AHEAD = 4000
#: The share of a new measurement in what a kind of job is expected to take.
_WEIGHT = 0.3


class Chunks:
    """Cuts a stream of jobs, in order, into chunks of about `target_s` seconds each.

    What a job takes is expected by its kind, from the jobs of that kind that are finished; of an
    unknown kind one job goes alone. Once the end of the stream is in sight, chunks shrink so that
    all slots end together.
    """

    def __init__(self, jobs: Iterator[Job], target_s: float) -> None:
        """Cut `jobs`; nothing is read before the first `take`."""
        self._jobs = jobs
        self._target_s = target_s
        self._ahead: deque[tuple[Job, str]] = deque()
        self._ended = False
        self._expected_s: dict[str, float] = {}

    def observe(self, jobs: list[Job], results: list[Result]) -> None:
        """Learn from a finished chunk what its kinds of jobs take."""
        taken: dict[str, list[float]] = {}
        for job, result in zip(jobs, results, strict=True):
            taken.setdefault(kind_of(job), []).append(result.seconds)
        for kind, seconds in taken.items():
            mean_s = sum(seconds) / len(seconds)
            old_s = self._expected_s.get(kind, mean_s)
            self._expected_s[kind] = old_s + _WEIGHT * (mean_s - old_s)

    def take(self, slots: int) -> list[Job]:
        """Return the next chunk for one of `slots` slots; empty at the end of the stream."""
        self._read_ahead()
        limit_s = self._target_s
        if self._ended:
            left_s = sum(self._expected_s.get(kind, self._target_s) for _, kind in self._ahead)
            limit_s = min(limit_s, left_s / (3 * max(1, slots)))
        chunk: list[Job] = []
        sum_s = 0.0
        while self._ahead and len(chunk) < _MOST_JOBS:
            job, kind = self._ahead[0]
            sum_s += self._expected_s.get(kind, self._target_s)
            if chunk and sum_s > limit_s:
                break
            chunk.append(job)
            self._ahead.popleft()
        return chunk

    def _read_ahead(self) -> None:
        while not self._ended and len(self._ahead) < _READ_AHEAD:
            job = next(self._jobs, None)
            if job is None:
                self._ended = True
            else:
                self._ahead.append((job, kind_of(job)))
