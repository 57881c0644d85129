#!/usr/bin/env python3
"""Compares roadbed's reading of Lanelet2 files with that of the `lanelet2` package from PyPI.

Usage: compare_lanelet2.py BIN FILE.osm...   (BIN: folder with roadbed and dump_links)

Of every lanelet: both borders, the centreline and its length; of every lanelet that a car may use:
successors, neighbours of the same direction and where the lane may be changed, against the routing
graph for vehicles. Prints a row per file; exit status 1 if something differs.
"""
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile

import lanelet2
from lanelet2.core import BasicPoint3d
from lanelet2.projection import UtmProjector

TOLERANCE_M = 1e-6
# Where a step of the centreline begins or ends on the line between the ends of the borders, rounding
# decides in lanelet2 whether it may be taken; so few centrelines may have other vertices.
OTHER_CENTRELINES = 0.1


def read_nodes(path):
    """lat, lon, local_x, local_y of the nodes, as texts."""
    text = open(path, encoding="utf-8").read()
    return re.findall(r"<node\b[^>]*?/?>(?:(?:(?!</node>|<node).)*</node>)?", text, re.S)


def value(pattern, text):
    found = re.search(pattern, text)
    return found.group(1) if found else ""


def prepared(path):
    """A copy of the file whose lat/lon say where local_x/local_y are, if it has those: lanelet2
    knows lat/lon only. Returns the copy and how to come back from UTM."""
    nodes = read_nodes(path)
    if not any("local_x" in node for node in nodes):
        first = nodes[0]
        origin = float(value(r"lat=.([-\d.]+)", first)), float(value(r"lon=.([-\d.]+)", first))
        return path, UtmProjector(lanelet2.io.Origin(*origin), False, False), (0.0, 0.0)
    # A place in the middle of zone 32 whose UTM coordinates are round.
    projector = UtmProjector(lanelet2.io.Origin(49.0, 9.0), False, False)
    shift = (500000.0, 5400000.0)

    def moved(match):
        node = match.group(0)
        x = value(r"k=.local_x. v=.([-+\d.eE]+)", node)
        y = value(r"k=.local_y. v=.([-+\d.eE]+)", node)
        if not x or not y:
            return node
        place = projector.reverse(BasicPoint3d(float(x) + shift[0], float(y) + shift[1], 0.0))
        node = re.sub(r"\blat=(['\"])[^'\"]*['\"]", f'lat="{place.lat:.15f}"', node, count=1)
        return re.sub(r"\blon=(['\"])[^'\"]*['\"]", f'lon="{place.lon:.15f}"', node, count=1)

    text = open(path, encoding="utf-8").read()
    copy = tempfile.NamedTemporaryFile("w", suffix=".osm", delete=False, encoding="utf-8")
    copy.write(re.sub(r"<node\b[^>]*?>(?:(?!</node>|<node).)*</node>", moved, text, flags=re.S))
    copy.close()
    return copy.name, projector, shift


def roadbed_lines(folder, path):
    with tempfile.TemporaryDirectory() as scratch:
        output = os.path.join(scratch, "lanes.csv")
        subprocess.run([os.path.join(folder, "roadbed"), "export", path, "-o", output, "--quiet"],
                       check=True)
        lines = {}
        for row in csv.DictReader(open(output, newline="")):
            if not row["lane"].lstrip("-").isdigit():
                continue  # an area's centreline
            point = float(row["x_m"]), float(row["y_m"]), float(row["z_m"])
            lines.setdefault((int(row["lane"]), row["line"]), []).append(point)
        return lines


def roadbed_links(folder, path):
    run = subprocess.run([os.path.join(folder, "dump_links"), path], check=True,
                         capture_output=True, text=True)
    return {int(lane["lane"]): lane for lane in map(json.loads, run.stdout.splitlines())}


def distance(a, b):
    """Largest distance between lines vertex by vertex; infinite if they have not equally many."""
    if len(a) != len(b):
        return math.inf
    return max(math.dist(p, q) for p, q in zip(a, b))


def compare_lines(lanes, lines, shift):
    differences, other = [], 0
    worst = {"left": 0.0, "right": 0.0, "centre": 0.0}
    for lane in lanes:
        for name, theirs in (("left", lane.leftBound), ("right", lane.rightBound),
                             ("centre", lane.centerline)):
            expected = [(p.x - shift[0], p.y - shift[1], p.z) for p in theirs]
            ours = lines.get((lane.id, name))
            if ours is None:
                differences.append(f"lanelet {lane.id} is missing")
                break
            off = distance(expected, ours)
            if off > TOLERANCE_M and name == "centre":
                other += 1
            elif off > TOLERANCE_M:
                differences.append(f"lanelet {lane.id}: {name} differs by {off} m "
                                   f"({len(expected)} and {len(ours)} points)")
            else:
                worst[name] = max(worst[name], off)
    if other > max(1, OTHER_CENTRELINES * len(lanes)):
        differences.append(f"{other} centrelines have other vertices")
    return differences, worst, other


def compare_graph(lanelet_map, links):
    rules = lanelet2.traffic_rules.create(lanelet2.traffic_rules.Locations.Germany,
                                          lanelet2.traffic_rules.Participants.Vehicle)
    graph = lanelet2.routing.RoutingGraph(lanelet_map, rules)
    differences, count = [], 0

    def check(lane, what, theirs, ours):
        nonlocal count
        count += 1
        if theirs != ours:
            differences.append(f"lanelet {lane.id}: {what} {theirs} in lanelet2, {ours} here")

    for lane in lanelet_map.laneletLayer:
        ours = links.get(lane.id)
        if ours is None:
            continue
        check(lane, "passable", rules.canPass(lane), ours["car"])
        if not rules.canPass(lane):
            continue
        check(lane, "one-way", rules.isOneWay(lane), ours["one_way"])
        forward = {int(other) for other in ours["successors"] if links[int(other)]["car"]}
        following = {other.id for other in graph.following(lane) if not other.inverted()}
        check(lane, "successors", following, forward)
        for side in ("left", "right"):
            change = getattr(graph, side)(lane)
            beside = getattr(graph, "adjacent" + side.capitalize())(lane)
            theirs = change or beside
            if theirs is not None and theirs.inverted():
                continue
            mine = ours[side]
            if mine and not (mine["same"] and links[int(mine["lane"])]["car"]):
                mine = None
            check(lane, side, theirs.id if theirs else None, int(mine["lane"]) if mine else None)
            if theirs and mine:
                check(lane, f"change to the {side}", change is not None, mine["change"])
    return differences, count


def main():
    folder, files = sys.argv[1], sys.argv[2:]
    status = 0
    for path in files:
        copy, projector, shift = prepared(path)
        try:
            lanelet_map, errors = lanelet2.io.loadRobust(copy, projector)
            whole = [lane for lane in lanelet_map.laneletLayer
                     if len(lane.leftBound) > 1 and len(lane.rightBound) > 1]
            differences, worst, other = compare_lines(whole, roadbed_lines(folder, path), shift)
            more, links = compare_graph(lanelet_map, roadbed_links(folder, path))
            differences += more
        finally:
            if copy != path:
                os.unlink(copy)
        print(f"{os.path.basename(path)}: {len(whole)} lanelets, {links} answers of the graph, "
              f"worst border {max(worst['left'], worst['right']):.1e} m, worst centreline "
              f"{worst['centre']:.1e} m ({other} with other vertices), {len(errors)} complaints of lanelet2, "
              f"{len(differences)} differences")
        for text in differences[:20]:
            print("  " + text)
        status |= bool(differences)
    return status


if __name__ == "__main__":
    sys.exit(main())
