#!/usr/bin/env python3
"""Asks the `lanelet2` package from PyPI which lanes lead to which, driven both ways.

Usage: route_two_way.py ROADBED MAP.osm...

For vehicles, bicycles and pedestrians: between every pair of lanes that they may use, `roadbed route
--batch --matrix` and the package's routing graph, asked from both directions of the first lane to
both of the second, without lane changes, have to agree whether there is a way. Prints a row per map
and kind; exit status 1 if they differ.
"""
import csv
import os
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

import lanelet2
from lanelet2.projection import UtmProjector
from lanelet2.traffic_rules import Locations, Participants

KINDS = {"car": Participants.Vehicle, "bicycle": Participants.Bicycle,
         "pedestrian": Participants.Pedestrian}
MOST_PAIRS = 40000


def origin_of(path):
    for _, node in ElementTree.iterparse(path):
        if node.tag == "node" and "lat" in node.attrib:
            return float(node.attrib["lat"]), float(node.attrib["lon"])
    raise SystemExit(f"{path}: no node")


def ours(roadbed, path, kind, lanes):
    with tempfile.TemporaryDirectory() as scratch:
        pairs, rows = os.path.join(scratch, "pairs.csv"), os.path.join(scratch, "rows.csv")
        with open(pairs, "w", encoding="utf-8") as file:
            file.write("from,to\n" + "".join(f"lane:{lane.id},lane:{lane.id}\n" for lane in lanes))
        subprocess.run([roadbed, "route", path, "--batch", pairs, "--matrix", "--participant", kind,
                        "--least-lane-change", "1000000", "-o", rows],
                       check=False, capture_output=True)
        with open(rows, encoding="utf-8") as file:
            return {(row["from"], row["to"]): row["found"] == "1" for row in csv.DictReader(file)}


def check(roadbed, path, kind):
    lanelet_map, _ = lanelet2.io.loadRobust(path, UtmProjector(lanelet2.io.Origin(*origin_of(path))))
    rules = lanelet2.traffic_rules.create(Locations.Germany, KINDS[kind])
    graph = lanelet2.routing.RoutingGraph(lanelet_map, rules)
    lanes = [lane for lane in lanelet_map.laneletLayer if rules.canPass(lane)]
    found = ours(roadbed, path, kind, lanes)
    step = max(1, len(lanes) ** 2 // MOST_PAIRS)
    asked = connected = 0
    differ = []
    for at, (start, goal) in enumerate((a, b) for a in lanes for b in lanes if a.id != b.id):
        key = f"lane:{start.id}", f"lane:{goal.id}"
        if at % step != 0 or key not in found:
            continue
        theirs = any(graph.shortestPath(a, b, 0, False) is not None
                     for a in (start, start.invert()) for b in (goal, goal.invert()))
        asked += 1
        connected += theirs
        if theirs != found[key]:
            differ.append(f"{key[0]} to {key[1]}: {'a way' if theirs else 'none'} in the package")
    both = sum(not rules.isOneWay(lane) for lane in lanes)
    print(f"{os.path.basename(path)}, {kind}: {len(lanes)} lanes, {both} of both directions; "
          f"{asked} pairs, {connected} connected, {len(differ)} differ")
    for text in differ[:10]:
        print("  " + text)
    return bool(differ)


if __name__ == "__main__":
    sys.exit(max(check(sys.argv[1], path, kind) for path in sys.argv[2:] for kind in KINDS))
