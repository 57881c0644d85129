"""Times the `lanelet2` package from PyPI on a Lanelet2 map: shortest paths between random lanes.

    python3 -m venv env && env/bin/pip install lanelet2
    env/bin/python lanelet2_routes.py MAP.osm [PAIRS]

Prints medians in µs of the pairs that are connected, beside what `bench_routes MAP.osm` prints.
The times hold the call from Python, some hundred ns.
"""

import random
import statistics
import sys
import time
from xml.etree import ElementTree

import lanelet2
from lanelet2.projection import UtmProjector


def main() -> None:
    pairs = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    projector = UtmProjector(lanelet2.io.Origin(*origin_of(sys.argv[1])))
    lanes_map, _ = lanelet2.io.loadRobust(sys.argv[1], projector)
    rules = lanelet2.traffic_rules.create(
        lanelet2.traffic_rules.Locations.Germany, lanelet2.traffic_rules.Participants.Vehicle
    )
    start = time.perf_counter()
    graph = lanelet2.routing.RoutingGraph(lanes_map, rules)
    print(f"graph {1e3 * (time.perf_counter() - start):.1f} ms")
    lanes = [lane for lane in lanes_map.laneletLayer if rules.canPass(lane)]
    random.seed(20261121)
    times_us = []
    for _ in range(pairs):
        a, b = random.choice(lanes), random.choice(lanes)
        start = time.perf_counter_ns()
        path = graph.shortestPath(a, b, 0, True)
        spent_us = 1e-3 * (time.perf_counter_ns() - start)
        if path is not None:
            times_us.append(spent_us)
    print(f"{len(lanes)} lanes, {pairs} pairs, {len(times_us)} connected")
    print(f"shortestPath, median of the connected {statistics.median(times_us):.1f} us")


def origin_of(file: str) -> tuple[float, float]:
    """Latitude and longitude of the map's first node that has them."""
    for _, node in ElementTree.iterparse(file):
        if node.tag == "node" and "lat" in node.attrib:
            return float(node.attrib["lat"]), float(node.attrib["lon"])
    raise SystemExit(f"{file}: no node")


if __name__ == "__main__":
    main()
