"""What another user of the host can do to a run: tried as nobody, where the tests run as root."""

import os
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from test_security import descendants, sockets_of

from batches import command, environment, job, results, write_jobs
from dask_processes import wait_until

RECIPES = Path(__file__).parents[3] / "tools" / "cluster" / "recipes"
pytestmark = [
    pytest.mark.skipif(os.getuid() != 0, reason="only root can act as another user"),
    pytest.mark.skipif(shutil.which("setpriv") is None, reason="setpriv is not installed"),
]
#: Of what a worker, a nanny or a client imports late.
MODULES = ("roadbed_cluster", "cloudpickle", "json", "numpy", "pandas", "psutil", "multiprocessing")


def as_nobody(*words: object, **options: object) -> subprocess.CompletedProcess[str]:
    """Run a program as the user nobody."""
    other = ["setpriv", "--reuid=nobody", "--regid=nogroup", "--clear-groups", "--"]
    return subprocess.run(
        [*other, *map(str, words)], capture_output=True, text=True, timeout=60, **options
    )  # type: ignore[call-overload]


@pytest.fixture
def shared() -> Iterator[Path]:
    """Give a temporary folder that is everyone's, as /tmp is."""
    folder = Path(tempfile.mkdtemp(prefix="shared-"))
    folder.chmod(0o1777)
    yield folder
    shutil.rmtree(folder)


def plant(folder: Path, marks: Path) -> None:
    """Make, as nobody, a folder of modules that leave a mark when they are imported."""
    assert as_nobody("mkdir", "-m", "777", folder).returncode == 0
    code = f"open({str(marks)!r}, 'a').write(__name__ + '\\n'); raise ImportError"
    for module in MODULES:
        words = ["sh", "-c", 'printf %s "$1" >"$2"', "sh", code, folder / f"{module}.py"]
        assert as_nobody(*words).returncode == 0


def start(tmp_path: Path, shared: Path, seconds: float, **options: object) -> subprocess.Popen[str]:
    """Start a run of two workers whose temporary folder is everyone's."""
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1), job(2, "sleep", seconds=seconds), job(3)])
    return subprocess.Popen(
        command(jobs, "-o", tmp_path / "out", "--workers", 2, "--quiet"),
        env={**environment(), "TMPDIR": str(shared)}, text=True, stderr=subprocess.PIPE, **options,
    )  # type: ignore[call-overload, no-any-return]  # fmt: skip


def test_modules_in_scratch_folders_of_another_user_are_not_imported(
    tmp_path: Path, shared: Path
) -> None:
    marks = shared / "marks"
    marks.touch(0o666)
    marks.chmod(0o666)
    for name in ("dask-scratch-space", "dask-scratch-space-0", "dask-scratch-space-root"):
        plant(shared / name, marks)
    process = start(tmp_path, shared, 0.1)
    _, said = process.communicate(timeout=120)
    assert process.returncode == 0, said
    assert marks.read_text() == ""
    assert {result["status"] for result in results(tmp_path / "out")} == {"done"}


def test_workers_import_nothing_from_the_folder_that_the_run_is_started_in(
    tmp_path: Path, shared: Path
) -> None:
    marks = shared / "marks"
    marks.touch()
    marks.chmod(0o666)
    plant(shared / "here", marks)
    program = Path(sys.executable).with_name("roadbed-cluster")
    if not program.is_file():
        pytest.skip("roadbed-cluster is not installed beside Python")
    jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1), job(2)])
    words = [program, jobs, "-o", tmp_path / "out", "--workers", "2", "--quiet"]
    ended = subprocess.run(
        words, env=environment(), cwd=shared / "here", capture_output=True, text=True, timeout=120
    )
    assert ended.returncode == 0, ended.stderr
    assert marks.read_text() == ""


def mode_of(path: Path) -> int | None:
    """Return who may do what with a file; None once it is gone, as passing ones are."""
    try:
        return stat.S_IMODE(path.stat().st_mode)
    except FileNotFoundError:
        return None


def test_another_user_cannot_enter_what_a_run_keeps_and_it_is_gone_after_it(
    tmp_path: Path, shared: Path
) -> None:
    process = start(tmp_path, shared, 3.0)
    wait_until(
        lambda: list(shared.glob("roadbed-cluster-*/dask-scratch-space/worker-*")), "workers"
    )
    folders = list(shared.glob("roadbed-cluster-*"))
    passing = [each for each in shared.iterdir() if each not in folders]
    for folder in folders:
        assert mode_of(folder) is not None, folder
    for folder in folders + passing:
        mode = mode_of(folder)
        assert mode is None or mode & 0o077 == 0, folder
        assert as_nobody("ls", folder).returncode != 0
        assert as_nobody("touch", folder / "json.py").returncode != 0
    for pid in descendants(process.pid):
        assert as_nobody("cat", f"/proc/{pid}/environ").returncode != 0
        assert as_nobody("kill", "-9", pid).returncode != 0
    _, said = process.communicate(timeout=120)
    assert process.returncode == 0, said
    assert list(shared.iterdir()) == []


def own_certificates(folder: Path) -> Path:
    """Make certificates of a cluster of nobody's own."""
    made = folder / "certificates"
    done = as_nobody("bash", RECIPES / "certificates", made)
    assert done.returncode == 0, done.stderr
    return made


def listening(pid: int) -> list[int]:
    """Return the ports at which a process and what it started listen."""
    return [port for _, port in sockets_of(descendants(pid))]


SHAKE_HANDS = """
import socket, ssl, sys
port, ca, certificate, key = sys.argv[1:]
context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
context.load_cert_chain(certificate, key)
with socket.create_connection(("127.0.0.1", int(port)), timeout=5) as plain:
    with context.wrap_socket(plain) as each:
        sys.exit(7 if each.recv(1) else 3)
"""


def test_who_has_another_key_is_spoken_to_by_nothing_of_a_run(tmp_path: Path, shared: Path) -> None:
    theirs = own_certificates(shared)
    process = start(tmp_path, shared, 60.0)
    wait_until(lambda: len(listening(process.pid)) >= 5, "a scheduler, two nannies, two workers")
    files = [theirs / name for name in ("ca.pem", "cluster.pem", "cluster.key")]
    for port in listening(process.pid):
        tried = as_nobody("/usr/bin/env", "python3", "-I", "-c", SHAKE_HANDS, port, *files)
        assert tried.returncode == 1 and "ssl" in tried.stderr, (port, tried)
    assert process.poll() is None
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=120)
    assert "interrupted" in said


def test_a_scheduler_with_another_key_gets_no_client(tmp_path: Path, shared: Path) -> None:
    theirs = own_certificates(shared)
    ours = tmp_path / "ours"
    subprocess.run([RECIPES / "certificates", ours], check=True)
    words = [
        sys.executable, "-m", "dask", "scheduler", "--protocol", "tls", "--host", "127.0.0.1",
        "--port", "0", "--no-dashboard", "--dashboard-address", "127.0.0.1:0",
        "--tls-ca-file", theirs / "ca.pem", "--tls-cert", theirs / "cluster.pem",
        "--tls-key", theirs / "cluster.key", "--scheduler-file", tmp_path / "scheduler.json",
    ]  # fmt: skip
    scheduler = subprocess.Popen(list(map(str, words)), stderr=subprocess.DEVNULL)
    try:
        wait_until((tmp_path / "scheduler.json").exists, "a scheduler")
        time.sleep(0.2)
        port = listening(scheduler.pid)[0]
        jobs = write_jobs(tmp_path / "jobs.jsonl", [job(1)])
        ended = subprocess.run(
            command(jobs, "-o", tmp_path / "out", "--scheduler", f"tls://127.0.0.1:{port}",
                    "--tls-ca", ours / "ca.pem", "--tls-cert", ours / "cluster.pem",
                    "--tls-key", ours / "cluster.key"),
            env=environment(), capture_output=True, text=True, timeout=120,
        )  # fmt: skip
    finally:
        scheduler.kill()
        scheduler.wait()
    assert ended.returncode == 3
    assert "no scheduler answers" in ended.stderr


@pytest.mark.parametrize("recipe", ["certificates", "one_host_ssh", "one_node_slurm", "ssh"])
def test_recipes_take_no_folder_of_another_user(shared: Path, recipe: str) -> None:
    theirs = shared / "theirs"
    assert as_nobody("mkdir", "-m", "777", theirs).returncode == 0
    rest = ["host", "jobs.jsonl", "-o", "out"] if recipe == "ssh" else ["true"]
    if recipe == "certificates":
        rest = []
    ended = subprocess.run(
        [RECIPES / recipe, theirs, *rest], capture_output=True, text=True, timeout=60
    )
    assert ended.returncode != 0
    if "is missing" not in ended.stderr:
        assert "is not a folder of your own" in ended.stderr
    assert list(theirs.iterdir()) == []
