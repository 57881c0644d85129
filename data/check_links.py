#!/usr/bin/env python3
"""Checks an OpenDRIVE file: do pieces, sections and linked lanes meet? Usage: check_links.py F.xodr

Reads the file anew and evaluates it with code that shares nothing with what made it. Prints the
largest gaps; exit status 1 if borders of linked driving lanes are 1 mm or more apart, pieces of a
reference line 1e-6 m or 1e-9 rad, or some driving lane cannot be reached from some other.
"""

import sys
from collections import defaultdict
from math import atan2, cos, hypot, pi, remainder, sin
from xml.etree import ElementTree

DRIVEN = {"driving", "entry", "exit", "onRamp", "offRamp"}


def number(node, name):
    return float(node.get(name))


def in_piece(node, ds):
    """Pose after ds metres of a <geometry>."""
    x, y, heading, length = (number(node, name) for name in ("x", "y", "hdg", "length"))
    shape = node[0]
    if shape.tag == "paramPoly3":
        p = ds / length
        a, b, c, d = (number(shape, k + "U") for k in "abcd")
        u, du = a + p * (b + p * (c + p * d)), b + p * (2 * c + 3 * p * d)
        a, b, c, d = (number(shape, k + "V") for k in "abcd")
        v, dv = a + p * (b + p * (c + p * d)), b + p * (2 * c + 3 * p * d)
        turn = atan2(dv, du)
    elif shape.tag == "arc":
        k = number(shape, "curvature")
        u, v, turn = sin(k * ds) / k, (1 - cos(k * ds)) / k, k * ds
    elif shape.tag == "spiral":
        k0, k1 = number(shape, "curvStart"), number(shape, "curvEnd")
        angle = lambda s: k0 * s + (k1 - k0) / length * s * s / 2
        steps = 2000  # Simpson's rule
        weights = [1] + [4, 2] * (steps // 2 - 1) + [4, 1]
        grid = [angle(ds * i / steps) for i in range(steps + 1)]
        u = ds / steps / 3 * sum(w * cos(a) for w, a in zip(weights, grid))
        v = ds / steps / 3 * sum(w * sin(a) for w, a in zip(weights, grid))
        turn = angle(ds)
    else:
        u, v, turn = ds, 0.0, 0.0
    c, s = cos(heading), sin(heading)
    return x + c * u - s * v, y + s * u + c * v, heading + turn


def value(nodes, s, station="s", base=0.0):
    """The cubic that holds at s, 0 where there is none."""
    held = [node for node in nodes if number(node, station) + base <= s + 1e-9]
    if not held:
        return 0.0
    ds = s - base - number(held[-1], station)
    a, b, c, d = (number(held[-1], k) for k in "abcd")
    return a + ds * (b + ds * (c + ds * d))


class Road:
    def __init__(self, node):
        self.node, self.id, self.length = node, node.get("id"), number(node, "length")
        self.pieces = node.findall("planView/geometry")
        self.sections = node.findall("lanes/laneSection")
        starts = [number(section, "s") for section in self.sections]
        self.ranges = list(zip(starts, starts[1:] + [self.length]))
        self.in_junction = node.get("junction") != "-1"

    def lanes(self, section):
        return {int(lane.get("id")): lane
                for side in ("left", "right") for lane in section.findall(side + "/lane")}

    def borders(self, index, lane, s):
        """Inner and outer border of a lane at road station s."""
        section, base = self.sections[index], self.ranges[index][0]
        lanes, sign = self.lanes(section), 1 if lane > 0 else -1
        widths = [value(lanes[sign * k].findall("width"), s, "sOffset", base)
                  for k in range(1, abs(lane) + 1)]
        offset = value(self.node.findall("lanes/laneOffset"), s)
        piece = [p for p in self.pieces if number(p, "s") <= s + 1e-9][-1]
        x, y, heading = in_piece(piece, s - number(piece, "s"))
        flat = cos(value(self.node.findall("lateralProfile/superelevation"), s))
        z = value(self.node.findall("elevationProfile/elevation"), s)
        at = lambda t: (x - sin(heading) * t * flat, y + cos(heading) * t * flat, z)
        return at(offset + sign * sum(widths[:-1])), at(offset + sign * sum(widths))

    def end_of(self, index, lane, at_end):
        """Left and right border where a lane meets its neighbour, in the road's direction."""
        return self.borders(index, lane, self.ranges[index][1 if at_end else 0])


def apart(a, b):
    return hypot(*(p - q for p, q in zip(a, b)))


def link_of(lane, tag):
    node = lane.find(f"link/{tag}")
    return None if node is None else int(node.get("id"))


def check(file):
    root = ElementTree.parse(file).getroot()
    roads = {node.get("id"): Road(node) for node in root.findall("road")}
    place_gap = heading_gap = border_gap = 0.0
    for road in roads.values():
        for before, after in zip(road.pieces, road.pieces[1:]):
            end, start = in_piece(before, number(before, "length")), in_piece(after, 0.0)
            place_gap = max(place_gap, apart(end[:2], start[:2]))
            heading_gap = max(heading_gap, abs(remainder(end[2] - start[2], 2 * pi)))

    ways = defaultdict(set)  # (road, section, lane) -> those that one drives to next
    driven, links = set(), 0

    def connect(road, index, lane, at_end, other, other_index, other_lane, other_end):
        nonlocal border_gap, links
        if roads[road].lanes(roads[road].sections[index])[lane].get("type") not in DRIVEN:
            return
        here = roads[road].end_of(index, lane, at_end)
        there = roads[other].end_of(other_index, other_lane, other_end)
        gap = max(apart(a, b) for a, b in zip(here, there))
        if gap > 1e-3:
            print(f"road {road}/{index}/{lane} and {other}/{other_index}/{other_lane}: {gap:.4f} m")
        border_gap, links = max(border_gap, gap), links + 1
        forward = (lane < 0) == at_end  # towards the other
        a, b = (road, index, lane), (other, other_index, other_lane)
        ways[a if forward else b].add(b if forward else a)

    for road in roads.values():
        last = len(road.sections) - 1
        for index, section in enumerate(road.sections):
            lanes = road.lanes(section)
            for lane, node in lanes.items():
                if node.get("type") in DRIVEN:
                    driven.add((road.id, index, lane))
                if index < last and (to := link_of(node, "successor")) is not None:
                    connect(road.id, index, lane, True, road.id, index + 1, to, False)
                for tag, at_end in (("predecessor", False), ("successor", True)):
                    neighbour = road.node.find(f"link/{tag}")
                    at_border = index == (last if at_end else 0)
                    if not at_border or neighbour is None:
                        continue
                    to = link_of(node, tag)
                    if neighbour.get("elementType") == "road" and to is not None:
                        other = roads[neighbour.get("elementId")]
                        ends_there = neighbour.get("contactPoint") == "end"
                        connect(road.id, index, lane, at_end, other.id,
                                len(other.sections) - 1 if ends_there else 0, to, ends_there)
                # Lane changes to the lane beside it in the same direction.
                for beside in (lane - 1, lane + 1):
                    if beside * lane > 0 and (road.id, index, lane) in driven and beside in lanes:
                        border = node if abs(lane) < abs(beside) else lanes[beside]
                        if (lanes[beside].get("type") in DRIVEN
                                and border.find("roadMark").get("laneChange") == "both"):
                            ways[road.id, index, lane].add((road.id, index, beside))

    backwards = defaultdict(set)
    for a, reached in ways.items():
        for b in reached:
            backwards[b].add(a)
    start = min(driven)
    cut_off = set()
    for graph in (ways, backwards):
        seen, todo = {start}, [start]
        while todo:
            new = graph[todo.pop()] - seen
            seen |= new
            todo.extend(new)
        cut_off |= driven - seen
    for lane in sorted(cut_off):
        print("cannot be reached, or left:", "/".join(map(str, lane)))
    print(f"{len(roads)} roads, {len(driven)} driven lanes, {links} links")
    print(f"largest gap between pieces   {place_gap:.1e} m, {heading_gap:.1e} rad")
    print(f"largest gap between borders  {border_gap:.1e} m")
    return place_gap < 1e-6 and heading_gap < 1e-9 and border_gap < 1e-3 and not cut_off


if __name__ == "__main__":
    sys.exit(0 if check(sys.argv[1]) else 1)
