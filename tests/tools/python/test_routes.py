"""Routes and reference lines from Python."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
import roadbed
import shapely
from places import DATA
from test_maps import TOWN, program

START, GOAL = (150.0, 198.0), "lane:7/0/1@35"


@pytest.fixture(scope="module")
def town() -> roadbed.Map:
    return roadbed.open(TOWN)


def test_a_route_is_the_programs(town: roadbed.Map) -> None:
    told = json.loads(program("route", TOWN, "--from", "150,198", "--to", GOAL, "--json").stdout)
    route = town.route(START, GOAL)
    document = route.to_dict()
    assert route
    assert document["roadbed_route"] == 1
    for key, value in document.items():
        assert value == told[key], key
    assert route.lanes == [leg["lane"] for leg in told["lanes"]]
    assert route.reason == ""


def test_places_may_be_texts_points_arrays_and_lanes(town: roadbed.Map) -> None:
    lane = town.lanes["1/3/1"]
    same = [
        town.route("150,198,0", GOAL),
        town.route((150, 198, 0.0), GOAL),
        town.route(np.array([150.0, 198.0, 4 * np.pi]), GOAL),
    ]
    assert len({route.cost_s for route in same}) == 1
    assert town.route(lane, GOAL).lanes[0] == lane.name
    assert (
        town.route(START, GOAL, via=[town.lanes["2/1/-1"]]).lanes == town.route(START, GOAL).lanes
    )


def test_no_route_is_a_value_with_a_reason(town: roadbed.Map) -> None:
    closed = town.route(START, GOAL, avoid=["road:23", "road:7"])
    assert not closed
    assert "7/0/1" in closed.reason
    assert np.isnan(closed.cost_s)
    assert closed.lanes == []
    assert closed.to_dict()["found"] is False
    assert closed._repr_svg_() is None
    with pytest.raises(ValueError, match="there is no route"):
        closed.path()


def test_options_are_the_programs(town: roadbed.Map) -> None:
    words = ["--cost", "distance", "--avoid", "road:4", "--lane-change-cost", "7"]
    told = program("route", TOWN, "--from", "270,203", "--to", GOAL, "--json", *words)
    route = town.route((270, 203), GOAL, cost="distance", avoid=["road:4"], lane_change_cost=7.0)
    assert route.to_dict()["cost_m"] == json.loads(told.stdout)["cost_m"]
    with pytest.raises(TypeError, match="no option"):
        town.route(START, GOAL, colour="red")  # type: ignore[call-arg]
    with pytest.raises(ValueError, match="needs time or distance"):
        town.route(START, GOAL, cost="beauty")  # type: ignore[arg-type]
    with pytest.raises(roadbed.InputError, match="no road 999"):
        town.route(START, GOAL, avoid=["road:999"])


def test_many_routes_cost_what_each_costs(town: roadbed.Map) -> None:
    lanes = [lane for lane in town.lanes if lane.drivable][:40]
    starts, goals = lanes[:20], lanes[20:]
    for together, start, goal in zip(town.routes(starts, goals), starts, goals, strict=True):
        alone = town.route(start, goal)
        assert bool(together) == bool(alone)
        if alone:
            assert together.cost_s == pytest.approx(alone.cost_s, abs=1e-3)
    with pytest.raises(ValueError, match="one for each"):
        town.routes(starts, goals[1:])


def test_many_places_may_be_an_array_with_headings(town: roadbed.Map) -> None:
    lanes = [lane for lane in town.lanes if lane.drivable and len(lane.centre) > 2][:20]
    ahead = [lane.centre[2, :2] - lane.centre[1, :2] for lane in lanes]
    headings = [np.arctan2(y, x) + 6 * np.pi for x, y in ahead]
    points = [lane.centre[1, :2] for lane in lanes]
    places = np.column_stack([points, headings])
    found = town.routes(places, np.flipud(places))
    alone = [town.route(start, goal) for start, goal in zip(places, places[::-1], strict=True)]
    assert [bool(route) for route in found] == [bool(route) for route in alone]
    for together, one in zip(found, alone, strict=True):
        assert not one or together.cost_s == pytest.approx(one.cost_s, abs=1e-3)
    with pytest.raises(roadbed.InputError, match="not a number"):
        town.routes([[150.0, np.nan]], [[150.0, 198.0]])


def test_alternatives_share_at_most_seventy_percent(town: roadbed.Map) -> None:
    found = town.alternatives((270, 203), GOAL, count=3)
    assert found[0].lanes == town.route((270, 203), GOAL).lanes
    for other in found[1:]:
        assert other.shared_length_fraction <= 0.7
        assert other.cost_s <= 1.5 * found[0].cost_s


def test_reach_grows_with_the_limit(town: roadbed.Map) -> None:
    near, far = town.reach(START, within_m=100), town.reach(START, within_m=200)
    assert set(near.names) < set(far.names)
    assert np.all(far.cost <= 200.0)
    area = shapely.union_all([shapely.Polygon(rings[0], rings[1:]) for rings in near.area()])
    assert area.area > 100.0
    with pytest.raises(ValueError, match="just one"):
        town.reach(START)


def test_a_reference_line_is_the_programs_file(town: roadbed.Map, tmp_path: Path) -> None:
    file = tmp_path / "line.csv"
    program("reference", TOWN, "--from", "150,198", "--to", GOAL, "-o", file)
    rows = list(csv.DictReader(file.open()))
    columns = town.route(START, GOAL).reference_line().sample()
    assert list(columns) == list(rows[0])
    for name, values in columns.items():
        assert values.tolist() == [float(row[name]) for row in rows], name


def test_places_beside_a_line_come_back(town: roadbed.Map) -> None:
    line = town.route(START, GOAL).reference_line()
    places = np.column_stack([np.linspace(0, line.goal_s_m, 40), np.linspace(-1, 1, 40)])
    assert line.project(line.to_xy(places)) == pytest.approx(places, abs=1e-6)
    sampled = line.at(places[:, 0])
    assert sampled["s_m"] == pytest.approx(places[:, 0])


def test_a_line_through_points_needs_no_map() -> None:
    angles = np.linspace(0, np.pi, 40)
    points = 4e6 + 50 * np.column_stack([np.cos(angles), np.sin(angles)])
    line = roadbed.ReferenceLine.through(points, half_width_m=2.0)
    assert line.goal_s_m == pytest.approx(50 * np.pi, rel=1e-3)
    curvature = line.sample()["curvature_per_m"]
    assert np.median(curvature) == pytest.approx(1 / 50, rel=1e-2)
    with pytest.raises(ValueError, match="two or more"):
        roadbed.ReferenceLine.through(points[:1])


def test_other_formats_route_as_well() -> None:
    for name in ("crossing.osm", "junction.xml"):
        road_map = roadbed.open(DATA / name)
        drivable = [lane for lane in road_map.lanes if lane.drivable and lane.successors]
        route = road_map.route(drivable[0], drivable[0].successors[0].join(["lane:", ""]))
        assert route.lanes[:1] == [drivable[0].name]
