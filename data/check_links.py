#!/usr/bin/env python3
"""Checks an OpenDRIVE file: do pieces, sections and linked lanes meet? Usage: check_links.py F.xodr

Reads the file anew and evaluates it with code that shares nothing with what made it. Prints the
largest gaps; exit status 1 if borders of linked driving lanes are 1 mm or more apart, pieces of a
reference line 1e-6 m or 1e-9 rad, or some driving lane cannot be reached from some other.
"""

import sys
from collections import defaultdict
from math import hypot, pi, remainder
from xml.etree import ElementTree

from road_borders import in_piece, number, read_roads

DRIVEN = {"driving", "entry", "exit", "onRamp", "offRamp"}


def end_of(road, index, lane, at_end):
    """Both borders of a lane at an end of its section."""
    return road.borders(index, lane, road.ranges[index][1 if at_end else 0])


def apart(a, b):
    return hypot(*(p - q for p, q in zip(a, b)))


def link_of(lane, tag):
    node = lane.find(f"link/{tag}")
    return None if node is None else int(node.get("id"))


def check(file):
    root = ElementTree.parse(file).getroot()
    roads = read_roads(root)
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
        here = end_of(roads[road], index, lane, at_end)
        there = end_of(roads[other], other_index, other_lane, other_end)
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
