"""The journal: finished results, appended as they come; what resumption reads."""

import fcntl
import os
import secrets
from collections.abc import Iterable
from pathlib import Path
from types import TracebackType

from roadbed_cluster.errors import RunStopped

#: A file in the folder of results while a run is at work, or was when it died.
MARK = "unfinished"
_BLOCK = 1 << 16


class Journal:
    """Appends whole lines to `DIR/journal/cluster.jsonl`, as the only run at work in `DIR`.

    A run that died in the middle of a write leaves a torn last line; opening cuts it off. A write
    that fails (full disk) leaves the file as it was before.
    """

    def __init__(self, output: Path, force: bool = False) -> None:
        """Lock `output` as `roadbed batch` does, and open the journal in it.

        Raises:
            RunStopped: if another run has it, it cannot be written, or without `force` it holds
                files and is no batch's.
        """
        if not force and output.is_dir() and not _is_of_batch(output):
            raise RunStopped(f"{output}: holds files already; give --force to work in it")
        self._path = output / "journal" / "cluster.jsonl"
        self._files: list[int] = []
        #: What stands in the folder's `MARK` during this run, so that workers know the folder.
        self.mark = secrets.token_hex(16)
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            lock = self._open(output / "lock")
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            # The file also tells `roadbed batch` to sweep away half-written files of killed runs.
            (output / MARK).write_text(self.mark, encoding="ascii")
            self._file = self._open(self._path)
            self._end = _end_of_lines(self._file)
            os.ftruncate(self._file, self._end)
        except BlockingIOError:
            self.close()
            raise RunStopped(f"{output}: another run is at work in it") from None
        except OSError as error:
            self.close()
            raise RunStopped(f"{error.filename or self._path}: {error.strerror}") from error

    def _open(self, path: Path) -> int:
        self._files.append(os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666))
        return self._files[-1]

    def append(self, lines: Iterable[str]) -> None:
        """Append `lines` in one write.

        Raises:
            RunStopped: if they cannot be written, as on a full disk; none of them is kept then.
        """
        data = "".join(f"{line}\n" for line in lines).encode(errors="surrogateescape")
        try:
            written = 0
            while written < len(data):
                written += os.pwrite(self._file, data[written:], self._end + written)
        except OSError as error:
            os.ftruncate(self._file, self._end)
            raise RunStopped(
                f"{self._path}: {error.strerror}; make room and run the same command again"
            ) from error
        self._end += len(data)

    def close(self) -> None:
        """Let go of the folder."""
        for file in self._files:
            os.close(file)

    def __enter__(self) -> "Journal":
        """Return the journal itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Sync and close."""
        os.fsync(self._file)
        self.close()


def _is_of_batch(output: Path) -> bool:
    """Return whether a folder is empty, or one that batches have been at work in."""
    if (output / "journal").is_dir() or (output / MARK).exists():
        return True
    return all(entry.name == "lock" for entry in output.iterdir())


def _end_of_lines(file: int) -> int:
    """Return the offset just past the last line end in `file`, 0 where it has none."""
    end = os.fstat(file).st_size
    while end > 0:
        start = max(0, end - _BLOCK)
        found = os.pread(file, end - start, start).rfind(b"\n")
        if found >= 0:
            return start + found + 1
        end = start
    return 0
