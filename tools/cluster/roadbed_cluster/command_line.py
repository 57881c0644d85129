"""The command `roadbed-cluster`: its options, its messages, its exit status."""

import argparse
import math
import os
import re
import shutil
import sys
import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from roadbed_cluster.batch import Batch, BatchFailed
from roadbed_cluster.cluster_options import ClusterOptions
from roadbed_cluster.errors import RunStopped, UnusableResults, UsageError
from roadbed_cluster.run import RunOptions, run
from roadbed_cluster.visible import visible

# 0 is yes and 1 no, as `roadbed batch` says.
_WRONG_USAGE, _UNUSABLE, _OWN_FAULT = 2, 3, 4

_RUN_EXAMPLE = """\
example:
  roadbed-cluster audits.jsonl -o audits --workers 4 --time-limit 60 --job-memory 2GB
  roadbed-cluster audits.jsonl -o audits --scheduler tls://10.0.0.1:8786 \\
      --tls-ca ca.pem --tls-cert me.pem --tls-key me.key
  roadbed-cluster tables audits
"""
_TABLES_EXAMPLE = """\
example:
  roadbed-cluster tables audits
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return an exit status of `roadbed`: 3 too where the run stopped."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    try:
        if given[:1] == ["tables"]:
            return _tables(_tables_parser().parse_args(given[1:]))
        return _run(_run_parser().parse_args(given))
    except BatchFailed as failed:
        return failed.status
    except (RunStopped, UnusableResults) as stopped:
        return _say(str(stopped), _UNUSABLE)
    except UsageError as error:
        return _say(str(error), _WRONG_USAGE)
    except BrokenPipeError:
        return _UNUSABLE
    except KeyboardInterrupt:
        return _say("interrupted; what is finished is kept, the same command goes on", _UNUSABLE)
    except Exception:
        traceback.print_exc()
        return _OWN_FAULT


def _run(options: argparse.Namespace) -> int:
    _check_paths(options.jobs, options.output)
    batch = Batch(
        program=_program(options.roadbed),
        jobs=options.jobs.resolve(),
        output=options.output.resolve(),
    )
    cluster = ClusterOptions(
        scheduler=options.scheduler,
        workers=options.workers,
        tls_ca=options.tls_ca,
        tls_cert=options.tls_cert,
        tls_key=options.tls_key,
    )
    cluster.check()
    return run(
        batch,
        cluster,
        RunOptions(
            time_limit_s=options.time_limit,
            job_memory=options.job_memory,
            tries=options.tries,
            chunk_s=options.chunk,
            wait_for_workers_s=options.wait,
            tables=not options.no_tables,
            force=options.force,
            quiet=options.quiet,
        ),
    )


def _check_paths(jobs: Path, output: Path) -> None:
    if jobs.is_dir():
        raise RunStopped(f"{jobs}: is a folder; `roadbed jobs` writes a file of jobs")
    if not jobs.is_file():
        raise RunStopped(f"{jobs}: no such file")
    if output.exists() and not output.is_dir():
        raise RunStopped(f"{output}: is no folder; name one for the results")


def _tables(options: argparse.Namespace) -> int:
    # Only here: Parquet and Dask take a second to import, and help needs neither.
    from roadbed_cluster.tables import write_tables

    for path in write_tables(options.folder):
        print(visible(str(path)))
    return 0


def _program(given: str) -> tuple[str, ...]:
    """Return the program's absolute path, as workers on other hosts must find it too."""
    found = shutil.which(given)
    if found is None:
        raise UsageError(f"--roadbed: {given}: no such program; build roadbed and name it here")
    return (str(Path(found).resolve()),)


def _say(message: str, status: int) -> int:
    print(f"roadbed-cluster: {visible(message)}", file=sys.stderr)
    return status


@dataclass(frozen=True)
class _Number:
    """A number option's type: finite, within bounds, whole if `whole`."""

    least: float
    whole: bool = False

    def __call__(self, text: str) -> float | int:
        try:
            value = int(text) if self.whole else float(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
        if not (math.isfinite(value) and value >= self.least):
            raise argparse.ArgumentTypeError(f"{text} is not {self.least:g} or more")
        return value


def _size(text: str) -> str:
    """Check an amount of memory as `roadbed batch --job-memory` takes it."""
    number = re.fullmatch(r"([0-9]+(?:\.[0-9]+)?) ?(?:TB|GB|MB|kB|B)?", text)
    if number is None or float(number[1]) == 0.0:
        raise argparse.ArgumentTypeError(f"{text!r} is no size such as 4GB or 512MB")
    return text


def _run_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="roadbed-cluster",
        description="Run a batch of roadbed jobs on a Dask cluster. Running it again does only "
        "what is missing. `roadbed-cluster tables DIR` writes the Parquet tables of a folder.",
        epilog=_RUN_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("jobs", metavar="JOBS.jsonl", type=Path, help="one job a line")
    parser.add_argument(
        "-o",
        dest="output",
        metavar="DIR",
        type=Path,
        required=True,
        help="folder of the results, seen by every worker under this path",
    )
    _add_cluster_options(parser)
    _add_job_options(parser)
    parser.add_argument(
        "-f",
        "--force",
        action="store_true",
        help="work in a folder that holds files and is no batch's",
    )
    parser.add_argument("--no-tables", action="store_true", help="write no Parquet tables")
    parser.add_argument("--quiet", action="store_true", help="no progress and no notes")
    return parser


def _add_cluster_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("cluster")
    group.add_argument(
        "--scheduler",
        metavar="tcp://HOST:PORT",
        help="Dask scheduler; default: a cluster of its own on 127.0.0.1",
    )
    group.add_argument(
        "--workers",
        metavar="N",
        type=_Number(1, whole=True),
        help="workers of a cluster of its own; default: one per core",
    )
    group.add_argument(
        "--wait",
        metavar="S",
        type=_Number(0),
        default=60.0,
        help="stop when no worker is there for this long (default 60 s)",
    )
    group.add_argument(
        "--tls-ca",
        metavar="FILE",
        type=Path,
        help="certificate of who signed the cluster's certificates (.pem)",
    )
    group.add_argument(
        "--tls-cert", metavar="FILE", type=Path, help="this client's certificate (.pem)"
    )
    group.add_argument("--tls-key", metavar="FILE", type=Path, help="this client's key (.pem)")


def _add_job_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("jobs")
    group.add_argument(
        "--roadbed",
        metavar="PROGRAM",
        default=os.environ.get("ROADBED", "roadbed"),
        help="the program, at this path on every worker too (default: $ROADBED, else roadbed)",
    )
    group.add_argument(
        "--time-limit",
        metavar="S",
        type=_Number(0.001),
        help="seconds a job may take; past it, it has failed",
    )
    group.add_argument(
        "--job-memory",
        metavar="SIZE",
        type=_size,
        help="memory a job may take, such as 2GB; past it, it has failed",
    )
    group.add_argument(
        "--tries",
        metavar="N",
        type=_Number(1, whole=True),
        default=3,
        help="tries of a job that crashes (default 3)",
    )
    group.add_argument(
        "--chunk",
        metavar="S",
        type=_Number(0.01),
        default=1.5,
        help="work that goes to a worker at once (default 1.5 s)",
    )


def _tables_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="roadbed-cluster tables",
        description="Write a Parquet table per kind of job from DIR/results.jsonl to DIR/tables; "
        "a GeoParquet table where the kind has geometry.",
        epilog=_TABLES_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("folder", metavar="DIR", type=Path, help="folder of a batch's results")
    return parser
