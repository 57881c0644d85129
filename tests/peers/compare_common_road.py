#!/usr/bin/env python3
"""Compares what roadbed reads of CommonRoad files with what commonroad-io reads of them.

usage: compare_common_road.py DUMP FILE...     DUMP is the program dump_common_road

Lanelets (vertices, links, speed limits), signs, lights, stop lines, intersections, obstacles with
all their states, planning problems: one line per file, exit status 1 if anything differs."""
import json
import logging
import subprocess
import sys

import numpy as np
from commonroad.common.file_reader import CommonRoadFileReader
from commonroad.common.util import Interval
from commonroad.scenario.obstacle import ObstacleRole

TOLERANCE_M = 1e-9
ROLES = {ObstacleRole.STATIC: 0, ObstacleRole.DYNAMIC: 1, ObstacleRole.ENVIRONMENT: 2,
         ObstacleRole.Phantom: 3}
# A state's field -> where the dump has it.
KNOWN = {"orientation": "orientation", "velocity": "velocity", "acceleration": "acceleration"}
OTHERS = {"yaw_rate": "yawRate", "slip_angle": "slipAngle", "steering_angle": "steeringAngle"}


class Comparison:
    def __init__(self):
        self.compared = 0
        self.differences = []

    def equal(self, where, ours, theirs):
        self.compared += 1
        if ours != theirs:
            self.differences.append(f"{where}: {ours} here, {theirs} there")

    def near(self, where, ours, theirs):
        ours, theirs = np.asarray(ours, float), np.asarray(theirs, float)
        self.compared += ours.size
        if ours.shape != theirs.shape or (ours.size and np.abs(ours - theirs).max() > TOLERANCE_M):
            self.differences.append(f"{where}: {ours.tolist()} here, {theirs.tolist()} there")


def limits(value):
    return [value.start, value.end] if isinstance(value, Interval) else [value, value]


def compare_lanelet(check, ours, lanelet, network):
    where = f"lanelet {lanelet.lanelet_id}"
    columns = lanelet.left_vertices.shape[1]
    for line, vertices in (("left", lanelet.left_vertices), ("right", lanelet.right_vertices),
                           ("centre", lanelet.center_vertices)):
        check.near(f"{where} {line}", np.asarray(ours[line])[:, :columns], vertices)
    for key, ids in (("successors", lanelet.successor), ("predecessors", lanelet.predecessor)):
        check.equal(f"{where} {key}", sorted(ours[key]), sorted(str(i) for i in ids))
    for key, other, same in (
            ("adjacent_left", lanelet.adj_left, lanelet.adj_left_same_direction),
            ("adjacent_right", lanelet.adj_right, lanelet.adj_right_same_direction)):
        check.equal(f"{where} {key}", ours[key], None if other is None else [str(other), same])
    speeds = [float(element.additional_values[0])
              for sign in lanelet.traffic_signs
              for element in network.find_traffic_sign_by_id(sign).traffic_sign_elements
              if element.traffic_sign_element_id.name == "MAX_SPEED"]
    check.equal(f"{where} speed limit", ours["speed_limit_mps"], min(speeds, default=None))


def compare_network(check, ours, scenario, is_2018b):
    network = scenario.lanelet_network
    check.equal("lanelets", sorted(ours["lanelets"]), sorted(str(l.lanelet_id)
                                                             for l in network.lanelets))
    for lanelet in network.lanelets:
        compare_lanelet(check, ours["lanelets"][str(lanelet.lanelet_id)], lanelet, network)
    signs = {s["id"]: s for s in ours["signals"] if not s["dynamic"]}
    if not is_2018b:  # there commonroad-io makes signs of its own out of speed limits
        check.equal("signs", sorted(signs), sorted(str(s.traffic_sign_id)
                                                   for s in network.traffic_signs))
        for sign in network.traffic_signs:
            compare_sign(check, signs[str(sign.traffic_sign_id)], sign, network)
    lights = {s["id"]: s for s in ours["signals"] if s["dynamic"]}
    check.equal("lights", sorted(lights), sorted(str(s.traffic_light_id)
                                                 for s in network.traffic_lights))
    for light in network.traffic_lights:
        mine = lights[str(light.traffic_light_id)]
        check.near(f"light {mine['id']}", mine["at"], light.position[:2])
        cycle = [f"{e.state.value} {e.duration}"
                 for e in light.traffic_light_cycle.cycle_elements]
        check.equal(f"light {mine['id']} cycle",
                    [v for k, v in mine["attributes"] if k == "cycleElement"], cycle)
    compare_stop_lines(check, ours, network)
    compare_intersections(check, ours, network)


def compare_sign(check, ours, sign, network):
    where = f"sign {ours['id']}"
    check.near(where, ours["at"], sign.position[:2])
    first = sign.traffic_sign_elements[0]
    if first.traffic_sign_element_id.name != "MAX_SPEED":  # it rewrites 274 to the country's own
        check.equal(f"{where} type", ours["type"], first.traffic_sign_element_id.value)
    check.equal(f"{where} values", ours["text"], " ".join(first.additional_values))
    referring = sorted(str(l.lanelet_id) for l in network.lanelets
                       if sign.traffic_sign_id in l.traffic_signs)
    check.equal(f"{where} lanes", sorted(ours["lanes"]), referring)


def compare_stop_lines(check, ours, network):
    mine = {line["lanes"][0]: line for line in ours["stop_lines"]}
    theirs = {str(l.lanelet_id): l.stop_line for l in network.lanelets if l.stop_line}
    check.equal("stop lines", sorted(mine), sorted(theirs))
    for lanelet, line in theirs.items():
        check.near(f"stop line of {lanelet}", mine[lanelet]["ends"], [line.start, line.end])
        references = (line.traffic_sign_ref or set()) | (line.traffic_light_ref or set())
        check.equal(f"signals of stop line of {lanelet}", sorted(mine[lanelet]["signals"]),
                    sorted(str(r) for r in references))


def compare_intersections(check, ours, network):
    mine = {rule["id"]: rule for rule in ours["intersections"]}
    check.equal("intersections", sorted(mine), sorted(str(i.intersection_id)
                                                      for i in network.intersections))
    for intersection in network.intersections:
        for incoming in intersection.incomings:
            for role, lanelets in (("incoming", incoming.incoming_lanelets),
                                   ("successors_right", incoming.outgoing_right),
                                   ("successors_straight", incoming.outgoing_straight),
                                   ("successors_left", incoming.outgoing_left)):
                members = [m[1] for m in mine[str(intersection.intersection_id)]["members"]
                           if m[0] == role and m[2] == str(incoming.incoming_id)]
                check.equal(f"intersection {intersection.intersection_id} {role}",
                            sorted(members), sorted(str(i) for i in lanelets))


def compare_state(check, where, ours, state, filled=False):
    for field in state.used_attributes:
        value = getattr(state, field)
        if field == "time_step":
            check.equal(f"{where} time", ours["time"], limits(value))
        elif field == "position":
            if ours["position"] is not None:
                check.near(f"{where} position", ours["position"], value[:2])
        elif filled and value == 0.0:
            continue  # commonroad-io puts 0 where an initial state says nothing
        elif field in KNOWN:
            check.near(f"{where} {field}", ours[KNOWN[field]], limits(value))
        else:
            check.near(f"{where} {field}", ours["others"][OTHERS[field]], limits(value))


def compare_shape(check, where, ours, shape):
    if hasattr(shape, "radius"):
        check.near(where, ours[0]["radius"], shape.radius)
    elif hasattr(shape, "length"):
        check.near(where, [ours[0]["length"], ours[0]["width"]], [shape.length, shape.width])
    else:
        check.near(where, ours[0]["corners"], shape.vertices)


def compare_obstacle(check, ours, obstacle):
    where = f"obstacle {obstacle.obstacle_id}"
    check.equal(f"{where} role", ours["role"], ROLES[obstacle.obstacle_role])
    check.equal(f"{where} type", ours["type"], obstacle.obstacle_type.value)
    compare_shape(check, f"{where} shape", ours["shape"], obstacle.obstacle_shape)
    compare_state(check, f"{where} start", ours["initial"], obstacle.initial_state, True)
    prediction = getattr(obstacle, "prediction", None)
    recorded = hasattr(prediction, "trajectory")
    occupancies = {} if recorded else getattr(prediction, "occupancies", {})
    check.equal(f"{where} occupancies", len(ours["occupancies"]), len(occupancies))
    for mine, (time, region) in zip(ours["occupancies"], occupancies.items()):
        check.equal(f"{where} occupancy's time", mine["time"], limits(time))
        check.near(f"{where} occupancy", mine["region"][0]["centre"],
                   [region.center.x, region.center.y])
        compare_shape(check, f"{where} occupancy", mine["region"], region)
    states = prediction.trajectory.state_list if recorded else []
    check.equal(f"{where} states", len(ours["trajectory"]), len(states))
    for mine, state in zip(ours["trajectory"], states):
        compare_state(check, f"{where} state {state.time_step}", mine, state)


def compare_problem(check, ours, problem):
    where = f"planning problem {problem.planning_problem_id}"
    compare_state(check, f"{where} start", ours["initial"], problem.initial_state, True)
    goals = problem.goal.state_list
    check.equal(f"{where} goals", len(ours["goals"]), len(goals))
    lanelets = problem.goal.lanelets_of_goal_position or {}
    for i, (mine, goal) in enumerate(zip(ours["goals"], goals)):
        compare_state(check, f"{where} goal {i}", mine, goal)
        check.equal(f"{where} goal {i} lanelets", mine["lanelets"],
                    [str(l) for l in lanelets.get(i, [])])
        for shape in mine["region"]:
            if "length" in shape:
                check.near(f"{where} goal {i} centre", shape["centre"],
                           [goal.position.center.x, goal.position.center.y])
                check.near(f"{where} goal {i} heading", shape["heading"],
                           goal.position.orientation)


def compare_file(dump, file):
    ours = json.loads(subprocess.run([dump, file], check=True, capture_output=True).stdout)
    scenario, problems = CommonRoadFileReader(file).open()
    check = Comparison()
    with open(file, encoding="utf-8") as text:
        compare_network(check, ours, scenario, 'commonRoadVersion="2018b"' in text.read(2000))
    check.near("dt", ours["dt"], scenario.dt)
    check.equal("obstacles", sorted(ours["obstacles"]),
                sorted(str(o.obstacle_id) for o in scenario.obstacles))
    for obstacle in scenario.obstacles:
        compare_obstacle(check, ours["obstacles"][str(obstacle.obstacle_id)], obstacle)
    theirs = problems.planning_problem_dict
    check.equal("problems", sorted(ours["problems"]), sorted(str(i) for i in theirs))
    for number, problem in theirs.items():
        compare_problem(check, ours["problems"][str(number)], problem)
    return check


def main():
    logging.disable(logging.CRITICAL)
    dump, files = sys.argv[1], sys.argv[2:]
    status = 0
    for file in files:
        check = compare_file(dump, file)
        print(f"{file.rsplit('/', 1)[-1]}: {check.compared} values compared, "
              f"{len(check.differences)} differ")
        for difference in check.differences[:5]:
            print("  " + difference[:300])
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main())
