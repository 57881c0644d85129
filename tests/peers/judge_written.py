#!/usr/bin/env python3
"""Judges the OpenDRIVE that roadbed writes of maps with ASAM's own checker.

usage: judge_written.py ROADBED MAP...      needs the PyPI package asam-qc-opendrive

An OpenDRIVE map is compiled first, as it would come back as it stands otherwise. Prints what is an
error to theirs; exit status 1 if there is any but for a known reason."""
import collections
import logging
import subprocess
import sys
import tempfile
from pathlib import Path

logging.disable(logging.CRITICAL)

from qc_baselib import Configuration, IssueSeverity, Result  # noqa: E402
from qc_opendrive import constants  # noqa: E402
from qc_opendrive import main as checker  # noqa: E402

REASONS = {
    "asam.net:xodr:1.8.0:junctions.connection.one_link_to_incoming":
        "theirs asks those lanes of connecting roads which lead against the traffic, where the lane "
        "that leads into the junction has both directions",
}


def errors_in(file):
    configuration, result = Configuration(), Result()
    configuration.set_config_param("InputFile", str(file))
    result.register_checker_bundle(name=constants.BUNDLE_NAME, description="", summary="",
                                   version=constants.BUNDLE_VERSION)
    result.set_result_version(version=constants.BUNDLE_VERSION)
    checker.run_checks(configuration, result)
    return collections.Counter(
        issue.rule_uid for one in result.get_checker_results(constants.BUNDLE_NAME)
        for issue in one.issues if issue.level == IssueSeverity.ERROR)


def write(roadbed, path, scratch):
    source, out = path, Path(scratch) / "map.xodr"
    if path.endswith(".xodr"):
        source = Path(scratch) / "map.rbm"
        subprocess.run([roadbed, "import", path, "-o", source, "--force"], check=True,
                       capture_output=True)
    subprocess.run([roadbed, "export", source, "-o", out, "--force"], check=True,
                   capture_output=True)
    return out


def main():
    roadbed, *paths = sys.argv[1:]
    count = 0
    for path in paths:
        with tempfile.TemporaryDirectory() as scratch:
            errors = errors_in(write(roadbed, path, scratch))
        for rule, number in errors.items():
            reason = REASONS.get(rule)
            count += 0 if reason else number
            print(f"{Path(path).name}: {number} {rule}" + (f" ({reason})" if reason else ""))
    print(f"{len(paths)} maps written, {count} errors")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
