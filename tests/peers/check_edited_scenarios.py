#!/usr/bin/env python3
"""Reads with commonroad-io what roadbed makes of CommonRoad files with map transform and map merge.

usage: check_edited_scenarios.py ROADBED FILE...

Per file: moved, every lanelet, sign, obstacle state and planning problem is where commonroad-io's
own translate_rotate puts it; merged with itself moved
away, all is there twice, links within each half, ids once. One line per file, exit status 1 if
anything is wrong."""
import logging
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from commonroad.common.file_reader import CommonRoadFileReader
from commonroad.common.util import Interval

TURN_RAD, SHIFT_M, TOLERANCE = 0.4, (1000.0, -250.0), 1e-6


def point(center):
    """An array, or a point of shapely's."""
    return np.asarray(center.coords[0] if hasattr(center, "coords") else center)[:2]


def middle(value):
    return (value.start + value.end) / 2 if isinstance(value, Interval) else value


def places(scenario, problems):
    """All numbers that say where something is; angles as cosine and sine."""
    found = {}
    for lanelet in scenario.lanelet_network.lanelets:
        found["lanelet", lanelet.lanelet_id] = np.concatenate(
            (lanelet.left_vertices.ravel(), lanelet.right_vertices.ravel()))
    for sign in scenario.lanelet_network.traffic_signs:
        found["sign", sign.traffic_sign_id] = np.asarray(sign.position)[:2]

    def state(key, one):
        angle = middle(one.orientation)
        at = point(one.position if isinstance(one.position, np.ndarray) else one.position.center)
        found[key] = np.array([*at, math.cos(angle), math.sin(angle)])

    for obstacle in scenario.obstacles:
        if not hasattr(obstacle, "initial_state"):
            continue
        state(("obstacle", obstacle.obstacle_id), obstacle.initial_state)
        for one in getattr(getattr(obstacle.prediction, "trajectory", None), "state_list", []) if (
                hasattr(obstacle, "prediction")) else []:
            state(("obstacle", obstacle.obstacle_id, one.time_step), one)
    for problem in problems.planning_problem_dict.values():
        state(("problem", problem.planning_problem_id), problem.initial_state)
        for i, goal in enumerate(problem.goal.state_list):
            center = getattr(getattr(goal, "position", None), "center", None)
            if center is not None:
                found["goal", problem.planning_problem_id, i] = point(center)
    return found


def edited(program, folder, *words):
    out = Path(folder) / "out.xml"
    done = subprocess.run([program, "map", *map(str, words), "-o", out, "--force"],
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    return CommonRoadFileReader(out).open()


def check_moved(program, file, folder, faults):
    scenario, problems = CommonRoadFileReader(file).open()
    # commonroad-io moves first and turns then.
    c, s = math.cos(TURN_RAD), math.sin(TURN_RAD)
    first = np.array([c * SHIFT_M[0] + s * SHIFT_M[1], c * SHIFT_M[1] - s * SHIFT_M[0]])
    scenario.translate_rotate(first, TURN_RAD)
    problems.translate_rotate(first, TURN_RAD)
    expected = places(scenario, problems)
    moved = places(*edited(program, folder, "transform", file, "--turn", TURN_RAD,
                           "--shift={},{}".format(*SHIFT_M)))
    if moved.keys() != expected.keys():
        faults.append("not the same elements after a motion")
    for key in expected.keys() & moved.keys():
        if np.abs(moved[key] - expected[key]).max() > TOLERANCE:
            faults.append(f"{key}: off by {np.abs(moved[key] - expected[key]).max():.6f}")
    return len(expected)


def check_merged(program, file, folder, faults):
    scenario, problems = CommonRoadFileReader(file).open()
    away = Path(folder) / "away.xml"
    subprocess.run([program, "map", "transform", file, "--shift=50000,0", "-o", away, "--force",
                    "--quiet"], check=True)
    both, both_problems = edited(program, folder, "merge", file, away)
    for what, one, two in (
            ("lanelets", scenario.lanelet_network.lanelets, both.lanelet_network.lanelets),
            ("signs", scenario.lanelet_network.traffic_signs, both.lanelet_network.traffic_signs),
            ("intersections", scenario.lanelet_network.intersections,
             both.lanelet_network.intersections),
            ("obstacles", scenario.obstacles, both.obstacles),
            ("planning problems", problems.planning_problem_dict,
             both_problems.planning_problem_dict)):
        if len(two) != 2 * len(one):
            faults.append(f"merged: {len(two)} {what} of 2 times {len(one)}")
    network = both.lanelet_network
    for lanelet in network.lanelets:
        half = lanelet.left_vertices[0][0] > 25000
        for other in lanelet.successor + lanelet.predecessor:
            found = network.find_lanelet_by_id(other)
            if found is None or (found.left_vertices[0][0] > 25000) != half:
                faults.append(f"merged: lanelet {lanelet.lanelet_id} leads to {other}")


def main():
    logging.disable(logging.CRITICAL)
    program, files = sys.argv[1], sys.argv[2:]
    wrong = 0
    for file in files:
        faults = []
        with tempfile.TemporaryDirectory() as folder:
            try:
                count = check_moved(program, file, folder, faults)
                check_merged(program, file, folder, faults)
            except RuntimeError as error:
                count, _ = 0, faults.append(str(error))
        print(f"{Path(file).name}: {count} places moved and merged, {len(faults)} faults")
        for fault in faults[:5]:
            print(f"  {fault}")
        wrong += bool(faults)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
