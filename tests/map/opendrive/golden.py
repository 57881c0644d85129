#!/usr/bin/env python3
"""Usage: golden.py FOLDER > golden.json

Counts, lengths and areas of every OpenDRIVE file under FOLDER by an evaluation of its own (Python's
standard library only), or why a file cannot be read. The table is what roadbed's reader is compared
with, so nothing here is shared with it. Takes some minutes.
"""
import bisect
import json
import math
import pathlib
import sys
import xml.etree.ElementTree as ET

STEP_M = 0.2
POLYNOMIAL_STEP_M = 0.01  # some turn sharply within centimetres
SHORTEST_M = 1e-9
DRIVABLE = {"driving", "bidirectional", "entry", "mwyEntry", "exit", "mwyExit", "onRamp", "offRamp",
            "connectingRamp", "slipLane", "HOV"}


class Refused(Exception):
    pass


def number(node, name):
    text = node.get(name)
    if text is None:
        raise Refused(f"attribute {name} is missing")
    value = float(text)
    if not math.isfinite(value):
        raise Refused("needs a finite number")
    return value


class Cubics:
    """Records of a, b, c, d by station; 0 where there are none, and before the first one of a road.
    """

    def __init__(self, nodes, station, shift=None):
        self.of_road = shift is None
        shift = shift or 0.0
        self.records = sorted(((shift + number(n, station), *(number(n, k) for k in "abcd"))
                               for n in nodes), key=lambda r: r[0])
        self.stations = [r[0] for r in self.records]

    def at(self, s, beside):
        if not self.records or (self.of_road and beside < self.stations[0]):
            return 0.0
        s0, a, b, c, d = self.records[max(0, bisect.bisect_right(self.stations, beside) - 1)]
        ds = s - s0
        return a + ds * (b + ds * (c + ds * d))


def turned(angle, u, v):
    return math.cos(angle) * u - math.sin(angle) * v, math.sin(angle) * u + math.cos(angle) * v


def integrated(curvature, rate, length):
    """Clothoid by Simpson's rule over its heading."""
    n = 2 * max(4, math.ceil(abs(length)))
    x = y = 0.0
    for i in range(n + 1):
        s = length * i / n
        weight = 1 if i in (0, n) else (4 if i % 2 else 2)
        angle = curvature * s + rate * s * s / 2
        x += weight * math.cos(angle)
        y += weight * math.sin(angle)
    return x * length / (3 * n), y * length / (3 * n), curvature * length + rate * length ** 2 / 2


class Piece:
    def __init__(self, node):
        self.s, self.length = number(node, "s"), number(node, "length")
        self.x, self.y, self.heading = (number(node, k) for k in ("x", "y", "hdg"))
        self.shape = next((n for n in node if n.tag in
                           ("line", "arc", "spiral", "paramPoly3", "poly3")), None)
        if self.shape is None:
            raise Refused("no known curve")
        kind = self.shape.tag
        if kind == "paramPoly3":
            self.u = [number(self.shape, k + "U") for k in "abcd"]
            self.v = [number(self.shape, k + "V") for k in "abcd"]
            self.scale = 1.0 if self.shape.get("pRange") == "arcLength" else 1.0 / self.length
        elif kind == "arc":
            self.curvature, self.rate = number(self.shape, "curvature"), 0.0
        elif kind == "spiral":
            self.curvature = number(self.shape, "curvStart")
            self.rate = (number(self.shape, "curvEnd") - self.curvature) / self.length
        elif kind == "poly3":
            raise Refused("this script knows no poly3")

    def pose(self, s):
        ds = s - self.s
        kind = self.shape.tag
        if kind == "line":
            u, v, turn = ds, 0.0, 0.0
        elif kind == "arc" and self.curvature != 0.0:
            turn = self.curvature * ds
            u, v = math.sin(turn) / self.curvature, (1 - math.cos(turn)) / self.curvature
        elif kind in ("arc", "spiral"):
            u, v, turn = integrated(self.curvature, self.rate, ds)
        else:
            p = ds * self.scale
            u, v = (c[0] + p * (c[1] + p * (c[2] + p * c[3])) for c in (self.u, self.v))
            du, dv = (c[1] + p * (2 * c[2] + 3 * p * c[3]) for c in (self.u, self.v))
            turn = math.atan2(dv, du)
        dx, dy = turned(self.heading, u, v)
        return self.x + dx, self.y + dy, self.heading + turn


class Road:
    def __init__(self, node):
        self.length = number(node, "length")
        plan_view = node.find("planView")
        pieces = [] if plan_view is None else plan_view.findall("geometry")
        self.pieces = sorted((Piece(g) for g in pieces if number(g, "length") >= SHORTEST_M),
                             key=lambda p: p.s)
        self.piece_stations = [p.s for p in self.pieces]
        if not self.pieces or self.length <= 0:
            return
        lateral, lanes = node.find("lateralProfile"), node.find("lanes")
        self.roll = Cubics([] if lateral is None else lateral.findall("superelevation"), "s")
        self.offset = Cubics([] if lanes is None else lanes.findall("laneOffset"), "s")
        sections = [] if lanes is None else lanes.findall("laneSection")
        self.sections = sorted(sections, key=lambda n: number(n, "s"))

    def sides(self):
        """(start, end, sign, [(id, type, widths)] from inside) of every side of every section."""
        for sign, name in ((1, "left"), (-1, "right")):
            speaking = [s for s in self.sections
                        if s.get("singleSide") not in ("true", "1") or
                        (s.find(name) is not None and s.find(name).findall("lane"))]
            for i, section in enumerate(speaking):
                start = number(section, "s")
                end = number(speaking[i + 1], "s") if i + 1 < len(speaking) else self.length
                side = section.find(name)
                lanes = [] if side is None else side.findall("lane")
                found = sorted(((abs(int(lane.get("id"))), lane) for lane in lanes),
                               key=lambda pair: pair[0])
                if found and end - start > SHORTEST_M:
                    yield start, end, sign, [(lane.get("type"), Cubics(
                        lane.findall("width"), "sOffset", start)) for _, lane in found]

    def stations(self, start, end, lanes):
        marks = {start, end}
        for stations in (self.piece_stations, self.roll.stations, self.offset.stations,
                         *(width.stations for _, width in lanes)):
            marks.update(s for s in stations if start < s < end)
        marks = sorted(marks)
        for a, b in zip(marks, marks[1:]):
            kind = self.piece_at(0.5 * (a + b)).shape.tag
            steps = max(1, math.ceil((b - a) / (POLYNOMIAL_STEP_M if kind == "paramPoly3"
                                                else STEP_M)))
            for i in range(steps + 1):
                yield a + (b - a) * i / steps, 0.5 * (a + b)

    def piece_at(self, s):
        return self.pieces[max(0, bisect.bisect_right(self.piece_stations, s) - 1)]

    def borders(self, s, beside, sign, lanes):
        x, y, heading = self.piece_at(beside).pose(s)
        t = self.offset.at(s, beside)
        across = math.cos(self.roll.at(s, beside))
        points = []
        for width in (None, *(w for _, w in lanes)):
            t += sign * width.at(s, beside) if width else 0.0
            points.append((x - t * across * math.sin(heading), y + t * across * math.cos(heading)))
        return points


def measure(road):
    lanes = 0
    driving_m = area_m2 = 0.0
    for start, end, sign, side in road.sides():
        lanes += len(side)
        rows = [road.borders(s, beside, sign, side)
                for s, beside in road.stations(start, end, side)]
        for i, (kind, _) in enumerate(side):
            inner, outer = [r[i] for r in rows], [r[i + 1] for r in rows]
            ring = inner + outer[::-1]
            area_m2 += abs(sum(a[0] * b[1] - a[1] * b[0]
                               for a, b in zip(ring, ring[1:] + ring[:1]))) / 2
            if kind in DRIVABLE:
                centre = [((a[0] + b[0]) / 2, (a[1] + b[1]) / 2) for a, b in zip(inner, outer)]
                driving_m += sum(math.dist(a, b) for a, b in zip(centre, centre[1:]))
    return lanes, driving_m, area_m2


def objects_of(node):
    objects = node.find("objects")
    if objects is None:
        return 0
    count = len(objects.findall("bridge")) + len(objects.findall("tunnel"))
    for item in objects.findall("object"):
        if item.findall("repeat"):
            raise Refused("this script knows no repeat")
        count += max(1, len(item.findall("outline")) + len(item.findall("outlines/outline")))
    return count


def row(path):
    try:
        root = ET.parse(path).getroot()
    except ET.ParseError:
        return {"refused": "not well-formed XML"}
    for node in root.iter():  # the files of 1.8 have a namespace
        node.tag = node.tag.split("}")[-1]
    header = root.find("header")
    revision = None if header is None else header.get("revMajor")
    if revision not in (None, "1"):
        return {"refused": f"OpenDRIVE revision {revision}."}
    try:
        roads = [(node, Road(node)) for node in root.findall("road")]
        kept = [(node, road) for node, road in roads if road.pieces and road.length > 0]
        if not kept:
            return {"refused": "no road with a geometry"}
        measured = [measure(road) for _, road in kept]
    except Refused as reason:
        return {"refused": str(reason)}
    return {
        "roads": len(kept),
        "lanes": sum(m[0] for m in measured),
        "junctions": len({j.get("id") for j in root.findall("junction")}),
        "controllers": len(root.findall("controller")),
        "signals": sum(len(node.findall("signals/signal")) for node, _ in kept),
        "objects": sum(objects_of(node) for node, _ in kept),
        "driving_m": round(sum(m[1] for m in measured), 3),
        "lanes_m2": round(sum(m[2] for m in measured), 2),
    }


def main():
    folder = pathlib.Path(sys.argv[1])
    files = sorted(folder.rglob("*.xodr"))
    table = {str(path.relative_to(folder)): row(path) for path in files}
    json.dump(table, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
