"""The journal: finished results, appended as they come; what resumption reads."""

import fcntl
import os
from collections.abc import Iterable
from pathlib import Path
from types import TracebackType

from roadbed_cluster.errors import RunStopped

_BLOCK = 1 << 16


class Journal:
    """Appends whole lines to `DIR/journal/cluster.jsonl`, the only writer of that file.

    A run that died in the middle of a write leaves a torn last line; opening cuts it off. A write
    that fails (full disk) leaves the file as it was before.
    """

    def __init__(self, output: Path) -> None:
        """Open the journal below `output`.

        Raises:
            RunStopped: if another run holds it, or it cannot be written.
        """
        self._path = output / "journal" / "cluster.jsonl"
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._file = os.open(self._path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        except OSError as error:
            raise RunStopped(f"{self._path}: {error.strerror}") from error
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            self._end = _end_of_lines(self._file)
            os.ftruncate(self._file, self._end)
        except BlockingIOError:
            self.close()
            raise RunStopped(f"{self._path}: another run is writing to {output}") from None
        except OSError as error:
            self.close()
            raise RunStopped(f"{self._path}: {error.strerror}") from error

    def append(self, lines: Iterable[str]) -> None:
        """Append `lines` in one write.

        Raises:
            RunStopped: if they cannot be written, as on a full disk; none of them is kept then.
        """
        data = "".join(f"{line}\n" for line in lines).encode()
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
        """Let go of the file."""
        os.close(self._file)

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
