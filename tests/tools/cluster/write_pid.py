"""Preloaded by a worker: writes the pid of the worker to a file in the folder of the test."""

import os
from pathlib import Path

from distributed import Worker


def dask_setup(worker: Worker) -> None:
    """Write `NAME.pid`, whole or not at all."""
    file = Path(worker.local_directory).parents[1] / f"{worker.name}.pid"
    part = file.with_suffix(".part")
    part.write_text(str(os.getpid()))
    part.rename(file)
