"""Folders for what Dask keeps on disk: one's own, and on no module path.

Dask takes `dask-scratch-space` in the temporary folder, which another user of the host may have
made, and looks there first for every module that is imported later. Preloaded by schedulers,
nannies and workers (`--preload roadbed_cluster.scratch`), this module takes their folders off the
module path.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import dask

_DASK = "dask-scratch-space"


@contextmanager
def own_scratch() -> Iterator[Path]:
    """Let Dask keep its files in a new folder that nobody else can enter, removed at the end."""
    new_folder = TemporaryDirectory(prefix="roadbed-cluster-", ignore_cleanup_errors=True)
    with new_folder as folder, dask.config.set({"temporary-directory": folder}):
        yield Path(folder)


def leave_module_path() -> None:
    """Take Dask's folders off the module path of this process."""
    sys.path[:] = [entry for entry in sys.path if _DASK not in Path(entry).parts]


def dask_setup(_server: object) -> None:
    """Do so when Dask has started a scheduler, nanny or worker."""
    leave_module_path()
