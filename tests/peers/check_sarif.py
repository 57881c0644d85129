#!/usr/bin/env python3
"""Reads what `roadbed validate --sarif` writes with the models of SARIF 2.1.0 of sarif-pydantic.

usage: check_sarif.py ROADBED MAP...      needs the PyPI package sarif-pydantic

Per map: the file fits the models, has nothing that they do not know, every result names a rule that
the driver describes (but a reader's remark, import.…), and there are as many as `validate --json` has. One line per map, exit status 1
if anything is wrong."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import pydantic
from sarif_pydantic import Sarif

# Of SARIF 2.1.0 (sections 3.13.3 and 3.14.17), but not of the models.
FORGOTTEN = {"$schema", "columnKind"}


def unknown_names(value, path="sarif"):
    """Where the document has names that the models do not know."""
    if isinstance(value, pydantic.BaseModel):
        for name in value.model_extra or {}:
            yield f"{path}.{name}"
        for name in type(value).model_fields:
            yield from unknown_names(getattr(value, name), f"{path}.{name}")
    elif isinstance(value, list):
        for i, item in enumerate(value):
            yield from unknown_names(item, f"{path}[{i}]")


def check(roadbed, map_file, folder):
    output = folder / "findings.sarif"
    run = subprocess.run([roadbed, "validate", map_file, "--quiet", "--json", "--sarif", output],
                         stdout=subprocess.PIPE, text=True)
    try:
        sarif = Sarif.model_validate_json(output.read_text())
    except (OSError, pydantic.ValidationError) as error:
        return [str(error).splitlines()[0]], 0
    faults = [name for name in unknown_names(sarif) if name.split(".")[-1] not in FORGOTTEN]
    results = sarif.runs[0].results or []
    known = {rule.id for rule in sarif.runs[0].tool.driver.rules}
    faults += [f"{r.rule_id} is not described" for r in results
               if r.rule_id not in known and not r.rule_id.startswith("import.")]
    expected = len(json.loads(run.stdout)["findings"])
    if len(results) != expected:
        faults.append(f"{len(results)} results, {expected} findings")
    return faults, len(results)


def main():
    roadbed, files = sys.argv[1], sys.argv[2:]
    wrong = False
    for file in files:
        with tempfile.TemporaryDirectory() as folder:
            faults, results = check(roadbed, file, Path(folder))
        print(f"{Path(file).name}: {results} results, " +
              ("; ".join(faults[:8]) or "as SARIF 2.1.0 has them"))
        wrong = wrong or bool(faults)
    sys.exit(wrong)


if __name__ == "__main__":
    main()
