#!/usr/bin/env python3
"""Routes the same pairs on maps and on the OpenDRIVE or Autoware map that is written of them.

Usage: check_written_routes.py ROADBED [--autoware] [--pairs N] MAP...

Pairs are midpoints of random lanes, with headings, between which there is a route on the map; an
OpenDRIVE map is compiled first, as it would come back as it stands otherwise. An Autoware map is
written in the source's own coordinates. Midpoints that do not say which lane is meant are left out:
where the centre line of another lane runs within 25 cm, or the lane's own turns at once. On the written
map there must be a route as well, as long within 0.5 % and 1 m. Prints a row per map; exit status 1
if routes differ.
"""
import argparse
import csv
import math
import pathlib
import random
import subprocess
import sys
import tempfile

import shapely

SAME_M = 0.25
BENT = 0.8  # cosine between steps of a centre line that turns at once
STEP_M = 0.3  # beside its middle


def midpoints(listed):
    """Of each driving lane x, y, heading in the middle of its centre line."""
    lines = {}
    with open(listed, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["line"] == "centre" and row["type"] == "driving":
                lines.setdefault((row["road"], row["section"], row["lane"]), []).append(
                    (float(row["x_m"]), float(row["y_m"]), float(row["s_m"])))
    places = []
    shapes = [shapely.LineString([point[:2] for point in line]) for line in lines.values()]
    tree = shapely.STRtree(shapes)
    for line in lines.values():
        half = 0.5 * line[-1][2]
        near = [(a, b, math.atan2(b[1] - a[1], b[0] - a[0])) for a, b in zip(line, line[1:])
                if a[2] < b[2] and a[2] <= half + STEP_M and b[2] >= half - STEP_M]
        a, b, heading = next(one for one in near if one[1][2] >= half)
        share = (half - a[2]) / (b[2] - a[2])
        x, y = (a[k] + share * (b[k] - a[k]) for k in (0, 1))
        turns = any(math.cos(one[2] - heading) < BENT for one in near)
        alike = tree.query(shapely.Point(x, y), predicate="dwithin", distance=SAME_M)
        if not turns and len(alike) == 1:
            places.append((x, y, heading))
    return places


def routes(roadbed, source, pairs, scratch):
    asked, answers = f"{scratch}/pairs.csv", f"{scratch}/answers.csv"
    with open(asked, "w", encoding="utf-8") as file:
        file.write("from,to\n")
        for a, b in pairs:
            file.write(",".join('"' + ",".join(f"{v:.9f}" for v in p) + '"' for p in (a, b)) + "\n")
    run = subprocess.run([roadbed, "route", source, "--batch", asked, "-o", answers, "--force"],
                         capture_output=True, text=True)
    if run.returncode not in (0, 1):
        raise SystemExit(run.stderr)
    with open(answers, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def has_route(row):
    return row["found"] in ("1", "true", "yes")


def check(roadbed, path, wanted, autoware, scratch):
    def run(*words):
        subprocess.run([roadbed, *words, "--force"], check=True, capture_output=True)

    source, listed = path, f"{scratch}/map.csv"
    out = f"{scratch}/lanelet2_map.osm" if autoware else f"{scratch}/map.xodr"
    if path.endswith(".xodr"):
        source = f"{scratch}/map.rbm"
        run("import", path, "-o", source)
    run("export", source, "-o", out,
        *(["--profile", "autoware", "--crs", "unknown"] if autoware else []))
    run("export", source, "-o", listed)
    places, draw = midpoints(listed), random.Random(20261126)
    pairs, before = [], []
    for _ in range(20):
        tried = [(draw.choice(places), draw.choice(places)) for _ in range(2 * wanted)]
        for pair, row in zip(tried, routes(roadbed, source, tried, scratch)):
            if has_route(row):
                pairs.append(pair)
                before.append(row)
        if len(pairs) >= wanted:
            break
    pairs, before = pairs[:wanted], before[:wanted]
    after = routes(roadbed, out, pairs, scratch)
    lost = [i for i, row in enumerate(after) if not has_route(row)]
    off = [i for i, (a, b) in enumerate(zip(before, after)) if has_route(b) and
           abs(float(a["length_m"]) - float(b["length_m"])) > 1 + 0.005 * float(a["length_m"])]
    fine = not lost and not off
    print(f"{'ok ' if fine else 'BAD'} {pathlib.Path(path).name}: {len(pairs)} routes, "
          f"{len(lost)} lost, {len(off)} of another length")
    for i in (lost + off)[:3]:
        print(f"    {pairs[i][0]} to {pairs[i][1]}: {before[i]['length_m']} m, then "
              f"{after[i].get('length_m')} m")
    return fine


def main():
    options = argparse.ArgumentParser()
    options.add_argument("roadbed")
    options.add_argument("--autoware", action="store_true")
    options.add_argument("--pairs", type=int, default=300)
    options.add_argument("maps", nargs="+")
    options = options.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        fine = [check(options.roadbed, path, options.pairs, options.autoware, scratch)
                for path in options.maps]
    return 0 if all(fine) else 1


if __name__ == "__main__":
    sys.exit(main())
