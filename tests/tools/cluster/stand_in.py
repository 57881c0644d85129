#!/usr/bin/env python3
"""Stands in for `roadbed batch` in tests of faults: speaks its protocol, misbehaves when told to.

A job's options say what it does: {"do": "sleep", "seconds": 0.1}; `do` is one of
answer, no, sleep, hang, crash, exit, eat, kill-worker, babble, chatter, or write (a file).
"""

import hashlib
import json
import os
import resource
import signal
import sys
import time
from pathlib import Path


def hash_of(line: str) -> str:
    """Return the hash of a job: of its line and of what its inputs hold."""
    digest = hashlib.sha256(b"stand-in 1\n" + line.encode())
    for path in json.loads(line).get("inputs", []):
        digest.update(Path(path).read_bytes() if Path(path).is_file() else b"missing")
    return digest.hexdigest()


def answer(line: str, output: Path) -> dict[str, object]:
    """Return the result of a job, if its options let it."""
    job = json.loads(line)
    options = job["options"]
    do, hash_ = options["do"], hash_of(line)
    status, exit_, reason, cause = "done", 0, "", None
    result, files = {"least_clearance_m": 0.5}, []
    time.sleep(options.get("seconds", 0.0))
    if do == "no":
        status, exit_, reason = "no", 1, "conflict"
    elif do == "hang":
        signal.pause()
    elif do == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    elif do == "exit":
        os._exit(3)
    elif do == "eat":
        try:
            held = b""
            while True:
                held += b"\1" * 10_000_000
        except MemoryError:
            status, exit_, reason, cause = "failed", 4, "out of memory", "memory"
    elif do == "kill-worker":
        os.kill(os.getppid(), signal.SIGKILL)
        signal.pause()
    elif do == "babble":
        print('{"many":\n"lines"}', flush=True)
    elif do == "chatter":
        sys.stderr.write("words\n" * 100_000)
    missing = [path for path in job.get("inputs", []) if not Path(path).is_file()]
    if missing:
        status, exit_, reason, cause = "failed", 3, f"{missing[0]}: no such file", "input"
    elif do == "write":
        name = f"files/{hash_[:2]}/{hash_}.bin"
        try:
            path = output / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(hash_.encode() * options["lines"])
            files = [name]
        except OSError as error:
            path.unlink(missing_ok=True)
            status, exit_, reason, cause = "failed", 3, f"{name}: {error.strerror}", "disk"
    return {
        "hash": hash_,
        "job": job["job"],
        "status": status,
        "exit": exit_,
        "reason": reason,
        "cause": cause,
        "inputs": job.get("inputs", []),
        "options": options,
        "outputs": [],
        "result": result if status != "failed" else None,
        "files": files,
        "sha256": [hashlib.sha256((output / name).read_bytes()).hexdigest() for name in files],
    }


def serve(output: Path) -> None:
    """Answer jobs until the input ends."""
    for line in sys.stdin:
        print(json.dumps(answer(line.rstrip("\n"), output)), flush=True)


def journal(output: Path) -> dict[str, str]:
    """Return the results by hash; an answer that is there twice is a fault of the test."""
    results: dict[str, str] = {}
    answered = set()
    for path in sorted((output / "journal").glob("*.jsonl")):
        for line in path.read_bytes().split(b"\n")[:-1]:
            result = json.loads(line)
            assert result["hash"] not in answered, f"{result['hash']} is in the journal twice"
            if result["status"] != "failed":
                answered.add(result["hash"])
            results[result["hash"]] = line.decode()
    return results


def stands(line: str) -> bool:
    """Return whether the same job would come to this result again."""
    return json.loads(line)["cause"] in (None, "input")


def run_missing(lines: list[str], done: dict[str, str], output: Path) -> None:
    """Run one job after another."""
    for line in lines:
        hash_ = hash_of(line)
        if hash_ not in done:
            done[hash_] = json.dumps(answer(line, output))
            path = output / "journal" / "batch.jsonl"
            path.parent.mkdir(exist_ok=True)
            with path.open("a", encoding="utf-8") as file:
                file.write(done[hash_] + "\n")


def main() -> int:
    """Run `batch JOBS -o DIR`, with --list-missing or --merge, or `batch --serve -o DIR`."""
    if sys.argv[1] == "--version":
        print("roadbed stand-in 1")
        return 0
    arguments = [argument for argument in sys.argv[2:] if argument != "--quiet"]
    output = Path(arguments[arguments.index("-o") + 1])
    if "--job-memory" in arguments:
        megabytes = int(arguments[arguments.index("--job-memory") + 1].removesuffix("MB"))
        resource.setrlimit(resource.RLIMIT_AS, (megabytes * 1_000_000, megabytes * 1_000_000))
    if arguments[0] == "--serve":
        serve(output)
        return 0
    lines = Path(arguments[0]).read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines, 1):
        if not line.startswith("{"):
            print(f"{arguments[0]}:{number}: not a job", file=sys.stderr)
            return 3
    done = journal(output)
    if "--list-missing" in arguments:
        seen = {hash_ for hash_, line in done.items() if stands(line)}
        for line in lines:
            hash_ = hash_of(line)
            if hash_ not in seen:
                print(f"{hash_}\t{line}")
                seen.add(hash_)
        return 0
    output.mkdir(parents=True, exist_ok=True)
    if "--merge" not in arguments:
        done = {hash_: line for hash_, line in done.items() if stands(line)}
        run_missing(lines, done, output)
    elif any(hash_of(line) not in done for line in lines):
        print("jobs have no result", file=sys.stderr)
        return 3
    results = [
        json.dumps({"line": number, **json.loads(done[hash_of(line)])})
        for number, line in enumerate(lines, 1)
    ]
    try:
        (output / "results.jsonl").write_text("".join(f"{r}\n" for r in results), encoding="utf-8")
    except OSError as error:
        print(error, file=sys.stderr)
        return 3
    (output / "unfinished").unlink(missing_ok=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
