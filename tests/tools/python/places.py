"""Where the tests find files: the project's own, and those of others, which may be missing."""

import os
from pathlib import Path

import pytest

DATA = Path(os.environ["ROADBED_DATA"])
REAL = Path(os.environ["ROADBED_REAL_DATA"])


def real(pattern: str) -> list[Path]:
    """Files of others that fit a pattern; skips the test where there are none."""
    files = sorted(REAL.glob(pattern))
    if not files:
        pytest.skip(f"no {pattern} in {REAL}: the files of others are not here")
    return files
