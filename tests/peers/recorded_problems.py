#!/usr/bin/env python3
"""Makes planning problems of CommonRoad scenarios out of their recorded cars.

usage: recorded_problems.py OUTPUT SCENARIO.xml...

A car is taken out of the recording; where it started is the start, and the goal is a rectangle around
where it ended, with its heading, at its time. So a problem is solvable, at least by who drives as the
recording does, which may be sharper than a vehicle can. Cars of less than 3 s or 20 m are left out;
at most six a scenario, in the order of the file. The problems are named SCENARIO_carID.xml."""
import copy
import math
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

LEAST_TIME_S, LEAST_WAY_M, MOST_A_SCENARIO = 3.0, 20.0, 6
GOAL_LENGTH_M, GOAL_WIDTH_M, GOAL_HEADING_RAD, GOAL_TIME_STEPS = 12.0, 3.0, 0.4, 15
CARS = ("car", "taxi", "bus", "truck")


def exact(state, name):
    """The value of a state, none if it has none or an interval."""
    text = state.findtext(f"{name}/exact")
    return None if text is None else float(text)


def point(state):
    x, y = state.findtext("position/point/x"), state.findtext("position/point/y")
    return None if x is None or y is None else (float(x), float(y))


def states_of(car):
    """All states of a recorded car that starts at the first step, if all that is needed is there."""
    states = [car.find("initialState"), *car.findall("trajectory/state")]
    whole = all(point(s) is not None and exact(s, "orientation") is not None
                and exact(s, "time") is not None for s in states)
    first = states[0]
    if len(states) < 2 or not whole or exact(first, "velocity") is None or exact(first, "time") != 0:
        return None
    return states


def is_worth_driving(states, step_s):
    points = [point(state) for state in states]
    way_m = sum(math.dist(a, b) for a, b in zip(points, points[1:]))
    return exact(states[-1], "time") * step_s >= LEAST_TIME_S and way_m >= LEAST_WAY_M


def add_interval(parent, name, low, high):
    interval = ElementTree.SubElement(parent, name)
    ElementTree.SubElement(interval, "intervalStart").text = str(low)
    ElementTree.SubElement(interval, "intervalEnd").text = str(high)


def goal_at(state):
    (x, y), heading, step = point(state), exact(state, "orientation"), int(exact(state, "time"))
    goal = ElementTree.Element("goalState")
    area = ElementTree.SubElement(ElementTree.SubElement(goal, "position"), "rectangle")
    for name, value in (("length", GOAL_LENGTH_M), ("width", GOAL_WIDTH_M), ("orientation", heading)):
        ElementTree.SubElement(area, name).text = str(value)
    centre = ElementTree.SubElement(area, "center")
    ElementTree.SubElement(centre, "x").text = str(x)
    ElementTree.SubElement(centre, "y").text = str(y)
    add_interval(goal, "orientation", heading - GOAL_HEADING_RAD, heading + GOAL_HEADING_RAD)
    add_interval(goal, "time", max(1, step - GOAL_TIME_STEPS), step)
    return goal


def start_at(initial, state):
    """Sets the problem's initial state; what is not of the recording becomes 0."""
    x, y = point(state)
    initial.find("position/point/x").text, initial.find("position/point/y").text = str(x), str(y)
    for name in ("time", "yawRate", "slipAngle", "acceleration"):
        if initial.find(f"{name}/exact") is not None:
            initial.find(f"{name}/exact").text = "0"
    for name in ("orientation", "velocity"):
        initial.find(f"{name}/exact").text = str(exact(state, name))


def problem_of(scenario, car, states):
    made = copy.deepcopy(scenario)
    made.remove(next(c for c in made.findall("dynamicObstacle") if c.get("id") == car.get("id")))
    problem, *others = made.findall("planningProblem")
    for other in others:
        made.remove(other)
    for goal in problem.findall("goalState"):
        problem.remove(goal)
    start_at(problem.find("initialState"), states[0])
    problem.append(goal_at(states[-1]))
    return made


def problems_of(scenario):
    step_s, count = float(scenario.get("timeStepSize")), 0
    for car in scenario.findall("dynamicObstacle"):
        states = states_of(car) if car.findtext("type") in CARS else None
        if states is None or not is_worth_driving(states, step_s) or count == MOST_A_SCENARIO:
            continue
        count += 1
        yield car.get("id"), problem_of(scenario, car, states)


def main():
    if len(sys.argv) < 3:
        sys.exit("usage: recorded_problems.py OUTPUT SCENARIO.xml...")
    output = Path(sys.argv[1])
    output.mkdir(parents=True, exist_ok=True)
    for file in map(Path, sys.argv[2:]):
        scenario = ElementTree.parse(file).getroot()
        for name, problem in problems_of(scenario):
            ElementTree.ElementTree(problem).write(output / f"{file.stem}_car{name}.xml",
                                                   encoding="utf-8", xml_declaration=True)


if __name__ == "__main__":
    main()
