"""Places on a map, and drives through a cloud, for tests/same_outputs.

The old program is asked what is where; a choice is seeded with the file's name, so it is the same
in every run. Both programs get the same places, even if the old one cannot read the file: then they
are somewhere, and the two have to refuse alike.
"""

import csv
import functools
import json
import os
import random
import subprocess
import tempfile
from pathlib import Path

PAIRS = 5  # of start and goal on each map
DRIVABLE = {"driving", "entry", "exit", "onRamp", "offRamp", "bidirectional"}
SECONDS = 120.0


def answer(program: str, words: list[str], folder: Path) -> str:
    """What the program prints; nothing if it takes too long."""
    try:
        return subprocess.run([program, *words], cwd=folder, capture_output=True, text=True,
                              timeout=SECONDS, errors="replace").stdout
    except subprocess.TimeoutExpired:
        return ""


def centrelines(program: str, map_file: Path) -> dict[str, list[dict]]:
    """Vertices of the centreline of each drivable lane (of all, if none is), by the lane's name."""
    with tempfile.TemporaryDirectory() as folder:
        answer(program, ["export", str(map_file), "-o", "lanes.csv"], folder)
        table = Path(folder, "lanes.csv")
        text = table.read_text() if table.exists() else ""
    rows = [row for row in csv.DictReader(text.splitlines()) if row["line"] == "centre"]
    lanes: dict[str, list[dict]] = {}
    for row in [row for row in rows if row["type"] in DRIVABLE] or rows:
        on_road = f"{row['road']}/{row['section']}/{row['lane']}"
        lanes.setdefault(on_road if row["road"] else row["lane"], []).append(row)
    return lanes


@functools.cache
def on_map(program: str, map_file: Path) -> dict[str, str]:
    """from1, to1 … (odd ones as X,Y, even ones as lane:NAME@S), a lane to avoid, and the files
    points, pairs and waypoints (along the longest lane)."""
    lanes = centrelines(program, map_file)
    lanes = lanes or {"1": [{"s_m": "0", "x_m": str(x), "y_m": "0"} for x in range(0, 30, 10)]}
    choice = random.Random(map_file.name)
    names = sorted(lanes)

    def place(n: int) -> str:
        name = choice.choice(names)
        row = choice.choice(lanes[name])
        return f"{row['x_m']},{row['y_m']}" if n % 2 else f"lane:{name}@{row['s_m']}"

    words = {f"{end}{n}": place(n) for n in range(1, PAIRS + 1) for end in ("from", "to")}
    rows = [choice.choice(lanes[choice.choice(names)]) for _ in range(40)]
    points = [f"{float(row['x_m']) + choice.uniform(-3, 3)!r},{row['y_m']}\n" for row in rows]
    pairs = [f'"{words[f"from{n}"]}","{words[f"to{n}"]}"\n' for n in range(1, PAIRS + 1)]
    longest = max(names, key=lambda name: float(lanes[name][-1]["s_m"]))
    return words | {
        "avoid": f"lane:{choice.choice(names)}",
        "points": "x_m,y_m\n" + "".join(points) + "1e7,-1e7\n",
        "pairs": "from,to\n" + "".join(pairs),
        "waypoints": "x_m,y_m\n" + "".join(f"{row['x_m']},{row['y_m']}\n"
                                           for row in lanes[longest][:200])}


@functools.cache
def through_cloud(program: str, file: Path) -> dict[str, str]:
    """The sensor's place, the ground's height, and a drive of up to 30 m through the middle."""
    try:
        box = json.loads(answer(program, ["occupancy", "info", str(file), "--json"], os.curdir))
        low, high = ([box["bounds"][f"{end}_{axis}_m"] for axis in "xyz"] for end in ("min", "max"))
    except (ValueError, KeyError, TypeError):
        low, high = [0.0, 0.0, 0.0], [20.0, 20.0, 2.0]
    x, y, z = (0.5 * (a + b) for a, b in zip(low, high))
    half = min(15.0, 0.5 * (high[0] - low[0]))
    return {"sensor": f"{x!r},{y!r},{z!r}", "ground": repr(low[2]),
            "crossing": f"t_s,x_m,y_m,heading_rad\n0,{x - half!r},{y!r},0\n"
                        f"3,{x!r},{y + 0.5!r},0.1\n6,{x + half!r},{y!r},-0.1\n"}
