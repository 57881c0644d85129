"""Planning cycles, controllers and closed-loop drives from Python."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest
import roadbed
from places import DATA
from test_maps import program

PARKED = DATA / "scenarios" / "parked_car.json"


@pytest.fixture(scope="module")
def straight() -> roadbed.ReferenceLine:
    x = np.arange(0.0, 301.0, 20.0)
    return roadbed.ReferenceLine.through(np.column_stack([x, 0 * x]), half_width_m=5.0)


def test_a_free_line_is_driven_along(straight: roadbed.ReferenceLine) -> None:
    plan = straight.plan((10, 0, 0), 10.0)
    assert plan
    assert plan.chosen is not None
    assert plan.chosen["end_d_m"] == 0.0
    assert plan.trajectory.y_m == pytest.approx(0.0, abs=1e-9)
    assert plan.reason == ""
    assert plan._repr_svg_().startswith("<")


def test_candidates_are_the_whole_grid(straight: roadbed.ReferenceLine) -> None:
    car = roadbed.Obstacle("parked", (40, -0.5, 0))
    plan = straight.plan((10, 0, 0), 10.0, obstacles=[car])
    table = plan.candidates
    assert len(table["cost"]) == 71 * 76 == 5396
    assert table["terms"].shape == (5396, 12)
    assert not table["cost"].flags.owndata
    weights = np.array(list(roadbed.default_weights().values()))
    fit = table["rejection"] == "none"
    assert table["cost"][fit] == pytest.approx(table["terms"][fit] @ weights, rel=1e-9)
    assert (table["rejection"] == "collision").any()
    assert plan.chosen is not None
    assert plan.chosen["cost"] == pytest.approx(table["cost"][fit].min(), rel=1e-12)
    assert plan.trajectory.y_m[-1] > 0.5


def test_weights_change_the_choice(straight: roadbed.ReferenceLine) -> None:
    start = (10, 1.5, 0)
    usual = straight.plan(start, 10.0)
    steady = straight.plan(start, 10.0, weights={"offset": 100.0})
    assert usual.chosen is not None
    assert steady.chosen is not None
    assert steady.chosen["terms"]["offset"] < usual.chosen["terms"]["offset"]
    with pytest.raises(ValueError, match="no term"):
        straight.plan(start, 10.0, weights={"beauty": 1.0})
    with pytest.raises(TypeError, match="no option"):
        straight.plan(start, 10.0, colour=1)  # type: ignore[call-arg]


def test_nothing_feasible_is_a_value_with_a_reason(straight: roadbed.ReferenceLine) -> None:
    wall = roadbed.Obstacle("wall", (30, 0, np.pi / 2), length_m=30.0, width_m=1.0)
    plan = straight.plan((10, 0, 0), 10.0, obstacles=[wall])
    assert not plan
    assert "collide" in plan.reason
    assert plan.chosen is None
    assert len(plan.trajectory) == 0


def test_the_plan_of_a_scenario_is_the_programs(tmp_path: Path) -> None:
    told = program("plan", PARKED, "-o", tmp_path / "plan", "--json")
    chosen = json.loads(told.stdout)["chosen"]
    scenario = json.loads(PARKED.read_text())
    road_map = roadbed.open(PARKED.parent / scenario["map"])
    obstacles = roadbed.read_obstacles(PARKED)
    route = road_map.route(scenario["ego"]["start"], scenario["goal"])
    line = route.reference_line()
    at = line.at([0.0])
    pose = (at["x_m"][0], at["y_m"][0], at["heading_rad"][0])
    plan = line.plan(pose, scenario["ego"].get("speed_mps", 0.0), obstacles=obstacles)
    assert plan.chosen is not None
    assert plan.chosen["end_d_m"] == pytest.approx(chosen["d_e_m"], abs=0.11)


def test_occupied_cells_are_planned_around(straight: roadbed.ReferenceLine) -> None:
    random = np.random.default_rng(1)
    post = np.column_stack(
        [
            random.uniform(40, 40.4, 400),
            random.uniform(-0.2, 0.2, 400),
            random.uniform(0.3, 1.4, 400),
        ]
    )
    street = roadbed.Occupancy.from_points(post, (0, 0, 1))
    plan = straight.plan((10, 0, 0), 10.0, occupancy=street)
    assert plan
    poses = plan.trajectory.array[:, 1:4]
    assert street.clearance(poses).min() > 0.25


def test_the_previous_plan_counts(straight: roadbed.ReferenceLine) -> None:
    car = roadbed.Obstacle("parked", (40, -0.5, 0))
    first = straight.plan((10, 0, 0), 10.0, obstacles=[car])
    state = first.trajectory.array[1]
    again = straight.plan(
        state[1:4], state[4], obstacles=[car], previous=first, steering_rad=state[6]
    )
    assert again.chosen is not None
    assert again.chosen["terms"]["consistency"] < 0.05


def test_the_cruise_control_is_the_programs_design() -> None:
    cruise = roadbed.CruiseControl()
    told = json.loads(program("control", "design", "--json").stdout)
    text = json.dumps(told)
    for gain in cruise.design["K"]:
        assert repr(float(gain)) in text
    assert cruise.string_gain <= 1.0
    assert all(abs(pole) < 1.0 for pole in cruise.poles)
    with pytest.raises(ValueError, match="got"):
        roadbed.CruiseControl(step_s=-1.0)
    with pytest.raises(TypeError, match="no option"):
        roadbed.CruiseControl(colour=1)  # type: ignore[call-arg]


def test_a_follower_keeps_its_gap() -> None:
    cruise = roadbed.CruiseControl()
    gap, speed, acceleration, lead = 60.0, 20.0, 0.0, 15.0
    for _ in range(600):
        command = cruise.update(speed, acceleration, 30.0, gap, lead - speed)
        acceleration = roadbed.actuate(acceleration, command, 0.1)
        gap += 0.1 * (lead - speed)
        speed = max(0.0, speed + 0.1 * acceleration)
    assert speed == pytest.approx(15.0, abs=0.05)
    assert gap == pytest.approx(1.5 * 15.0 + 5.0, abs=0.3)
    assert cruise.estimate is not None


def test_stanley_steers_back_to_the_path() -> None:
    car = roadbed.Vehicle()
    state = np.array([0.0, 1.0, 0.2, 8.0, 0.0])
    for _ in range(800):
        front_x = state[0] + car.wheelbase_m * np.cos(state[2])
        errors = roadbed.tracking_error(state[:3], (front_x, 0.0, 0.0))
        wanted = roadbed.stanley_steering(*errors, speed_mps=state[3])
        state = roadbed.single_track_step(state, 0.0, (wanted - state[4]) / 0.01, 0.01).copy()
    assert state[1] == pytest.approx(0.0, abs=0.05)
    assert state[2] == pytest.approx(0.0, abs=0.02)
    assert roadbed.stanley_gain(0.0) == 0.5
    assert roadbed.stanley_look_forward(0.0) == 10.0


def along_the_line(seen: roadbed.Observation) -> np.ndarray:
    """Keeps to the reference line at 6 m/s and stops at its end."""
    rows = []
    s, speed = seen.s_m, seen.speed_mps
    for i in range(30):
        at = seen.line.at([s])
        left = seen.line.goal_s_m - s
        rows.append([seen.t_s + 0.1 * i, at["x_m"][0], at["y_m"][0], at["heading_rad"][0], speed])
        speed = min(6.0, speed + 0.15, np.sqrt(2 * max(left, 0.0)))
        s += 0.1 * speed
    return np.array(rows)


def write_scenario(folder: Path) -> Path:
    scenario = json.loads(PARKED.read_text()) | {"name": "own planner"}
    scenario["map"] = str((PARKED.parent / scenario["map"]).resolve())
    scenario["obstacles"] = []
    file = folder / "own.json"
    file.write_text(json.dumps(scenario))
    return file


def test_a_drive_is_the_programs(tmp_path: Path) -> None:
    program("simulate", PARKED, "-o", tmp_path / "told")
    drive = roadbed.simulate(PARKED)
    drive.save(tmp_path / "made")
    for file in (tmp_path / "told").iterdir():
        assert file.read_bytes() == (tmp_path / "made" / file.name).read_bytes(), file.name
    assert drive
    assert drive.outcome == "goal reached"
    assert drive.metrics == json.loads((tmp_path / "told" / "metrics.json").read_text())
    assert len(drive.samples["s_m"]) == len(drive.trajectory)
    assert len(drive.cycles) > 10
    assert "<svg" in drive._repr_svg_()
    with pytest.raises(roadbed.OutputError):
        drive.save(tmp_path / "made")


def test_a_log_of_a_drive_is_the_drive(tmp_path: Path) -> None:
    drive = roadbed.simulate(PARKED, mcap=True)
    drive.save(tmp_path / "drive")
    read = roadbed.Trajectory.open(tmp_path / "drive" / "drive.mcap")
    assert np.array_equal(read.array, drive.trajectory.array)
    poses = roadbed.Trajectory.open(tmp_path / "drive" / "drive.mcap", topic="/tf")
    assert np.array_equal(poses.x_m, read.x_m)
    assert np.allclose(poses.heading_rad, read.heading_rad, atol=1e-12)


def test_a_recorded_drive_is_read_with_what_its_file_leaves_open(tmp_path: Path) -> None:
    tum = tmp_path / "poses.txt"
    tum.write_text("".join(f"{0.1 * i} {i} 0 0 0 0 0 1\n" for i in range(5)))
    with pytest.raises(roadbed.InputError, match="which point of the vehicle"):
        roadbed.Trajectory.open(tum)
    assert roadbed.Trajectory.open(tum, pose_frame="1,0").x_m[2] == 1.0
    with pytest.raises(ValueError, match="pose_frame"):
        roadbed.Trajectory.open(tum, pose_frame="roof")


def test_an_own_planner_drives_and_is_judged(tmp_path: Path) -> None:
    scenario = write_scenario(tmp_path)
    drive = roadbed.simulate(scenario, along_the_line)
    assert drive.outcome == "goal reached", drive.text
    assert np.abs(drive.samples["cross_track_m"]).max() < 0.3
    drive.save(tmp_path / "drive")
    report = (tmp_path / "drive" / "report.html").read_text()
    assert "another planner" in report
    replay = program("plan", f"{tmp_path}/drive@1.0", "-o", tmp_path / "again")
    assert replay.returncode != 0
    assert "another planner" in replay.stderr


def test_a_plan_of_each_cycle_may_be_returned(tmp_path: Path) -> None:
    last: list[roadbed.Plan] = []

    def replans(seen: roadbed.Observation) -> tuple[roadbed.Plan | None, str]:
        target = min(7.0, np.sqrt(2 * max(0.0, seen.line.goal_s_m - seen.s_m)))
        plan = seen.line.plan(
            seen.pose,
            seen.speed_mps,
            target,
            obstacles=seen.predict(),
            previous=last[-1] if last else None,
            t_s=seen.t_s,
            steering_rad=seen.steering_rad,
            keep_candidates=False,
        )
        if not plan:
            return None, plan.reason
        last.append(plan)
        return plan, f"ends {plan.chosen['end_d_m']:.1f} m beside" if plan.chosen else ""

    drive = roadbed.simulate(PARKED, replans)
    assert drive.outcome != "collision", drive.text
    assert drive.metrics
    assert any("beside" in cycle["reason"] for cycle in drive.cycles)


def test_what_a_planner_raises_comes_out(tmp_path: Path) -> None:
    def lost(seen: roadbed.Observation) -> None:
        raise LookupError(f"lost after {seen.t_s} s")

    with pytest.raises(LookupError, match=r"lost after 0\.0 s"):
        roadbed.simulate(write_scenario(tmp_path), lost)
    with pytest.raises(ValueError, match="trajectory"):
        roadbed.simulate(write_scenario(tmp_path), lambda seen: np.zeros((3, 2)))


PROCESS = """
import json, sys
for line in sys.stdin:
    seen = json.loads(line)
    if "scene" in seen:
        rows = seen["scene"]["reference"]["rows"]
        goal = seen["scene"]["goal_s_m"]
    s, v, answer = seen["ego"]["s_m"], seen["ego"]["speed_mps"], []
    for i in range(30):
        k = min(max(0, int(s)), len(rows) - 2)
        a, b, f = rows[k], rows[k + 1], max(0.0, s - k)
        x, y = (a[j] + f * (b[j] - a[j]) for j in (1, 2))
        answer.append([seen["t_s"] + 0.1 * i, x, y, a[3] + f * (b[3] - a[3]), v])
        v = min(6.0, v + 0.15, (2 * max(0.0, goal - s)) ** 0.5)
        s += 0.1 * v
    print(json.dumps({"trajectory": answer, "reason": "by another process"}), flush=True)
"""


def test_a_process_drives_as_a_callable_does(tmp_path: Path) -> None:
    scenario = write_scenario(tmp_path)
    (tmp_path / "planner.py").write_text(PROCESS)
    command = f"{sys.executable} {tmp_path / 'planner.py'}"
    told = program("simulate", scenario, "-o", tmp_path / "told", "--planner", command)
    assert told.returncode == 0, told.stderr
    drive = roadbed.simulate(scenario, command)
    assert drive.outcome == "goal reached"
    assert drive.cycles[0]["reason"] == "by another process"
    drive.save(tmp_path / "made")
    for name in ("trajectory.csv", "cycles.jsonl", "metrics.json", "report.html"):
        assert (tmp_path / "told" / name).read_bytes() == (tmp_path / "made" / name).read_bytes()


def test_a_process_that_fails_is_told(tmp_path: Path) -> None:
    told = program(
        "simulate",
        write_scenario(tmp_path),
        "-o",
        tmp_path / "told",
        "--planner",
        "read line; exit 5",
    )
    assert told.returncode != 0
    assert "ended with exit status 5" in told.stderr
    assert not (tmp_path / "told").exists()
    with pytest.raises(roadbed.InputError, match="ended with exit status 5"):
        roadbed.simulate(write_scenario(tmp_path), "read line; exit 5")
