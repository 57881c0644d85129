"""Occupied space and audits from Python."""

import json
from pathlib import Path

import numpy as np
import pytest
import roadbed
import shapely
from places import DATA
from test_maps import program

GAP = DATA / "scenarios" / "narrow_gap.pcd"


def wall(count: int = 4000) -> np.ndarray:
    """Points of two walls along the x axis, 3 m apart."""
    random = np.random.default_rng(7)
    x, z = random.uniform(0.0, 30.0, count), random.uniform(0.0, 2.0, count)
    y = np.where(random.random(count) < 0.5, 1.5, -1.5)
    return np.column_stack([x, y, z])


def straight(y_m: float = 0.0) -> np.ndarray:
    t = np.linspace(0.0, 4.0, 41)
    return np.column_stack([t, 5.0 + 5.0 * t, np.full(41, y_m), np.zeros(41), np.full(41, 5.0)])


@pytest.fixture(scope="module")
def walls() -> roadbed.Occupancy:
    points = wall()
    sensors = np.column_stack([points[:, 0], np.zeros(len(points)), np.ones(len(points))])
    return roadbed.Occupancy.from_points(points, sensors, resolution_m=0.1)


def test_points_make_what_the_program_makes_of_their_file(tmp_path: Path) -> None:
    points = np.round(wall(500), 3)
    np.savetxt(tmp_path / "w.xyz", points, "%.3f")
    program(
        "occupancy", "build", tmp_path / "w.xyz", "-o", tmp_path / "told.bt", "--sensor", "15,0,1"
    )
    made = roadbed.Occupancy.from_points(points, (15, 0, 1))
    made.save(tmp_path / "made.bt")
    assert (tmp_path / "made.bt").read_bytes() == (tmp_path / "told.bt").read_bytes()


def test_every_measured_point_is_occupied_and_the_way_to_it_free(walls: roadbed.Occupancy) -> None:
    points = wall()
    assert (walls.state_at(points) == 1).all()
    between = points * [1.0, 0.5, 1.0] + [0.0, 0.0, 0.5 * (1.0 - 0.0)] * np.array([0.0, 0.0, 0.0])
    assert (walls.state_at(between[:200] * [1, 1, 0] + [0, 0, 1.0]) >= -1).all()
    assert walls.state_at([(15.0, 0.0, 50.0)]).tolist() == [-1]


def test_a_list_of_scans_is_all_of_them(tmp_path: Path) -> None:
    one, two = wall(100), wall(100) + [50.0, 0.0, 0.0]
    both = roadbed.Occupancy.from_points([one, two], [(15, 0, 1), (65, 0, 1)])
    assert (both.state_at(np.vstack([one, two])) == 1).all()


def test_files_are_read_with_their_sensors(tmp_path: Path) -> None:
    program("occupancy", "build", GAP, "-o", tmp_path / "told.bt")
    made = roadbed.Occupancy.from_files([GAP])
    made.save(tmp_path / "made.bt")
    assert (tmp_path / "made.bt").read_bytes() == (tmp_path / "told.bt").read_bytes()
    cells = made.cells()
    assert cells["centre"].shape == (len(cells["size_m"]), 3)
    assert cells["occupied"].dtype == bool


def test_clearance_is_shapelys_distance_to_the_cells(walls: roadbed.Occupancy) -> None:
    cells = walls.cells()
    centre, half = cells["centre"], cells["size_m"] / 2
    counts = (
        cells["occupied"] & (centre[:, 2] + half > 0.2 + 1e-6) & (centre[:, 2] - half < 1.5 - 1e-6)
    )
    boxes = shapely.union_all(
        shapely.box(
            *(centre[counts, :2] - half[counts, None]).T,
            *(centre[counts, :2] + half[counts, None]).T,
        )
    )
    random = np.random.default_rng(3)
    poses = np.column_stack(
        [random.uniform(-10, 40, 60), random.uniform(-6, 6, 60), random.uniform(-np.pi, np.pi, 60)]
    )
    car = roadbed.Vehicle()
    body = np.array(
        [
            [-car.rear_overhang_m, -car.width_m / 2],
            [car.length_m - car.rear_overhang_m, -car.width_m / 2],
            [car.length_m - car.rear_overhang_m, car.width_m / 2],
            [-car.rear_overhang_m, car.width_m / 2],
        ]
    )
    distances = walls.clearance(poses)
    for (x, y, heading), distance in zip(poses, distances, strict=True):
        turn = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
        there = shapely.Polygon(body @ turn.T + [x, y])
        assert distance == pytest.approx(there.distance(boxes), abs=1e-6)
    assert np.array_equal(walls.clearance(poses, threads=2), distances)
    assert np.isinf(walls.clearance([(1e5, 0, 0)])).all()
    near = walls.clearance(poses, within_m=0.5)
    assert np.array_equal(near[distances < 0.49], distances[distances < 0.49])
    assert np.isinf(near[distances > 0.51]).all()


def test_an_audit_is_the_programs(walls: roadbed.Occupancy, tmp_path: Path) -> None:
    for y_m in (0.0, 0.9):
        drive = roadbed.Trajectory(straight(y_m))
        drive.save(tmp_path / "drive.csv")
        walls.save(tmp_path / "walls.bt")
        words: list[str | Path] = [
            "audit",
            "--occupancy",
            tmp_path / "walls.bt",
            "--trajectory",
            tmp_path / "drive.csv",
            "--unknown",
            "free",
            "--json",
        ]
        told = json.loads(program(*words).stdout)
        audit = walls.audit(straight(y_m), unknown="free")
        document = audit.to_dict()
        for key in told:
            assert document[key] == told[key], key
        assert bool(audit) == (told["verdict"] == "clear")
        assert audit.verdict == told["verdict"]
        assert audit._repr_svg_().endswith("</svg>\n")
        assert audit.profile[:, 1].min() >= audit.least_clearance_m - 0.02


def test_a_certificate_holds_and_a_changed_one_does_not(
    walls: roadbed.Occupancy, tmp_path: Path
) -> None:
    walls.save(tmp_path / "walls.bt")
    audit = walls.audit(straight(), unknown="free", clearance_m=0.1)
    audit.save_certificate(tmp_path / "proof.json", trajectory=tmp_path / "drive.csv")
    assert roadbed.check(tmp_path / "proof.json", clearance_m=0.1)
    assert not roadbed.check(tmp_path / "proof.json", clearance_m=0.5)
    assert program("audit", "--check", tmp_path / "proof.json").returncode == 0
    proof = json.loads((tmp_path / "proof.json").read_text())
    proof["certified_clearance_m"] += 0.2
    (tmp_path / "forged.json").write_text(json.dumps(proof))
    forged = roadbed.check(tmp_path / "forged.json")
    assert not forged
    assert forged.to_dict()


def test_a_certificate_is_about_files() -> None:
    kept = roadbed.Occupancy.from_points(wall(300), (15, 0, 1))
    audit = kept.audit(straight())
    with pytest.raises(ValueError, match="save the occupancy"):
        audit.save_certificate("/tmp/never.json")


def test_what_moves_is_audited_too(walls: roadbed.Occupancy) -> None:
    crossing = roadbed.Obstacle(
        "walker",
        [(0, 20, -4, np.pi / 2), (6, 20, 4, np.pi / 2)],
        length_m=0.5,
        width_m=0.5,
        kind="pedestrian",
    )
    audit = walls.audit(straight(), unknown="free", obstacles=[crossing])
    assert audit.verdict == "conflict"
    assert audit.conflicts[0]["obstacle"] == "walker"
    assert crossing.poses.shape == (2, 4)
    assert crossing.pose_at(3.0) == pytest.approx([20, 0, np.pi / 2])


def test_a_vehicle_may_have_parts(walls: roadbed.Occupancy) -> None:
    car = roadbed.Vehicle()
    car.add_part(
        "beam", rear_m=0, front_m=1, right_m=-1.6, left_m=1.6, from_height_m=0.5, to_height_m=1.0
    )
    assert car.parts == ["body", "beam"]
    audit = walls.audit(straight(), unknown="free", vehicle=car)
    assert audit.verdict == "conflict"
    assert audit.conflicts[0]["part"].startswith("beam")
    with pytest.raises(ValueError, match="only audits look at"):
        walls.clearance([(0, 0, 0)], vehicle=car)


def test_a_trajectory_is_its_own_memory() -> None:
    drive = roadbed.Trajectory(straight())
    assert drive.array.shape == (41, 8)
    assert not drive.array.flags.owndata
    assert np.shares_memory(drive.array, drive.speed_mps)
    assert np.array_equal(drive.array[:, :5], straight())
    with pytest.raises(roadbed.InputError, match="row"):
        roadbed.Trajectory([(0, 0, 0, 0), (0.1, 500, 0, 0)])
    with pytest.raises(ValueError, match=r"\(N, 4 to 8\)"):
        roadbed.Trajectory(np.zeros((4, 3)))


def test_wrong_words_are_told(walls: roadbed.Occupancy) -> None:
    with pytest.raises(ValueError, match="needs report, free or occupied"):
        walls.audit(straight(), unknown="maybe")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="needs a map"):
        walls.audit(straight(), ground="map")
    with pytest.raises(ValueError, match="not one finite point"):
        roadbed.Occupancy.from_points(np.full((3, 3), np.nan))
    with pytest.raises(ValueError, match="sensors: 2"):
        roadbed.Occupancy.from_points(wall(10), np.zeros((2, 3)))
