#!/usr/bin/env python3
"""Makes surface.geojson, road surface without lanes. Usage: data/make_surface.py

A road 8 m wide and 160 m long, west to east, with a roundabout of 18 m around an island of 7 m in
its middle, and as a feature of its own a side road 6 m wide that comes from the north.
"""

import json
from math import asin, cos, degrees, pi, radians, sin, sqrt
from pathlib import Path as File

LAT, LON = 48.5, 9.0  # of the roundabout's centre
RADIUS, ISLAND, REACH = 18.0, 7.0, 80.0  # m
MAIN, SIDE = 8.0, 6.0  # m wide


def to_degrees(at):
    """East and north in metres from the centre; the ellipsoid's two radii there (WGS 84)."""
    a, e2 = 6378137.0, 0.00669437999014
    w = sqrt(1 - e2 * sin(radians(LAT)) ** 2)
    north_m, east_m = a * (1 - e2) / w**3, a / w * cos(radians(LAT))
    return [round(LON + degrees(at[0] / east_m), 9), round(LAT + degrees(at[1] / north_m), 9)]


def arc(radius, start, end, count):
    return [(radius * cos(start + (end - start) * i / count),
             radius * sin(start + (end - start) * i / count)) for i in range(count + 1)]


def feature(name, rings):
    closed = [[to_degrees(at) for at in ring + ring[:1]] for ring in rings]
    return {"type": "Feature", "id": name, "properties": {"highway": "residential", "name": name},
            "geometry": {"type": "Polygon", "coordinates": closed}}


def main():
    mouth, side_mouth = asin(MAIN / 2 / RADIUS), asin(SIDE / 2 / RADIUS)
    north = pi / 2
    outer = ([(REACH, -MAIN / 2), (REACH, MAIN / 2)] + arc(RADIUS, mouth, north - side_mouth, 12)
             + arc(RADIUS, north + side_mouth, pi - mouth, 12)
             + [(-REACH, MAIN / 2), (-REACH, -MAIN / 2)]
             + arc(RADIUS, pi + mouth, 2 * pi - mouth, 24))
    island = arc(ISLAND, 2 * pi, 0, 32)[:-1]
    left, right = arc(RADIUS, north + side_mouth, north - side_mouth, 1)
    side = [left, right, (SIDE / 2, 70.0), (-SIDE / 2, 70.0)]
    collection = {"type": "FeatureCollection",
                  "features": [feature("main road", [outer, island]),
                               feature("side road", [side])]}
    text = json.dumps(collection, separators=(",", ":")).replace("{\"type\":\"Feature\"", "\n{\"type\":\"Feature\"") + "\n"
    (File(__file__).parent / "surface.geojson").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
