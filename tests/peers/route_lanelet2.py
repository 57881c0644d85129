#!/usr/bin/env python3
"""Exports maps to Lanelet2 and lets the `lanelet2` package from PyPI load and route them.

Usage: route_lanelet2.py BIN MAP...   (BIN: folder with roadbed and dump_links)

The package must load the file without complaint; every pair of lanes that a car may use, one behind
the other in the map, must be so in the package's routing graph, and no other; every lane change
that the map allows must be allowed there. Then routes between lanes as far apart as the links lead
are asked for. Prints a row per map; exit status 1 if something differs.
"""
import json
import os
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

import lanelet2
from lanelet2.projection import UtmProjector


def links_of(folder, path):
    run = subprocess.run([os.path.join(folder, "dump_links"), path], check=True,
                         capture_output=True, text=True)
    return {lane["lane"]: lane for lane in map(json.loads, run.stdout.splitlines())}


def farthest(links, start):
    """Lane farthest along the links that a breadth-first search reaches."""
    seen, ring = {start}, [start]
    while True:
        following = [other for lane in ring for other in links[lane]["successors"]
                     if links[other]["car"] and other not in seen]
        following = list(dict.fromkeys(following))
        if not following:
            return ring[0]
        seen.update(following)
        ring = following


def check(folder, path):
    with tempfile.TemporaryDirectory() as scratch:
        output = os.path.join(scratch, "map.osm")
        run = subprocess.run([os.path.join(folder, "roadbed"), "export", path, "-o", output],
                             check=True, capture_output=True, text=True)
        notes = run.stderr.strip().replace(output, "map.osm")
        first = ElementTree.parse(output).find("node")
        lat, lon = (float(first.get(key)) for key in ("lat", "lon"))
        projector = UtmProjector(lanelet2.io.Origin(lat, lon), False, False)
        lanelet_map = lanelet2.io.load(output, projector)  # raises if it has complaints
    rules = lanelet2.traffic_rules.create(lanelet2.traffic_rules.Locations.Germany,
                                          lanelet2.traffic_rules.Participants.Vehicle)
    graph = lanelet2.routing.RoutingGraph(lanelet_map, rules)
    links = links_of(folder, path)
    lanelets = {lane.attributes["name"] if "name" in lane.attributes else str(lane.id): lane
                for lane in lanelet_map.laneletLayer}
    names = {lane.id: name for name, lane in lanelets.items()}
    missing, surplus, changes, routes, asked = [], [], [], 0, 0
    cars = [name for name, lane in links.items() if lane["car"]]
    for name in cars:
        lane = lanelets[name]
        ours = {other for other in links[name]["successors"] if links[other]["car"]}
        theirs = {names[other.id] for other in graph.following(lane) if not other.inverted()}
        missing += [f"{name} -> {other}" for other in sorted(ours - theirs)]
        surplus += [f"{name} -> {other}" for other in sorted(theirs - ours)]
        for side in ("left", "right"):
            beside = links[name][side]
            if not beside or not beside["same"] or not links[beside["lane"]]["car"]:
                continue
            change = getattr(graph, side)(lane)
            if (change is not None) != beside["change"]:
                changes.append(f"{name} to the {side}")
    for name in cars[::max(1, len(cars) // 20)]:
        goal = farthest(links, name)
        asked += 1
        routes += graph.shortestPath(lanelets[name], lanelets[goal]) is not None
    print(f"{os.path.basename(path)}: {len(lanelets)} lanelets, {len(missing)} links missing, "
          f"{len(surplus)} too many, {len(changes)} lane changes differ, {routes} of {asked} "
          f"routes; {notes}")
    for text in (missing + surplus + changes)[:12]:
        print("  " + text)
    return bool(missing or surplus or changes or routes < asked)


if __name__ == "__main__":
    sys.exit(max(check(sys.argv[1], path) for path in sys.argv[2:]))
