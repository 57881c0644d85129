"""The program `roadbed` inside the package: `roadbed --help`, or `python -m roadbed`."""

import os
import sys
from pathlib import Path

PROGRAM = Path(__file__).parent / "bin" / "roadbed"


def main() -> None:
    """Becomes the program, with the arguments of this process."""
    os.execv(PROGRAM, [str(PROGRAM), *sys.argv[1:]])
