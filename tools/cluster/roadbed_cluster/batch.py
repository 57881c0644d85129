"""The three ways in which `roadbed batch` is called; what a job is and when it is done is its."""

import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from roadbed_cluster.errors import UsageError
from roadbed_cluster.job import Job


class BatchFailed(Exception):
    """`roadbed batch` ended with a status that is not 0, and has said why on stderr."""

    def __init__(self, status: int) -> None:
        """Keep its exit status."""
        super().__init__(status)
        self.status = status


@dataclass(frozen=True)
class Batch:
    """A file of jobs, the folder of their results, and the program that knows both."""

    program: tuple[str, ...]  #: `roadbed`, or an interpreter and a script
    jobs: Path
    output: Path

    def missing(self) -> Iterator[Job]:
        """Yield the jobs without a result that stands, in order, each hash once, streamed.

        Raises:
            BatchFailed: at the end, if the file cannot be used.
        """
        with _start(self._command("--list-missing")) as process:
            assert process.stdout is not None
            try:
                for row in process.stdout:
                    hash_, _, line = row.rstrip("\n").partition("\t")
                    yield Job(hash_, line)
            except GeneratorExit:
                process.kill()
                raise
        if process.returncode != 0:
            raise BatchFailed(process.returncode)

    def merge(self) -> int:
        """Write what all results come to, in the order of the jobs; return the exit status."""
        with _start(self._command("--merge", "--quiet"), stdout=None) as process:
            return process.wait()

    def _command(self, *options: str) -> list[str]:
        return [*self.program, "batch", str(self.jobs), "-o", str(self.output), *options]


def _start(command: list[str], stdout: int | None = subprocess.PIPE) -> subprocess.Popen[str]:
    try:
        return subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=stdout,
            encoding="utf-8",
            errors="surrogateescape",
        )
    except OSError as error:
        raise UsageError(f"--roadbed: {command[0]}: {error.strerror}") from error
