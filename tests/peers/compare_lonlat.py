"""Longitudes and latitudes of `roadbed locate`, there and back, held against pyproj's.

Usage: compare_lonlat.py ROADBED LANELET2.osm OPENDRIVE.xodr

The OpenDRIVE map is asked as it is, and with a header offset that moves and turns it.
"""
import json
import math
import pathlib
import random
import re
import subprocess
import sys
import tempfile

import pyproj

LARGEST_M = 1e-3  # there and back, and beside pyproj
POINTS = 200


def asked(program, map_file, *words):
    run = subprocess.run([program, *words[:1], map_file, *words[1:], "--json"],
                         capture_output=True, text=True, check=False)
    return json.loads(run.stdout)


def points_file(folder, columns, points):
    file = pathlib.Path(folder) / "points.csv"
    rows = [",".join(columns)] + [f"{x!r},{y!r}" for x, y in points]
    file.write_text("\n".join(rows) + "\n")
    return str(file)


def offset_of(xodr):
    found = re.search(r'<offset x="([^"]+)" y="([^"]+)" z="[^"]*" hdg="([^"]+)"', xodr)
    return [float(number) for number in found.groups()] if found else [0.0, 0.0, 0.0]


def with_offset(xodr, folder):
    offset = '<offset x="1234.5" y="-2500.25" z="0" hdg="0.7"/>'
    file = pathlib.Path(folder) / "moved.xodr"
    file.write_text(xodr.replace("</geoReference>", "</geoReference>\n" + offset, 1))
    return str(file)


def compare(program, map_file):
    info = asked(program, map_file, "info")
    west, south, east, north = (info["bounds"][key]
                                for key in ("min_x_m", "min_y_m", "max_x_m", "max_y_m"))
    text = pathlib.Path(map_file).read_text()
    x0, y0, heading = offset_of(text) if map_file.endswith(".xodr") else (0.0, 0.0, 0.0)
    random.seed(20261125)
    points = [(random.uniform(west, east), random.uniform(south, north)) for _ in range(POINTS)]
    peer = pyproj.Transformer.from_crs(info["crs"], "OGC:CRS84", always_xy=True)
    cosine, sine = math.cos(heading), math.sin(heading)
    globe = pyproj.Geod(ellps="WGS84")
    worst = back_worst = 0.0
    with tempfile.TemporaryDirectory() as folder:
        there = asked(program, map_file, "locate", "--points",
                      points_file(folder, ("x_m", "y_m"), points), "--lonlat")["points"]
        lon_lat = [(point["lon_deg"], point["lat_deg"]) for point in there]
        back = asked(program, map_file, "locate", "--points",
                     points_file(folder, ("lon_deg", "lat_deg"), lon_lat))["points"]
    for (x, y), (lon, lat), again in zip(points, lon_lat, back, strict=True):
        theirs = peer.transform(x0 + cosine * x - sine * y, y0 + sine * x + cosine * y)
        worst = max(worst, globe.inv(lon, lat, *theirs)[2])
        back_worst = max(back_worst, math.hypot(again["x_m"] - x, again["y_m"] - y))
    print(f"{pathlib.Path(map_file).name}: {POINTS} points, {worst * 1e3:.6f} mm from pyproj's, "
          f"{back_worst * 1e3:.6f} mm there and back")
    return worst <= LARGEST_M and back_worst <= LARGEST_M


def main(program, lanelet2, open_drive):
    with tempfile.TemporaryDirectory() as folder:
        moved = with_offset(pathlib.Path(open_drive).read_text(), folder)
        agree = [compare(program, map_file) for map_file in (lanelet2, open_drive, moved)]
    return 0 if all(agree) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
