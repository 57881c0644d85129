"""The way to a cluster: one of its own on 127.0.0.1, or a scheduler that runs already."""

import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import dask
from distributed import Client, LocalCluster, Security

from roadbed_cluster.cluster_options import ClusterOptions
from roadbed_cluster.errors import RunStopped
from roadbed_cluster.scratch import leave_module_path, own_scratch
from roadbed_cluster.work import end_idle_processes

_TIMEOUT_S = 10.0
#: No page is served anywhere, and the memory that counts is that of the processes on the workers.
_CONFIG = {
    "distributed.scheduler.http.routes": [],
    "distributed.scheduler.allowed-failures": 0,  # a worker's death is told at once
    "distributed.worker.http.routes": [],
    "distributed.worker.preload": ["roadbed_cluster.scratch"],
    "distributed.worker.memory.target": False,
    "distributed.worker.memory.spill": False,
    "distributed.worker.memory.pause": False,
    "distributed.worker.memory.terminate": False,
    "distributed.admin.tick.limit": "1h",
}


@contextmanager
def connect(options: ClusterOptions) -> Iterator[Client]:
    """Give a client of the cluster; a cluster of its own ends with it.

    A cluster of its own listens on 127.0.0.1 only, encrypted, and takes only clients that hold a
    key made for this run and kept in memory. What it keeps on disk nobody else can reach.

    Raises:
        RunStopped: if the scheduler cannot be reached, or none can be started.
    """
    security = _security(options)
    with dask.config.set(_CONFIG):
        _silence()
        if options.scheduler is None:
            # Nor do its processes import from the folder that the run is started in.
            os.environ["PYTHONSAFEPATH"] = "1"
            with own_scratch(), _own_cluster(options) as cluster, Client(cluster) as client:
                leave_module_path()  # the scheduler and the nannies are in this process
                yield client
            return
        try:
            client = Client(options.scheduler, timeout=_TIMEOUT_S, security=security)
        except (OSError, TimeoutError, ValueError) as error:
            raise RunStopped(
                f"{options.scheduler}: no scheduler answers ({str(error) or 'no handshake'}); "
                "start one there, and name it with tls:// where it has certificates, else with tcp://"
            ) from error
        try:
            yield client
            # Workers outlive the run; what they started for it does not.
            with suppress(OSError, TimeoutError):
                client.run(end_idle_processes)
        finally:
            client.close(timeout=2)


def _silence() -> None:
    """Let Dask say nothing: what a user must know, the run says in one line."""
    for name in list(logging.root.manager.loggerDict):
        if name.startswith("distributed"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)


def _own_cluster(options: ClusterOptions) -> LocalCluster:
    try:
        return LocalCluster(
            n_workers=options.workers,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            protocol="tls://",
            security=Security.temporary(),
            dashboard_address=None,
            # Without a port Dask would take 8787, and warn where a second run has it.
            scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
            memory_limit=0,
            silence_logs=logging.CRITICAL,
        )
    except (OSError, RuntimeError) as error:
        raise RunStopped(f"no cluster could be started on 127.0.0.1: {error}") from error


def _security(options: ClusterOptions) -> Security | None:
    if not options.is_encrypted:
        return None
    return Security(
        tls_ca_file=str(options.tls_ca),
        tls_client_cert=str(options.tls_cert),
        tls_client_key=str(options.tls_key),
        require_encryption=True,
    )
