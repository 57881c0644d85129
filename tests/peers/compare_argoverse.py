#!/usr/bin/env python3
"""Compares roadbed's reading of Argoverse 2 maps with that of the `av2` package from PyPI.

Usage: compare_argoverse.py BIN FILE.json...   (BIN: folder with roadbed and dump_links)

Of every lane segment: both borders point by point, the centreline, the lane type, whether it lies in
an intersection, successors, neighbours and where the lane may be changed by the marks; the number of
crossings and drivable areas. Then routes between random lanes for vehicles: roadbed has to find one
for just the pairs that networkx does over the package's graph, over its edges, and none that is
longer than the shortest there. Prints a row per file; exit status 1 if something differs.
"""
import csv
import json
import logging
import math
import os
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import networkx
import numpy as np
from av2.map.lane_segment import LaneType
from av2.map.map_api import ArgoverseStaticMap

PAIRS = 100
BORDER_M = 1e-9
CENTRELINE_M = 0.02  # the package measures fractions of borders in space, roadbed in plan
SLACK_M = 1e-3
# The first line of a double mark is that on the lane's own side, which the package draws so.
CROSSED = {"NONE", "DASHED_WHITE", "DASHED_YELLOW", "DOUBLE_DASH_WHITE", "DOUBLE_DASH_YELLOW",
           "DASH_SOLID_WHITE", "DASH_SOLID_YELLOW"}
TYPES = {LaneType.VEHICLE: "driving", LaneType.BIKE: "biking", LaneType.BUS: "bus"}


def output_of(*command):
    return subprocess.run(command, check=False, capture_output=True, text=True).stdout


def lane_lines(folder, path):
    with tempfile.TemporaryDirectory() as scratch:
        output = os.path.join(scratch, "lanes.csv")
        subprocess.run([os.path.join(folder, "roadbed"), "export", path, "-o", output, "--quiet"],
                       check=True)
        lines, types = {}, {}
        for row in csv.DictReader(open(output, newline="")):
            if not row["lane"].isdigit():
                continue  # the middle of a drivable area
            point = float(row["x_m"]), float(row["y_m"]), float(row["z_m"])
            lines.setdefault((int(row["lane"]), row["line"]), []).append(point)
            types[int(row["lane"])] = row["type"]
        return lines, types


def distance_to_line(point, line):
    line = np.asarray(line)[:, :2]
    start, along = line[:-1], line[1:] - line[:-1]
    squared = np.maximum((along ** 2).sum(axis=1), 1e-300)
    part = np.clip(((point[:2] - start) * along).sum(axis=1) / squared, 0.0, 1.0)
    return np.min(np.linalg.norm(start + part[:, None] * along - point[:2], axis=1))


def runs_along(lane, other):
    """Whether both are driven in the same direction."""
    chord = [l.left_lane_boundary.xyz[-1] - l.left_lane_boundary.xyz[0] for l in (lane, other)]
    return float(np.dot(chord[0][:2], chord[1][:2])) >= 0.0


def neighbour_of(lanes, lane, side):
    other = lanes.get(getattr(lane, f"{side}_neighbor_id"))
    if other is None:
        return None
    same, mark = runs_along(lane, other), getattr(lane, f"{side}_mark_type").value
    return {"lane": str(other.id), "same": same, "change": mark in CROSSED}


def compare_lanes(static_map, lines, types, links):
    lanes, differences = static_map.vector_lane_segments, []
    worst_border = worst_centre = 0.0

    def check(lane, what, theirs, ours):
        if theirs != ours:
            differences.append(f"lane segment {lane.id}: {what} {theirs} in av2, {ours} here")

    if set(lanes) != {int(name) for name in links}:
        differences.append(f"other lanes: {set(lanes) ^ {int(name) for name in links}}")
    for lane in lanes.values():
        if str(lane.id) not in links:
            continue
        ours = links[str(lane.id)]
        inside = sorted(str(other) for other in static_map.get_lane_segment_successor_ids(lane.id)
                        if other in lanes)
        check(lane, "successors", inside, sorted(ours["successors"]))
        for side in ("left", "right"):
            check(lane, f"{side} neighbour", neighbour_of(lanes, lane, side), ours[side])
            border = getattr(lane, f"{side}_lane_boundary").xyz
            mine = lines[lane.id, side]
            off = (max(math.dist(p, q) for p, q in zip(border, mine))
                   if len(border) == len(mine) else math.inf)
            worst_border = max(worst_border, off)
        check(lane, "type", TYPES[lane.lane_type], types[lane.id])
        for point in static_map.get_lane_segment_centerline(lane.id):
            worst_centre = max(worst_centre, distance_to_line(point, lines[lane.id, "centre"]))
    if worst_border > BORDER_M or worst_centre > CENTRELINE_M:
        differences.append("lines differ")
    return differences, worst_border, worst_centre


def compare_things(static_map, layers):
    """Intersections, crossings and drivable areas, as the layers of an export have them."""
    def features(name):
        return [f["properties"] for f in layers if f["properties"]["kind"] == name]

    differences = []
    inside = {int(f["lane"]) for f in features("lane") if f.get("junction")}
    theirs = {lane.id for lane in static_map.vector_lane_segments.values()
              if static_map.lane_is_in_intersection(lane.id)}
    if inside != theirs:
        differences.append(f"in intersections: {inside ^ theirs}")
    for name, count in (("object", len(static_map.get_scenario_ped_crossings())),
                        ("area", len(static_map.get_scenario_vector_drivable_areas()))):
        if len(features(name)) != count:
            differences.append(f"{count} {name} in av2, {len(features(name))} here")
    return differences


def graph_of(static_map):
    """Lanes for vehicles; an edge has the length of the lane that is left, a change none."""
    lanes, graph = static_map.vector_lane_segments, networkx.DiGraph()
    cars = {lane.id: lane for lane in lanes.values() if lane.lane_type == LaneType.VEHICLE}
    for lane in cars.values():
        line = static_map.get_lane_segment_centerline(lane.id)[:, :2]
        length = float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
        graph.add_node(lane.id, length=length)
        for other in lane.successors:
            if other in cars:
                graph.add_edge(lane.id, other, weight=length)
        for side in ("left", "right"):
            beside = neighbour_of(lanes, lane, side)
            if beside and beside["same"] and beside["change"] and int(beside["lane"]) in cars:
                graph.add_edge(lane.id, int(beside["lane"]), weight=0.0)
    return graph


def check_route(folder, path, graph, start, goal):
    """Whether a route was there, and what is wrong with roadbed's answer."""
    answer = json.loads(output_of(
        os.path.join(folder, "roadbed"), "route", path, "--from", f"lane:{start}@0", "--to",
        f"lane:{goal}@{0.999 * graph.nodes[goal]['length']}", "--least-lane-change", "0",
        "--cost", "distance", "--lane-change-cost", "0", "--u-turn-cost", "0", "--json"))
    there = networkx.has_path(graph, start, goal)
    if answer["found"] != there:
        return there, f"{start} to {goal}: found {there} in av2, {answer['found']} here"
    if not there:
        return there, None
    steps = [int(leg["lane"]) for leg in answer["lanes"]]
    # A change may be laid over the end of a lane: it is two edges there.
    edges = list(zip(steps, steps[1:]))
    surplus = [edge for edge in edges if not (
        networkx.has_path(graph, *edge) and networkx.shortest_path_length(graph, *edge) <= 2)]
    if surplus:
        return there, f"{start} to {goal}: {surplus} are no edges of av2"
    lengths = [networkx.shortest_path_length(graph, *edge, weight="weight") for edge in edges]
    least = networkx.shortest_path_length(graph, start, goal, weight="weight")
    # Lanes beside each other are of different lengths; roadbed leaves one on the way.
    slack = SLACK_M + sum(abs(graph.nodes[a]["length"] - graph.nodes[b]["length"])
                          for (a, b), length in zip(edges, lengths) if length == 0.0)
    if sum(lengths) > least + slack:
        return there, f"{start} to {goal}: {sum(lengths):.2f} m, {least:.2f} m in av2"
    return there, None


def check(folder, path):
    static_map = ArgoverseStaticMap.from_json(Path(path))
    lines, types = lane_lines(folder, path)
    links = {lane["lane"]: lane for lane in
             map(json.loads, output_of(os.path.join(folder, "dump_links"), path).splitlines())}
    differences, border, centre = compare_lanes(static_map, lines, types, links)
    layers = json.loads(output_of(os.path.join(folder, "roadbed"), "export", path, "-o", "-",
                                  "--format", "geojson", "--quiet"))["features"]
    differences += compare_things(static_map, layers)
    info = json.loads(output_of(os.path.join(folder, "roadbed"), "info", path, "--json"))
    if info["lanes"] != len(static_map.vector_lane_segments):
        differences.append(f"info counts {info['lanes']} lanes")
    graph, chosen = graph_of(static_map), random.Random(20261125)
    nodes, routes = sorted(graph), 0
    for _ in range(PAIRS):
        there, fault = check_route(folder, path, graph, *chosen.sample(nodes, 2))
        routes += there
        differences += [fault] if fault else []
    print(f"{os.path.basename(path)}: {len(links)} lanes, worst border {border:.1e} m, worst "
          f"centreline {centre:.1e} m, {routes} of {PAIRS} pairs have a route, "
          f"{len(differences)} differences")
    for text in differences[:12]:
        print("  " + text)
    return bool(differences)


if __name__ == "__main__":
    logging.disable(logging.CRITICAL)
    sys.exit(max([check(sys.argv[1], path) for path in sys.argv[2:]], default=0))
