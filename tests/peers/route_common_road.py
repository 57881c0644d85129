#!/usr/bin/env python3
"""Routes over the CommonRoad files that roadbed writes, as commonroad-io reads them.

usage: route_common_road.py ROADBED MAP...

Each map is exported; commonroad-io loads the file, networkx looks for routes over its successors
and neighbours of the same direction between some pairs of lanelets, and roadbed has to find a
route for just the same pairs. One line per map, exit status 1 where they do not agree."""
import json
import logging
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import networkx
from commonroad.common.common_lanelet import LineMarking
from commonroad.common.file_reader import CommonRoadFileReader

PAIRS = 12
CLOSED = {LineMarking.SOLID, LineMarking.BROAD_SOLID, LineMarking.SOLID_SOLID, LineMarking.CURB}
# Of a double line the one nearer to the driver counts: the right one of a left border.
CLOSED_LEFT = CLOSED | {LineMarking.DASHED_SOLID}
CLOSED_RIGHT = CLOSED | {LineMarking.SOLID_DASHED}


def graph_of(network):
    graph = networkx.DiGraph()
    for lanelet in network.lanelets:
        graph.add_node(lanelet.lanelet_id)
        for successor in lanelet.successor:
            graph.add_edge(lanelet.lanelet_id, successor)
        if lanelet.adj_left_same_direction and (
                lanelet.line_marking_left_vertices not in CLOSED_LEFT):
            graph.add_edge(lanelet.lanelet_id, lanelet.adj_left)
        if lanelet.adj_right_same_direction and (
                lanelet.line_marking_right_vertices not in CLOSED_RIGHT):
            graph.add_edge(lanelet.lanelet_id, lanelet.adj_right)
    return graph


def is_for_cars(lanelet):
    users = {user.value for user in lanelet.user_one_way | lanelet.user_bidirectional}
    return (not users or bool(users & {"vehicle", "car"})) and not {
        kind.value for kind in lanelet.lanelet_type
    } & {"shoulder", "parking", "busLane", "border", "restricted", "sidewalk", "bicycleLane"}


def finds(roadbed, file, start, goal, length):
    """Whether roadbed finds a route from the start of one lane to the end of another, with lane
    changes of any length, since the graph of lanelets knows no least one."""
    run = subprocess.run([roadbed, "route", file, "--from", f"lane:{start}@0", "--to",
                          f"lane:{goal}@{length}", "--least-lane-change", "0", "--json"],
                         capture_output=True, text=True, check=False)
    return json.loads(run.stdout)["found"]


def check(roadbed, source, folder):
    written = str(Path(folder) / "written.xml")
    subprocess.run([roadbed, "export", source, "-o", written, "--force", "--quiet"], check=True)
    scenario, _ = CommonRoadFileReader(written).open()
    network = scenario.lanelet_network
    graph = graph_of(network).subgraph(l.lanelet_id for l in network.lanelets if is_for_cars(l))
    chosen = random.Random(20261121)
    nodes = sorted(graph)
    found, wrong = 0, []
    for _ in range(PAIRS if len(nodes) > 1 else 0):
        start, goal = chosen.sample(nodes, 2)
        theirs = networkx.has_path(graph, start, goal)
        found += theirs
        length = network.find_lanelet_by_id(goal).distance[-1]
        if finds(roadbed, written, start, goal, 0.999 * length) != theirs:
            wrong.append((start, goal, theirs))
    print(f"{Path(source).name}: {len(network.lanelets)} lanelets, "
          f"{len(network.traffic_signs)} signs, {len(network.traffic_lights)} lights, "
          f"{len(network.intersections)} intersections; {found} of {PAIRS} pairs have a route, "
          f"{len(wrong)} otherwise in roadbed {wrong[:3] or ''}")
    return not wrong


def main():
    logging.disable(logging.CRITICAL)
    roadbed, sources = sys.argv[1], sys.argv[2:]
    with tempfile.TemporaryDirectory() as folder:
        results = [check(roadbed, source, folder) for source in sources]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
