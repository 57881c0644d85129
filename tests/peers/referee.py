#!/usr/bin/env python3
"""Drives CommonRoad scenarios and has CommonRoad's own checker judge them.

usage: referee.py [--predict] ROADBED OUTPUT SCENARIO.xml...

Each scenario is simulated into a folder of OUTPUT; judged with commonroad-drivability-checker, which
shares no code with roadbed:
    goal       the planning problem's goal was reached, in time
    hits       the body touched an obstacle at a time step, or, as roadbed saw itself, between two:
               the step in which it did counts whole
    road       the body stayed within the road's boundary
    feasible   every step fits the kinematic single-track model of vehicle 2 (BMW 320i) with its
               limits, and the steering rate is within the vehicle's
    solution   solution.xml loads with commonroad-io and holds the same drive
    blind      the same with all traffic deleted before planning, judged with it: who succeeds so has
               not needed to see anybody
With --predict others are measured, tracked and foreseen, not known. Of those that fail a line tells whether any drive can succeed, see solvable.py. Prints a table, and
how many succeed only because they see the traffic. Exit status 1 if a drive collides of which
roadbed says that it does not, ends in an exception, passes 4 m/s² of lateral acceleration in a
success without saying so, or a solution does not load."""
import copy
import csv
import json
import subprocess
import sys
import warnings
import xml.etree.ElementTree as ElementTree
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from commonroad.common.file_reader import CommonRoadFileReader
from commonroad.common.solution import CommonRoadSolutionReader, VehicleType
from commonroad.scenario.state import KSState
from commonroad_dc.boundary import boundary
from commonroad_dc.collision.collision_detection.pycrcc_collision_dispatch import (
    create_collision_checker)
from commonroad_dc.feasibility.feasibility_checker import state_transition_feasibility
from commonroad_dc.feasibility.vehicle_dynamics import VehicleDynamics
from commonroad_dc import pycrcc
from vehiclemodels.vehicle_parameters import setup_vehicle_parameters

from solvable import verdict

warnings.filterwarnings("ignore")
VEHICLE = 2
STEERING_SLACK = 1.025  # the rate is a difference over a step
MOST_LATERAL_MPS2 = 4.0
TRAFFIC = ("dynamicObstacle", "staticObstacle", "obstacle", "phantomObstacle")
COLUMNS = ("t_s", "x_m", "y_m", "heading_rad", "speed_mps", "steering_rad")


def read_drive(file, step_s, ends_by_collision):
    """The drive at the scenario's time steps, rear axle; one that a collision ends, to the end of the
    step in which it happens."""
    with open(file, newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    drive = {name: np.array([float(row[name]) for row in rows]) for name in COLUMNS}
    drive["heading_rad"] = np.unwrap(drive["heading_rad"])
    end_s = drive["t_s"][-1] + (step_s if ends_by_collision else 0.0)
    times = np.arange(0.0, end_s + (-1e-6 if ends_by_collision else 1e-9), step_s)
    return {name: np.interp(times, drive["t_s"], values) for name, values in drive.items()}


def states_of(drive, first_step, ahead):
    """States of the vehicle's centre, as CommonRoad has them."""
    states = []
    for i, heading in enumerate(drive["heading_rad"]):
        centre = np.array([drive["x_m"][i], drive["y_m"][i]]) + ahead * np.array(
            [np.cos(heading), np.sin(heading)])
        states.append(KSState(time_step=int(first_step + i), position=centre,
                              orientation=float(heading), velocity=float(drive["speed_mps"][i]),
                              steering_angle=float(drive["steering_rad"][i])))
    return states


def infeasible_steps(states, step_s):
    model, count = VehicleDynamics.KS(VehicleType(VEHICLE)), 0
    for a, b in zip(states[:-1], states[1:]):
        try:
            feasible, _ = state_transition_feasibility(copy.deepcopy(a), copy.deepcopy(b), model,
                                                       step_s)
        except Exception:  # the checker's own
            feasible = False
        count += not feasible
    return count


def body_of(states, vehicle):
    body = pycrcc.TimeVariantCollisionObject(states[0].time_step)
    for state in states:
        body.append_obstacle(pycrcc.RectOBB(vehicle.l / 2, vehicle.w / 2, state.orientation,
                                            *(float(x) for x in state.position)))
    return body


def starts_right(state, problem):
    start = problem.initial_state
    turn = (state.orientation - start.orientation + np.pi) % (2 * np.pi) - np.pi
    return bool(np.linalg.norm(state.position - start.position) < 0.1
                and abs(state.velocity - start.velocity) < 0.1 and abs(turn) < 0.05)


def judge(scenario_file, folder):
    scenario, problems = CommonRoadFileReader(str(scenario_file)).open()
    problem = next(iter(problems.planning_problem_dict.values()))
    vehicle, step_s = setup_vehicle_parameters(VEHICLE), scenario.dt
    metrics = json.loads((folder / "metrics.json").read_text(encoding="utf-8"))
    drive = read_drive(folder / "trajectory.csv", step_s, metrics["collision"])
    states = states_of(drive, problem.initial_state.time_step, vehicle.b)
    solution = CommonRoadSolutionReader.open(str(folder / "solution.xml"))
    solved = solution.planning_problem_solutions[0].trajectory.state_list
    same = len(solved) == len(states) and all(
        np.allclose(a.position, b.position, atol=1e-6) for a, b in zip(solved, states))
    reached = [i for i, state in enumerate(states) if problem.goal.is_reached(state)]
    states = states[:reached[0] + 1] if reached else states
    _, edge = boundary.create_road_boundary_obstacle(scenario, method="aligned_triangulation",
                                                     axis=2)
    road = pycrcc.CollisionChecker()
    road.add_collision_object(edge)
    steering = np.array([state.steering_angle for state in states])
    rate = np.max(np.abs(np.diff(steering))) / step_s if len(states) > 1 else 0.0
    speed = np.array([state.velocity for state in states])
    turned = np.diff([state.orientation for state in states])
    body = body_of(states, vehicle)
    return {
        "goal": bool(reached) and starts_right(states[0], problem),
        "collision": metrics["collision"]
        or bool(create_collision_checker(scenario).collide(body)),
        "road": not road.collide(body),
        "feasible": infeasible_steps(states, step_s) == 0
        and bool(rate <= STEERING_SLACK * vehicle.steering.v_max),
        "steps": len(states),
        "a_lat": float(np.max(np.abs(speed[1:] * turned / step_s), initial=0.0)),
        "a_lon": float(np.max(np.abs(np.diff(speed)) / step_s, initial=0.0)),
        "says_beyond": any("m/s² to the side" in event["text"] for event in metrics["events"]),
        "solution": bool(same),
    }


def simulate(roadbed, scenario_file, folder):
    """roadbed: the program and, maybe, --predict."""
    program, *options = roadbed
    return subprocess.run([program, "simulate", str(scenario_file), "-o", str(folder), "--force",
                           "--drop-ego-recording", *options],
                          capture_output=True, text=True, check=False)


def without_traffic(scenario_file, output):
    """The scenario with nobody in it."""
    tree = ElementTree.parse(scenario_file)
    for obstacle in [child for child in tree.getroot() if child.tag in TRAFFIC]:
        tree.getroot().remove(obstacle)
    blind = output / "blind" / scenario_file.name
    blind.parent.mkdir(parents=True, exist_ok=True)
    tree.write(blind, encoding="utf-8", xml_declaration=True)
    return blind


def is_good(result):
    return result["goal"] and not result["collision"] and result["road"]


def run_blind(roadbed, output, scenario_file):
    """Whether who does not see the traffic succeeds among it."""
    folder = output / "blind" / scenario_file.stem
    done = simulate(roadbed, without_traffic(scenario_file, output), folder)
    return done.returncode in (0, 1) and bool(done.stdout) and is_good(
        judge(scenario_file, folder))


def run(roadbed, output, scenario_file):
    folder = output / scenario_file.stem
    done = simulate(roadbed, scenario_file, folder)
    said = (done.stdout if done.stdout else done.stderr).strip().splitlines()
    result = {"status": done.returncode, "said": said[-1].split(": ", 1)[-1] if said else ""}
    if done.returncode in (0, 1) and done.stdout:
        result.update(judge(scenario_file, folder))
        result["blind"] = run_blind(roadbed, output, scenario_file)
        result["solvable"] = None if is_good(result) else verdict(scenario_file)
        metrics = json.loads((folder / "metrics.json").read_text(encoding="utf-8"))
        result["at_fault"] = metrics["at_fault"]
    return result


def mark(value):
    return "yes" if value else "-"


def print_table(names, results):
    print(f"{'scenario':28} goal  hits  road  feas  blind steps  a_lat  a_lon  said")
    for name, r in zip(names, results):
        if "goal" not in r:
            print(f"{name:28} no drive: {r['said']}")
            continue
        print(f"{name:28} {mark(r['goal']):5} {mark(r['collision']):5} {mark(r['road']):5} "
              f"{mark(r['feasible']):5} {mark(r['blind']):5} {r['steps']:5}  {r['a_lat']:5.2f}  {r['a_lon']:5.2f}  "
              f"{r['said']}")
        if r["solvable"]:
            print(f"{'':28} {r['solvable']}")
    judged = [r for r in results if "goal" in r]
    good = [r for r in judged if is_good(r)]
    print(f"{len(results)} scenarios: {len(good)} reach the goal without collision on the road, "
          f"{sum(r['feasible'] for r in good)} of them with every step feasible; "
          f"{sum(r['collision'] for r in judged)} collide "
          f"({sum(r['at_fault'] for r in judged)} of them at fault), {len(results) - len(judged)} without a "
          f"drive; {sum(not r['blind'] for r in good)} of those that reach it need to see the traffic; "
          f"largest lateral acceleration of a success "
          f"{max((r['a_lat'] for r in good), default=0.0):.2f} m/s²; "
          f"{sum(r['a_lat'] > MOST_LATERAL_MPS2 for r in good)} of them beyond {MOST_LATERAL_MPS2} m/s²")
    agrees = all(r["solution"] and (r["status"] == 1 or not r["collision"]) for r in judged)
    return agrees and all(
        r["a_lat"] <= MOST_LATERAL_MPS2 or r["says_beyond"] for r in good) and all(
        r["status"] in (0, 1) for r in results)


def main():
    options = [word for word in sys.argv[1:] if word == "--predict"]
    program, output, *files = [word for word in sys.argv[1:] if word not in options]
    roadbed, output = [program, *options], Path(output)
    scenarios = sorted(Path(file) for file in files)
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda file: run(roadbed, output, file), scenarios))
    (output / "referee.json").write_text(
        json.dumps({f.stem: r for f, r in zip(scenarios, results)}, indent=1), encoding="utf-8")
    sys.exit(0 if print_table([file.stem for file in scenarios], results) else 1)


if __name__ == "__main__":
    main()
