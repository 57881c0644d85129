"""Lanelet2 maps: the lanelets that points lie in, and routes, beside the package `lanelet2`."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import lanelet2
import numpy as np
import pytest
import roadbed
from lanelet2.core import BasicPoint2d, BasicPoint3d
from lanelet2.projection import UtmProjector
from places import real

POINTS, PAIRS = 10_000, 400
ON_BORDER_M = 1e-6
FZI = "lanelet2/fzi*/mapping_example.osm"
AUTOWARE = "lanelet2/autoware*/2km_test.osm"
LEFT_HAND = "lanelet2/autoware*/vm_03_left_hand.osm"
NODE = re.compile(r"<node\b[^>]*?>(?:(?!</node>|<node).)*</node>", re.DOTALL)


@dataclass
class Both:
    """A file as both read it; `shift` is what theirs has more in x and y."""

    ours: roadbed.Map
    theirs: Any
    shift: np.ndarray


def value(pattern: str, text: str) -> str:
    found = re.search(pattern, text)
    return found.group(1) if found else ""


def read_by_both(file: Path, folder: Path) -> Both:
    """The package knows only lat/lon: where local_x/local_y stand, a copy has lat/lon of those."""
    text = file.read_text()
    if "local_x" not in text:
        first = text[text.index("<node") :]
        origin = lanelet2.io.Origin(
            float(value(r"lat=.([-\d.]+)", first)), float(value(r"lon=.([-\d.]+)", first))
        )
        theirs = lanelet2.io.load(str(file), UtmProjector(origin, False, False))
        return Both(roadbed.open(file), theirs, np.zeros(2))
    projector = UtmProjector(lanelet2.io.Origin(49.0, 9.0), False, False)
    shift = np.array([500000.0, 5400000.0])

    def moved(match: re.Match[str]) -> str:
        node = match.group(0)
        x, y = (value(rf"k=.local_{axis}. v=.([-+\d.eE]+)", node) for axis in "xy")
        place = projector.reverse(BasicPoint3d(float(x) + shift[0], float(y) + shift[1], 0.0))
        node = re.sub(r"\blat=(['\"])[^'\"]*['\"]", f'lat="{place.lat:.15f}"', node, count=1)
        return re.sub(r"\blon=(['\"])[^'\"]*['\"]", f'lon="{place.lon:.15f}"', node, count=1)

    copy = folder / file.name
    copy.write_text(NODE.sub(moved, text))
    # Rules that the package does not know (Autoware's own) are left out, and told; lanelets stay.
    theirs, _told = lanelet2.io.loadRobust(str(copy), projector)
    return Both(roadbed.open(file), theirs, shift)


@pytest.fixture(scope="module", params=[FZI, AUTOWARE, LEFT_HAND])
def both(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Both:
    return read_by_both(real(request.param)[0], tmp_path_factory.mktemp("lanelet2"))


def random_points(road_map: roadbed.Map) -> np.ndarray:
    """Half of them anywhere, half on lanes or beside them."""
    random = np.random.default_rng(20261125)
    assert road_map.bounds is not None
    low, high = np.reshape(road_map.bounds, (2, 2))
    anywhere = random.uniform(low, high, (POINTS // 2, 2))
    vertices = np.vstack([lane.centre[:, :2] for lane in road_map.lanes])
    near = vertices[random.integers(len(vertices), size=POINTS // 2)]
    return np.vstack([anywhere, near + random.normal(0.0, 2.0, near.shape)])


def border_distance(road_map: roadbed.Map, name: str, point: np.ndarray) -> float:
    ring = road_map.lanes[name].to_shapely().exterior
    return float(ring.distance(__import__("shapely").Point(point)))


def test_points_lie_in_the_same_lanelets(both: Both) -> None:
    points = random_points(both.ours)
    found = both.ours.locate(points, count=32, radius_m=0.0)
    names = both.ours.lanes.names
    inside = found.lane[:, -1] == -1
    assert inside.all(), "more than 32 lanelets lie above one another"
    in_some = 0
    for point, lanes in zip(points, found.lane, strict=True):
        ours = {names[lane] for lane in lanes[lanes >= 0]}
        at = BasicPoint2d(*(point + both.shift))
        theirs = {
            str(lanelet.id)
            for distance, lanelet in lanelet2.geometry.findWithin2d(
                both.theirs.laneletLayer, at, 0.0
            )
            if distance == 0.0
        }
        in_some += bool(ours)
        for name in ours ^ theirs:
            assert border_distance(both.ours, name, point) < ON_BORDER_M, (point, name)
    assert in_some > POINTS // 10


def test_the_nearest_lanelet_is_as_near(both: Both) -> None:
    points = random_points(both.ours)[:2000]
    found = both.ours.locate(points)
    for point, distance in zip(points, found.distance_m, strict=True):
        at = BasicPoint2d(*(point + both.shift))
        nearest = lanelet2.geometry.findNearest(both.theirs.laneletLayer, at, 1)
        assert nearest[0][0] == pytest.approx(distance, abs=1e-6)


def follows(graph: Any, before: Any, after: Any) -> bool:
    return after in list(graph.following(before))


def lawful(graph: Any, before: Any, after: Any) -> bool:
    """Whether the graph leads from one lanelet to another, behind it or across a marking."""
    beside = [graph.left(before), graph.right(before)]
    return follows(graph, before, after) or after in [one for one in beside if one]


def test_routes_agree_with_the_graph(both: Both) -> None:
    rules = lanelet2.traffic_rules.create(
        lanelet2.traffic_rules.Locations.Germany, lanelet2.traffic_rules.Participants.Vehicle
    )
    graph = lanelet2.routing.RoutingGraph(both.theirs, rules)
    lanelets = {str(lane.id): lane for lane in both.theirs.laneletLayer if rules.canPass(lane)}

    def ways_through(name: str) -> list[Any]:
        """As it runs, and against it where that is allowed."""
        lane = lanelets[name]
        return [lane] if rules.isOneWay(lane) else [lane, lane.invert()]

    names = [name for name in both.ours.lanes.names if name in lanelets]
    random = np.random.default_rng(7)
    pairs = [[str(name) for name in random.choice(names, 2, replace=False)] for _ in range(PAIRS)]

    def place(name: str, fraction: float) -> str:
        """In the middle of a lane of both directions, whichever way it is driven."""
        at = fraction if rules.isOneWay(lanelets[name]) else 0.5
        return f"lane:{name}@{at * both.ours.lanes[name].length_m}"

    starts = [place(start, 0.0) for start, _ in pairs]
    goals = [place(goal, 1.0) for _, goal in pairs]
    routes = both.ours.routes(
        starts,
        goals,
        cost="distance",
        lane_change_cost=0.0,
        u_turn_cost=0.0,
        least_lane_change_m=0.0,
    )
    found, compared = 0, 0
    for (start, goal), route in zip(pairs, routes, strict=True):
        theirs = [
            path
            for before in ways_through(start)
            for after in ways_through(goal)
            if (path := graph.shortestPath(before, after)) is not None
        ]
        assert bool(route) == bool(theirs), (start, goal, route.reason)
        if not route:
            continue
        found += 1
        legs = route.to_dict()["lanes"]
        way = [
            lanelets[leg["lane"]].invert() if leg["reversed"] else lanelets[leg["lane"]]
            for leg in legs
        ]
        assert (legs[0]["lane"], legs[-1]["lane"]) == (start, goal)
        for before, after in zip(way, way[1:], strict=False):
            assert lawful(graph, before, after), (before.id, after.id)
        straight = [
            list(path)
            for path in theirs
            if all(follows(graph, *pair) for pair in zip(path, list(path)[1:], strict=False))
        ]
        if route.lane_changes or len(straight) != len(theirs):
            continue
        compared += 1
        halves = [lane for lane in (start, goal) if not rules.isOneWay(lanelets[lane])]
        spared = 0.5 * sum(lanelet2.geometry.length2d(lanelets[lane]) for lane in halves)
        shortest = min(sum(map(lanelet2.geometry.length2d, path)) for path in straight) - spared
        assert route.length_m <= shortest + 1e-3, (start, goal)
    assert found > PAIRS // 20
    assert compared > 0
