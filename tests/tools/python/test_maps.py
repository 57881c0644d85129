"""Maps from Python: what they say is what the program says, and geometry holds its laws."""

import json
import subprocess
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import roadbed
import shapely
from places import DATA

PROGRAM = Path(roadbed.__file__).parent / "bin" / "roadbed"
TOWN = DATA / "town.xodr"


def program(*words: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def town() -> roadbed.Map:
    return roadbed.open(TOWN)


def points_in(town: roadbed.Map, count: int) -> np.ndarray:
    assert town.bounds is not None
    low, high = np.reshape(town.bounds, (2, 2))
    return np.random.default_rng(20261125).uniform(low, high, (count, 2))


@pytest.mark.parametrize("name", ["town.xodr", "crossing.osm", "junction.xml", "surface.geojson"])
def test_every_format_opens_and_says_what_info_says(name: str) -> None:
    road_map = roadbed.open(str(DATA / name))
    info = json.loads(program("info", DATA / name, "--json").stdout)
    assert road_map.format == info["format"]
    assert len(road_map.lanes) == info["lanes"]


def test_locate_is_what_the_program_locates(town: roadbed.Map, tmp_path: Path) -> None:
    points = points_in(town, 500)
    np.savetxt(tmp_path / "p.csv", points, "%.17g", ",", header="x_m,y_m", comments="")
    told = json.loads(
        program("locate", TOWN, "--points", tmp_path / "p.csv", "--count", "2", "--json").stdout
    )["points"]
    found = town.locate(points, count=2)
    assert found.s_m.shape == (500, 2)
    for i, point in enumerate(told):
        for rank, lane in enumerate(point["lanes"]):
            assert found.names[2 * i + rank] == lane["lane"]
            assert found.s_m[i, rank] == lane["s_m"]
            assert found.d_m[i, rank] == lane["d_m"]
            assert found.distance_m[i, rank] == lane["distance_m"]
            assert found.heading_rad[i, rank] == lane["heading_rad"]


def test_locate_takes_any_array_and_any_number_of_threads(town: roadbed.Map) -> None:
    points = points_in(town, 300_000)
    once = town.locate(points)
    threaded = town.locate(points, threads=3)
    assert np.array_equal(once.lane, threaded.lane)
    assert np.array_equal(once.s_m, threaded.s_m)
    few = points[:50]
    for same in (few.tolist(), np.asfortranarray(few), few[::-1][::-1], few.astype(object)):
        assert np.array_equal(town.locate(same).d_m, once.d_m[:50])
    assert town.locate(few[0]).lane.tolist() == [once.lane[0]]
    assert len(town.locate(np.empty((0, 2)))) == 0


def test_a_point_without_a_lane_says_so(town: roadbed.Map) -> None:
    found = town.locate([(1e6, 1e6), (np.nan, 0.0)], radius_m=10.0)
    assert found.lane.tolist() == [-1, -1]
    assert found.names == [None, None]
    assert np.isnan(found.s_m).all()


def test_places_of_lanes_and_points_are_each_others_inverse(town: roadbed.Map) -> None:
    lane = town.lanes["7/0/1"]
    places = np.column_stack([np.linspace(1.0, lane.length_m - 1.0, 50), np.linspace(-1, 1, 50)])
    found = town.locate(lane.to_xy(places), count=3)
    rank = (found.lane == lane.index).argmax(axis=1)
    rows = np.arange(50)
    assert found.s_m[rows, rank] == pytest.approx(places[:, 0], abs=1e-6)
    assert found.d_m[rows, rank] == pytest.approx(places[:, 1], abs=1e-6)


def test_lanes_in_a_box_are_those_that_shapely_finds(town: roadbed.Map) -> None:
    box = (200.3, 150.3, 321.3, 260.3)
    square = shapely.box(*box)
    expected = [lane.index for lane in town.lanes if lane.to_shapely().intersects(square)]
    assert town.lanes_in(*box).tolist() == expected


def test_borders_enclose_the_polygon(town: roadbed.Map) -> None:
    for lane in town.lanes:
        ring = shapely.Polygon(np.vstack([lane.left[:, :2], lane.right[::-1, :2]]))
        assert lane.to_shapely().symmetric_difference(ring.buffer(0)).area < 1e-6 * ring.area + 1e-6


def test_stations_are_the_maps_own_memory(town: roadbed.Map) -> None:
    lane = town.lanes[3]
    stations = lane.centre_s_m
    assert not stations.flags.owndata
    assert not stations.flags.writeable
    assert stations.__array_interface__["data"] == lane.centre_s_m.__array_interface__["data"]
    kept = lane.centre_s_m.copy()
    del lane
    assert np.array_equal(stations, kept)


def test_edge_distance_is_that_of_shapelys_union(town: roadbed.Map) -> None:
    weld_m = 2e-3  # roads do not meet exactly
    grown = [
        lane.to_shapely().buffer(weld_m, join_style="mitre") for lane in town.lanes if lane.drivable
    ]
    surface = shapely.union_all(grown).buffer(-weld_m, join_style="mitre")
    points = points_in(town, 300)
    distances = town.edge_distance(points)
    off = [
        (1.0 if surface.covers(point) else -1.0) * surface.boundary.distance(point) - distance
        for point, distance in zip(shapely.points(points), distances, strict=True)
    ]
    # A sliver between two roads that is hardly wider than what is welded is in one of the two.
    assert np.mean(np.abs(off) < 5e-3) > 0.99
    assert (
        np.sign(distances) == [1.0 if surface.covers(p) else -1.0 for p in shapely.points(points)]
    ).all()


def test_frames_hold_the_layers(town: roadbed.Map) -> None:
    frame = town.to_geodataframe("lanes")
    assert len(frame) == len(town.lanes)
    assert frame.crs is not None
    by_name = dict(
        zip(frame["name"] if "name" in frame else frame["lane"], frame.geometry, strict=True)
    )
    lane = town.lanes["7/0/1"]
    assert by_name["7/0/1"].area == pytest.approx(lane.to_shapely().area, rel=1e-9)
    for layer in roadbed.layers():
        town.to_geodataframe(layer)


def skip_without_proj(town: roadbed.Map, folder: Path) -> None:
    """PROJ is a module opened at run time, which a slim build or installation does not have."""
    try:
        town.save(folder / "proj.geojson")
    except roadbed.InputError as error:
        if "roadbed_proj.so" not in str(error):
            raise
        pytest.skip(str(error))


def test_what_is_saved_is_the_same_map(town: roadbed.Map, tmp_path: Path) -> None:
    skip_without_proj(town, tmp_path)
    for name in ("town.rbm", "town.geojson", "town.gpkg", "town.fgb", "town.csv", "town.svg"):
        town.save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 0
    again = roadbed.open(tmp_path / "town.rbm")
    points = points_in(town, 100)
    assert np.array_equal(again.locate(points).s_m, town.locate(points).s_m)
    program("export", TOWN, "-o", tmp_path / "told.geojson")
    assert (tmp_path / "told.geojson").read_bytes() == (tmp_path / "town.geojson").read_bytes()


def test_an_anchor_is_for_maps_of_unknown_system(town: roadbed.Map, tmp_path: Path) -> None:
    skip_without_proj(town, tmp_path)
    with pytest.raises(roadbed.InputError, match="coordinate system is known"):
        town.save(tmp_path / "a.geojson", anchor=(48.0, 9.0))
    town.save(tmp_path / "b.geojson", crs="", anchor=(48.0, 9.0))


@pytest.mark.parametrize("name", ["missing.xodr", "bad.xodr"])
def test_an_unusable_input_raises_the_programs_line(name: str, tmp_path: Path) -> None:
    file = tmp_path / name
    if name == "bad.xodr":
        file.write_text("<OpenDRIVE><road/>")
    told = program("info", file).stderr.strip().removeprefix("roadbed: ")
    with pytest.raises(roadbed.InputError) as raised:
        roadbed.open(file)
    assert str(raised.value) == told
    assert isinstance(raised.value, ValueError)
    assert raised.value.file == str(file)


def test_an_output_that_cannot_be_written_raises_an_os_error(town: roadbed.Map) -> None:
    with pytest.raises(roadbed.OutputError) as raised:
        town.save("/proc/nowhere/town.rbm")
    assert isinstance(raised.value, OSError)


def test_validate_finds_what_the_program_finds() -> None:
    found = roadbed.validate(DATA / "crossing.osm")
    told = json.loads(program("validate", DATA / "crossing.osm", "--json").stdout)["findings"]
    assert found.findings == told
    assert len(found) == len(told)
    assert bool(found) == all(finding["severity"] != "error" for finding in told)


def test_maps_draw_themselves(town: roadbed.Map) -> None:
    picture = town._repr_svg_()
    assert picture is not None
    assert picture.startswith("<")
    assert "</svg>" in picture
    assert "town.xodr" in repr(town)


def test_other_threads_go_on_while_points_are_located(town: roadbed.Map) -> None:
    points = points_in(town, 1_000_000)
    ticks = 0
    done = threading.Event()

    def work() -> None:
        town.locate(points)
        done.set()

    worker = threading.Thread(target=work)
    worker.start()
    while not done.is_set():
        ticks += 1
        time.sleep(1e-4)
    worker.join()
    assert ticks > 1  # with the interpreter's lock held there would be one


def test_wrong_shapes_are_told(town: roadbed.Map) -> None:
    with pytest.raises(
        ValueError, match=r"points: shape \(4, 3\), needs numbers of shape \(N, 2\)"
    ):
        town.locate(np.zeros((4, 3)))
    with pytest.raises(ValueError, match="count: 0"):
        town.locate(np.zeros((4, 2)), count=0)
    with pytest.raises(KeyError):
        town.lanes["nothing"]
    with pytest.raises(IndexError):
        town.lanes[10_000]
