#!/usr/bin/env python3
"""Exports maps to OpenDRIVE and evaluates what was written from the standard's text.

Usage: check_open_drive.py ROADBED MAP...

An OpenDRIVE map is compiled first, as it would come back as it stands otherwise. Every 2 cm the
borders of the written lanes (ASAM OpenDRIVE 1.8: 9.3 geometry, 10.5 elevation, 10.6 superelevation,
11.3 lane offset, 11.6 width) must be within 1 cm of a border of the map, as `roadbed export` lists
them, and the map's borders within 1 cm of a written one, or as near as the export said, and
those of lanes on foot aside, of which crosswalks become objects; pieces of a reference line must join,
in place and in heading, and lanes that are linked must have borders that meet. Prints a row per map;
exit status 1 if something is farther off.
"""
import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import numpy as np
import scipy.spatial
import shapely

LARGEST_M = 0.01
TRUE_M = 0.001
STEP_M = 0.02
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)


def numbers(element, *names):
    return [float(element.get(name)) for name in names]


class Cubic:
    """Records a + b ds + c ds² + d ds³, the last one that starts at or before s."""

    def __init__(self, elements, station, start=0.0):
        rows = sorted(([start + float(e.get(station))] + numbers(e, "a", "b", "c", "d")
                       for e in elements), key=lambda row: row[0])
        self.rows = np.array(rows) if rows else np.zeros((1, 5))

    def __call__(self, s, before=False):
        side = "left" if before else "right"
        at = np.clip(np.searchsorted(self.rows[:, 0], s, side) - 1, 0, None)
        start, a, b, c, d = self.rows[at].T
        ds = s - start
        return a + ds * (b + ds * (c + ds * d))


class Geometry:
    def __init__(self, element):
        self.s, self.x, self.y, self.heading, self.length = numbers(
            element, "s", "x", "y", "hdg", "length")
        curve = element[0]
        if curve.tag == "line":
            self.k0, self.k1 = 0.0, 0.0
        elif curve.tag == "arc":
            self.k0 = self.k1 = float(curve.get("curvature"))
        else:
            self.k0, self.k1 = numbers(curve, "curvStart", "curvEnd")

    def turned(self, ds):
        return self.heading + ds * (self.k0 + 0.5 * (self.k1 - self.k0) * ds / self.length)

    def at(self, s):
        """Places and headings at growing stations: the heading integrated from one to the next."""
        ds = np.concatenate([[0.0], np.asarray(s) - self.s])
        low, high = ds[:-1], ds[1:]
        half = 0.5 * (high - low)
        nodes = self.turned(0.5 * (low + high)[:, None] + half[:, None] * NODES)
        x = self.x + np.cumsum(half * (np.cos(nodes) @ WEIGHTS))
        y = self.y + np.cumsum(half * (np.sin(nodes) @ WEIGHTS))
        return np.stack([x, y], 1), self.turned(high)


class Road:
    def __init__(self, element):
        self.id = element.get("id")
        self.length = float(element.get("length"))
        self.pieces = [Geometry(e) for e in element.find("planView")]
        self.offset = Cubic(element.findall("lanes/laneOffset"), "s")
        self.elevation = Cubic(element.findall("elevationProfile/elevation"), "s")
        self.lean = Cubic(element.findall("lateralProfile/superelevation"), "s")
        sections = element.findall("lanes/laneSection")
        starts = [float(e.get("s")) for e in sections]
        self.sections = []
        for place, section in enumerate(sections):
            start, end = starts[place], (starts + [self.length])[place + 1]
            lanes = {int(lane.get("id")): lane for lane in section.findall("*/lane")}
            widths = {i: Cubic(lane.findall("width"), "sOffset", start)
                      for i, lane in lanes.items() if i != 0}
            self.sections.append((start, end, widths, lanes))

    def joints(self):
        """The widest gap and the sharpest corner between pieces of the reference line."""
        gap, corner = 0.0, 0.0
        for a, b in zip(self.pieces, self.pieces[1:]):
            end, heading = a.at([a.s + a.length])
            gap = max(gap, math.hypot(*(end[0] - (b.x, b.y))))
            corner = max(corner, abs(math.remainder(heading[0] - b.heading, 2 * math.pi)))
        return gap, corner

    def reference(self, s):
        at, headings = np.empty((len(s), 2)), np.empty(len(s))
        starts = [piece.s for piece in self.pieces]
        of = np.clip(np.searchsorted(starts, s, "right") - 1, 0, None)
        for place, piece in enumerate(self.pieces):
            here = of == place
            if here.any():
                at[here], headings[here] = piece.at(s[here])
        return at, headings

    def borders(self, section):
        """By lane id, 0 being the middle: the border's x, y, z."""
        start, end, widths, _ = section
        # A border has corners only where a record or a piece starts.
        corners = np.concatenate([cubic.rows[:, 0] for cubic in (
            self.offset, self.elevation, self.lean, *widths.values())] +
            [[piece.s for piece in self.pieces]])
        s = np.union1d(np.linspace(start, end, max(2, int((end - start) / STEP_M) + 2)),
                       corners[(corners > start) & (corners < end)])
        at, headings = self.reference(s)
        normals = np.stack([-np.sin(headings), np.cos(headings)], 1)
        inside = np.minimum(s, end - 1e-9)
        lean = self.lean(s)
        found = {}

        def place(t):
            z = self.elevation(s) + t * np.sin(lean)
            return np.column_stack([at + (t * np.cos(lean))[:, None] * normals, z])

        found[0] = place(self.offset(inside))
        for sign in (1, -1):
            t = self.offset(inside)
            for lane in sorted((i for i in widths if i * sign > 0), key=abs):
                t = t + sign * widths[lane](inside)
                found[lane] = place(t)
        return found


def written(path):
    root = ElementTree.parse(path).getroot()
    return {road.id: road for road in map(Road, root.findall("road"))}, root


def listed_borders(path, but=frozenset()):
    """The map's borders but those of areas and some lanes."""
    lines = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            is_lane = row["line"] != "centre" and not row["lane"].startswith("area ")
            if is_lane and row["lane"] not in but:
                key = row["road"], row["section"], row["lane"], row["line"]
                lines.setdefault(key, []).append((float(row["x_m"]), float(row["y_m"])))
    return lines


def every_step(line):
    """A line with places between its points."""
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    stations = np.union1d(s, np.arange(0.0, s[-1], STEP_M))
    return np.stack([np.interp(stations, s, line[:, i]) for i in (0, 1)], 1)


def bounds(points, lines):
    """Of each point the distance to the segments at the nearest vertex: no less than to all."""
    vertices = np.concatenate(lines)
    ends = np.cumsum([len(line) for line in lines])
    before = np.arange(len(vertices)) - 1
    before[np.concatenate([[0], ends[:-1]])] += 1
    after = np.arange(len(vertices)) + 1
    after[ends - 1] -= 1
    nearest = scipy.spatial.KDTree(vertices).query(points)[1]

    def to_segment(other):
        start, along = vertices[nearest], vertices[other[nearest]] - vertices[nearest]
        square = np.maximum(np.einsum("ij,ij->i", along, along), 1e-300)
        share = np.clip(np.einsum("ij,ij->i", points - start, along) / square, 0.0, 1.0)
        return np.linalg.norm(points - start - share[:, None] * along, axis=1)

    return np.minimum(to_segment(before), to_segment(after))


def farthest(points, lines):
    """The largest distance of points to the nearest of the lines: measured of those that may be the
    farthest, in the order of their bounds, until no other can be."""
    points, together = np.concatenate(points), 1000
    bound = bounds(points, lines)
    order = np.argsort(-bound)
    # Cut into parts of few segments, as the tree knows boxes only.
    shapes = np.array([shapely.LineString(line[i:i + 9])
                       for line in lines for i in range(0, len(line) - 1, 8)])
    tree = shapely.STRtree(shapes)
    worst_m, at = 0.0, points[order[0]]
    for first in range(0, len(order), together):
        some = order[first:first + together]
        if bound[some[0]] <= worst_m:
            break
        asked = shapely.points(points[some])
        distance = shapely.distance(asked, shapes[tree.nearest(asked)])
        if distance.max() > worst_m:
            worst_m, at = float(distance.max()), points[some[np.argmax(distance)]]
    return worst_m, at


def link_gaps(roads, root, borders):
    """The widest step of a border from a lane to one that is linked to it."""
    widest = 0.0

    def ends(road, at_end, lane):
        section = len(roads[road].sections) - 1 if at_end else 0
        inner = lane - (1 if lane > 0 else -1)
        of = borders[road][section]
        row = -1 if at_end else 0
        return {tuple(of[i][row][:2]) for i in (inner, lane)}

    def step(a, b):
        return min(max(math.dist(p, q) for p, q in zip(a, order))
                   for order in (list(b), list(b)[::-1])) if len(a) == len(b) == 2 else 0.0

    for element in root.findall("road"):
        road = element.get("id")
        for name, at_end in (("predecessor", False), ("successor", True)):
            link = element.find(f"link/{name}")
            if link is None or link.get("elementType") != "road":
                continue
            other, other_end = link.get("elementId"), link.get("contactPoint") == "end"
            section = roads[road].sections[-1 if at_end else 0]
            for lane, node in section[3].items():
                for to in node.findall(f"link/{name}"):
                    a = list(ends(road, at_end, lane))
                    b = list(ends(other, other_end, int(to.get("id"))))
                    widest = max(widest, step(a, b))
    return widest


def check(program, path, scratch):
    def roadbed(*words):
        return subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout

    source, out, listed = path, f"{scratch}/map.xodr", f"{scratch}/map.csv"
    if path.endswith(".xodr"):
        source = f"{scratch}/map.rbm"
        roadbed("import", path, "-o", source, "--force")
    report = json.loads(roadbed("export", source, "-o", out, "--force", "--json"))
    roadbed("export", source, "-o", listed, "--force")
    roads, root = written(out)
    borders = {road.id: [road.borders(section) for section in road.sections]
               for road in roads.values()}
    lines = [line[:, :2] for of in borders.values() for section in of for line in section.values()]
    asked = listed_borders(listed)
    there, at = farthest(lines, list(asked.values()))
    left_out = {match[1] for match in map(re.compile(r"left out is lane ([^:]+): ").match,
                                          report["notes"]) if match}
    crosswalks = {node.get("id") for node in root.iter("object")
                  if node.get("type") == "crosswalk"}
    held = listed_borders(listed, but=left_out | crosswalks).values()
    back, back_at = farthest([every_step(np.array(line)) for line in held], lines)
    gap = max(road.joints()[0] for road in roads.values())
    corner = max(road.joints()[1] for road in roads.values())
    step = link_gaps(roads, root, borders)
    told = report["largest_error_m"]
    is_true = abs(max(there, back) - told) <= TRUE_M
    fine = is_true and step <= LARGEST_M and gap <= TRUE_M and corner < 1e-6
    print(f"{'ok ' if fine else 'BAD'} {pathlib.Path(path).name}: {len(roads)} roads, "
          f"{sum(len(road.pieces) for road in roads.values())} pieces, "
          f"{pathlib.Path(out).stat().st_size} of {pathlib.Path(path).stat().st_size} bytes, "
          f"borders {there:.4f} m off, back {back:.4f} m, told {told:.4f} m, "
          f"gap {gap:.1e} m, corner {corner:.1e} rad, step {step:.4f} m")
    if not fine:
        print(f"    farthest at {at}, back at {back_at}")
    return fine


def main():
    program, *paths = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        return 0 if all([check(program, path, scratch) for path in paths]) else 1


if __name__ == "__main__":
    sys.exit(main())
