#!/usr/bin/env python3
"""Loads maps that are written for Autoware by lanelet2, in the frame of their MGRS square.

Usage: check_autoware_maps.py ROADBED MAP...

lanelet2 loads every lanelet; its own UTM projection puts every point where local_x and local_y say,
within 0.1 mm; it misses nothing but the regulatory elements that Autoware adds to its own. Prints a
row per map; exit status 1 if one is otherwise.
"""
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

import lanelet2
from lanelet2.projection import UtmProjector

AUTOWARES_OWN = ("crosswalk", "road_marking", "virtual_traffic_light", "no_stopping_area",
                 "detection_area", "speed_bump", "bus_stop_area", "no_parking_area")


def places(text):
    """Of each node by id: latitude, longitude, local_x, local_y."""
    nodes = {}
    for node in xml.parse(text).getroot().iter("node"):
        tags = {tag.get("k"): tag.get("v") for tag in node}
        nodes[int(node.get("id"))] = (float(node.get("lat")), float(node.get("lon")),
                                      float(tags["local_x"]), float(tags["local_y"]))
    return nodes


def kinds_of_relations(text):
    """Type and subtype of each relation by id."""
    kinds = {}
    for relation in xml.parse(text).getroot().iter("relation"):
        tags = {tag.get("k"): tag.get("v") for tag in relation.iter("tag")}
        kinds[int(relation.get("id"))] = (tags.get("type"), tags.get("subtype"))
    return kinds


def is_about_autowares_own(error, kinds):
    """Whether it is an element that lanelet2 does not know, or the one that names it."""
    ids = [int(word.strip(":")) for word in error.replace(":", ": ").split()
           if word.strip(":").isdigit()]
    return any(kinds.get(one, ("", ""))[1] in AUTOWARES_OWN for one in ids)


def farthest_m(points, nodes, first):
    """How far a point is from where its local coordinates say, the first one being right."""
    worst, start = 0.0, None
    for point in points:
        if point.id == first:
            start = (point.x - nodes[first][2], point.y - nodes[first][3])
    for point in points:
        if point.id in nodes:
            x, y = nodes[point.id][2:]
            worst = max(worst, abs(point.x - x - start[0]), abs(point.y - y - start[1]))
    return worst


def check(roadbed, path, scratch):
    out = pathlib.Path(scratch) / "lanelet2_map.osm"
    subprocess.run([roadbed, "export", path, "-o", out, "--profile", "autoware", "--force"],
                   check=True, capture_output=True)
    projector = (out.parent / "map_projector_info.yaml").read_text()
    nodes = places(out)
    kinds = kinds_of_relations(out)
    wanted = sum(1 for kind in kinds.values() if kind[0] == "lanelet")
    name = pathlib.Path(path).name
    if "MGRS" not in projector:
        origin = lanelet2.io.Origin(0.0, 0.0)
        loaded, errors = lanelet2.io.loadRobust(str(out), UtmProjector(origin))
        far_m = 0.0
    else:
        zone = int(projector.split("mgrs_grid: ")[1][:2])
        first = next(node for node, (_, lon_deg, _, _) in nodes.items()
                     if int((lon_deg + 180.0) // 6.0) + 1 == zone)
        origin = lanelet2.io.Origin(*nodes[first][:2])
        loaded, errors = lanelet2.io.loadRobust(str(out), UtmProjector(origin))
        far_m = farthest_m(list(loaded.pointLayer), nodes, first)
    unknown = [error for error in errors
               if "primitive" in error and not is_about_autowares_own(error, kinds)]
    fine = len(loaded.laneletLayer) == wanted and far_m < 1e-4 and not unknown
    print(f"{'ok ' if fine else 'BAD'} {name}: {len(loaded.laneletLayer)} of {wanted} lanelets, "
          f"points within {far_m:.1e} m, {projector.split()[1]}")
    for error in unknown[:3]:
        print("    " + error.strip())
    return fine


def main():
    roadbed, *maps = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        fine = [check(roadbed, path, scratch) for path in maps]
    return 0 if all(fine) else 1


if __name__ == "__main__":
    sys.exit(main())
