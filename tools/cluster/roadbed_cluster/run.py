"""A whole run: what is missing, done on the cluster, merged into tables."""

import sys
import time
from dataclasses import dataclass
from pathlib import Path

from roadbed_cluster.batch import Batch
from roadbed_cluster.chunks import Chunks
from roadbed_cluster.cluster_options import ClusterOptions
from roadbed_cluster.errors import UsageError
from roadbed_cluster.journal import MARK, Journal
from roadbed_cluster.progress import Progress
from roadbed_cluster.serve import ServeOptions, WrongWorker, version_of
from roadbed_cluster.visible import visible


@dataclass(frozen=True)
class RunOptions:
    """How far a job may go, and what is said and written."""

    time_limit_s: float | None = None
    job_memory: str | None = None
    tries: int = 3
    chunk_s: float = 1.5
    wait_for_workers_s: float = 60.0
    tables: bool = True
    force: bool = False
    quiet: bool = False


def run(batch: Batch, cluster: ClusterOptions, options: RunOptions) -> int:
    """Do what is missing, merge, write the tables; return the exit status of the merge.

    Raises:
        RunStopped: if it cannot go on; what is finished is kept.
        UsageError: if an option cannot be used.
        BatchFailed: if `roadbed batch` cannot use the jobs.
    """
    try:
        version = version_of(batch.program)
    except WrongWorker as error:
        raise UsageError(f"--roadbed: {error}") from error
    if next(batch.missing(), None) is not None:
        _run_missing(batch, version, cluster, options)
    status = batch.merge()
    is_merged = not (batch.output / MARK).exists()  # `roadbed batch` removes it when all is done
    if options.tables and is_merged:
        from roadbed_cluster.tables import write_tables

        write_tables(batch.output)
    return status


def _run_missing(batch: Batch, version: str, cluster: ClusterOptions, options: RunOptions) -> None:
    # Only now: Dask takes a second to import, and where nothing is missing none is needed.
    from roadbed_cluster.connection import connect
    from roadbed_cluster.dispatch import Dispatcher

    begin = time.monotonic()
    progress = Progress(options.quiet)
    with Journal(batch.output, options.force) as journal, connect(cluster) as client:
        serve = ServeOptions(
            program=batch.program,
            version=version,
            output=str(batch.output),
            mark=journal.mark,
            folder=str(Path.cwd()),
            time_limit_s=options.time_limit_s,
            job_memory=options.job_memory,
            tries=options.tries,
        )
        # Listed again, as another run may have been at work before this one had the folder.
        chunks = Chunks(batch.missing(), options.chunk_s)
        dispatcher = Dispatcher(
            client, chunks, journal, serve, progress, options.wait_for_workers_s
        )
        try:
            dispatcher.run()
        finally:
            progress.clear()
    if not options.quiet:
        _say(dispatcher.by_status, time.monotonic() - begin)


def _say(by_status: dict[str, int], seconds: float) -> None:
    parts = ", ".join(f"{count} {status}" for status, count in sorted(by_status.items()))
    done = sum(by_status.values())
    print(visible(f"{done} jobs in {seconds:.1f} s: {parts}"), file=sys.stderr)
