#!/usr/bin/env python3
"""Tells whether a CommonRoad problem can be solved by any drive, without roadbed.

usage: solvable.py SCENARIO.xml...

Limits: vehicle 2 of CommonRoad with its engine, 11.5 m/s² in all, its steering and steering rate;
at most 4 m/s² to the side; the road's surface and the recorded traffic as the checker sees them.
First come proofs that no drive does it, each by an over-approximation of what can be driven:
    no goal   the problem states none
    start     the body is off the road, or touches somebody, before it moves
    apart     what is not road parts all that a disc as wide as the body can reach from the goal
    too far   as fast as the engine allows, straight on, ends before the goal at its last time
Then a drive is searched for: in layers of two time steps each state is led on by 7 shares of what
can be done to the side times 7 of what can be along; of states that are alike one is kept, by turns
the nearest to the goal and any, if the checker finds its body free at every step. First with no
more than 8 m/s² of braking and 4 m/s² of speeding up, then with all that the vehicle has. A drive
that is found is a proof; that none is found is none, and says "open"."""
import sys
import warnings
from pathlib import Path

import numpy as np
from commonroad.common.file_reader import CommonRoadFileReader
from commonroad.scenario.state import KSState
from commonroad_dc import pycrcc
from commonroad_dc.boundary import boundary
from commonroad_dc.collision.collision_detection.pycrcc_collision_dispatch import (
    create_collision_checker)
from shapely import unary_union
from shapely.geometry import Point, Polygon
from vehiclemodels.vehicle_parameters import setup_vehicle_parameters

warnings.filterwarnings("ignore")
VEHICLE = setup_vehicle_parameters(2)
WHEELBASE_M, CENTRE_AHEAD_M = VEHICLE.a + VEHICLE.b, VEHICLE.b  # of the rear axle
MOST_MPS2, MOST_LATERAL_MPS2 = VEHICLE.longitudinal.a_max, 4.0
# Of the search, inside the limits.
LATERAL_MPS2, STEERING_RADPS = 3.97, 0.39
ALONG_MPS2 = np.sqrt(MOST_MPS2**2 - MOST_LATERAL_MPS2**2)  # beside that
SHARES = np.array([-1.0, -0.6, -0.25, 0.0, 0.25, 0.6, 1.0])  # of what can be done, each way
CELLS = np.array([0.4, 0.4, 0.04, 0.6, 1.5])  # x, y, heading, speed, lateral acceleration
LAYER_STEPS, KEPT_STATES, MOST_LOOKED_AT = 2, 2500, 20
CHANCE_M, GROWN_M, SUBSTEPS = 6.0, 0.01, 4


def engine_mps2(speed):
    """Most that the engine speeds up by."""
    switch = VEHICLE.longitudinal.v_switch
    return MOST_MPS2 * np.minimum(1.0, switch / np.maximum(speed, switch))


def window_of(value):
    """The first and the last of a number or an interval."""
    return (value.start, value.end) if hasattr(value, "start") else (value, value)


class Problem:
    """A planning problem and the checker's view of its road and traffic."""

    def __init__(self, scenario_file):
        self.scenario, problems = CommonRoadFileReader(str(scenario_file)).open()
        self.problem = next(iter(problems.planning_problem_dict.values()))
        self.start, self.goals = self.problem.initial_state, self.problem.goal.state_list
        self.step_s = self.scenario.dt
        _, self.edge = boundary.create_road_boundary_obstacle(
            self.scenario, method="aligned_triangulation", axis=2)
        self.road = pycrcc.CollisionChecker()
        self.road.add_collision_object(self.edge)
        self.traffic, self.at_step = create_collision_checker(self.scenario), {}

    def last_step(self):
        return int(max(window_of(goal.time_step)[1] for goal in self.goals))

    def regions(self):
        """The goals' places as polygons; none for a goal that is anywhere."""
        for goal in self.goals:
            place = getattr(goal, "position", None)
            shapes = getattr(place, "shapes", [place])
            yield None if place is None else unary_union([Polygon(s.vertices) for s in shapes])

    def is_free(self, body, step):
        if step not in self.at_step:
            self.at_step[step] = self.traffic.time_slice(step)
        return not self.at_step[step].collide(body) and not self.road.collide(body)

    def is_reached(self, state, step):
        return self.problem.goal.is_reached(KSState(
            time_step=step, position=centres(state[None])[0], orientation=float(state[2]),
            velocity=float(state[3]), steering_angle=float(state[4])))


# Proofs.

def start_is_bad(problem):
    body = body_at(problem.start.position, problem.start.orientation, 0.0)
    if problem.road.collide(body):
        return "start: its body is not on the road"
    return None if problem.is_free(body, problem.start.time_step) else "start: it touches somebody"


def off_road(edge):
    """What the checker has beside the road, as polygons."""
    for shape in edge.unpack():
        yield Polygon(shape.vertices())


def apart(problem):
    """Where the body's middle can be, if a disc as wide as the body, which it holds, stays on the
    road, is in parts: none that the start is in meets the goal."""
    regions = list(problem.regions())
    if None in regions:
        return None
    beside = unary_union(list(off_road(problem.edge)))
    everything = unary_union([beside, *regions]).envelope.buffer(5.0)
    middles = everything.difference(beside).buffer(0.01 - 0.5 * VEHICLE.w)
    start, parts = Point(problem.start.position), getattr(middles, "geoms", [middles])
    here = [part for part in parts if part.distance(start) < 0.01]
    if any(part.intersects(region) for part in here for region in regions):
        return None
    return "apart: what is not road lies across every way to the goal"


def farthest_m(speed, duration_s):
    """Most that is driven within a time, on any way: an upper sum."""
    step_s, driven_m = 1e-3, 0.0
    for _ in range(round(duration_s / step_s)):
        speed += step_s * engine_mps2(speed)
        driven_m += step_s * speed
    return driven_m


def too_far(problem):
    regions = list(problem.regions())
    if None in regions:
        return None
    least_m = min(region.distance(Point(problem.start.position)) for region in regions)
    duration_s = problem.step_s * (problem.last_step() - problem.start.time_step)
    driven_m = farthest_m(problem.start.velocity, duration_s)
    # Beside the rear axle's way the centre comes ahead by turning about it.
    miss_m = least_m - driven_m - 2.0 * CENTRE_AHEAD_M
    if miss_m <= 0.0:
        return None
    return (f"too far: {least_m:.1f} m within {duration_s:.1f} s, and no more than "
            f"{driven_m:.1f} m can be")


def proof(problem):
    """Why no drive solves it, if that is shown."""
    if not problem.goals:
        return "no goal: the problem states none"
    return too_far(problem) or start_is_bad(problem) or apart(problem)


# The search. A state is x, y, heading, speed, steering of the rear axle.

def centres(states):
    ahead = np.stack([np.cos(states[:, 2]), np.sin(states[:, 2])], axis=1)
    return states[:, :2] + CENTRE_AHEAD_M * ahead


def body_at(centre, heading, grown_m):
    return pycrcc.RectOBB(0.5 * VEHICLE.l + grown_m, 0.5 * VEHICLE.w + grown_m, float(heading),
                          float(centre[0]), float(centre[1]))


def follow(states, lateral, along, limits_mps2, step_s):
    """A step later, with a share of what the vehicle can do to the side and along; and whether that
    keeps to the limits."""
    x, y, heading, speed, steering = states.T.copy()
    up = np.minimum(engine_mps2(speed), min(ALONG_MPS2, limits_mps2[1]))
    down = min(ALONG_MPS2, -limits_mps2[0])
    to_speed = np.maximum(0.0, speed + step_s * np.minimum(
        along * np.where(along > 0.0, min(ALONG_MPS2, limits_mps2[1]), down), up))
    fastest = np.maximum(0.1, np.maximum(speed, to_speed))
    most = np.arctan(np.minimum(np.tan(VEHICLE.steering.max),
                                LATERAL_MPS2 * WHEELBASE_M / fastest**2))
    turn = step_s * STEERING_RADPS
    to_steering = np.clip(lateral * most, steering - turn, steering + turn)
    fits = to_speed**2 * np.abs(np.tan(to_steering)) / WHEELBASE_M <= MOST_LATERAL_MPS2
    for i in range(SUBSTEPS):
        part = (i + 0.5) / SUBSTEPS
        v, delta = speed + part * (to_speed - speed), steering + part * (to_steering - steering)
        turning = v * np.tan(delta) / WHEELBASE_M
        fits &= np.abs(v * turning) <= MOST_LATERAL_MPS2
        middle = heading + 0.5 * turning * step_s / SUBSTEPS
        x += v * np.cos(middle) * step_s / SUBSTEPS
        y += v * np.sin(middle) * step_s / SUBSTEPS
        heading += turning * step_s / SUBSTEPS
    return np.stack([x, y, heading, to_speed, to_steering], axis=1), fits


def successors(states, limits_mps2, step_s, steps):
    """What the vehicle can do within some steps: its states at each, and which each comes from."""
    many = len(SHARES)**2
    parent = np.repeat(np.arange(len(states)), many)
    lateral = np.tile(np.repeat(SHARES, len(SHARES)), len(states))
    along = np.tile(SHARES, len(SHARES) * len(states))
    way, fits = [states[parent]], np.ones(len(parent), dtype=bool)
    for _ in range(steps):
        to, is_within = follow(way[-1], lateral, along, limits_mps2, step_s)
        way.append(to)
        fits &= is_within
    return np.stack([to[fits] for to in way[1:]], axis=1), parent[fits]


def one_of_each_cell(states, random):
    values = states.copy()
    values[:, 4] *= states[:, 3]**2 / WHEELBASE_M
    order = random.permutation(len(states))
    cells = np.floor(values[order] / CELLS).astype(np.int64)
    return order[np.unique(cells, axis=0, return_index=True)[1]]


def by_turns(indices, states, aim, random):
    """Nearest to the goal and any, one after the other."""
    indices = random.permutation(indices)
    if aim is None:
        return indices
    distance = np.linalg.norm(states[indices, :2] - aim, axis=1)
    near = indices[np.argsort(distance + CHANCE_M * random.random(len(indices)))]
    both = np.stack([near, indices], axis=1).ravel()
    return both[np.sort(np.unique(both, return_index=True)[1])]


def free_ones(problem, order, ways, step):
    """Of those that keep clear and on the road at each step, the first ones."""
    kept, looked_at = [], order[:MOST_LOOKED_AT * KEPT_STATES]
    for i in looked_at:
        middle = centres(ways[i])
        if all(problem.is_free(body_at(middle[k], ways[i, k, 2], GROWN_M), step + k + 1)
               for k in range(ways.shape[1])):
            kept.append(i)
        if len(kept) == KEPT_STATES:
            break
    return np.array(kept, dtype=int)


def drive_to(layers, index, steps):
    """The states from the start on, to some step of the last layer."""
    drive = []
    for ways, parents in reversed(layers):
        drive.extend(ways[index, :steps][::-1])
        index, steps = parents[index], None
    return np.array(drive[::-1])


def find_drive(problem, limits_mps2):
    """States at the time steps up to where the goal is reached; none if none is found."""
    random, start = np.random.default_rng(20261124), problem.start
    first = np.array([*start.position, start.orientation, start.velocity, 0.0])
    first[:2] -= CENTRE_AHEAD_M * np.array([np.cos(first[2]), np.sin(first[2])])
    layers, region = [(first[None, None], np.array([-1]))], next(problem.regions())
    aim = None if region is None else np.array(region.centroid.coords[0])
    earliest = min(window_of(goal.time_step)[0] for goal in problem.goals)
    for step in range(start.time_step, problem.last_step(), LAYER_STEPS):
        steps = min(LAYER_STEPS, problem.last_step() - step)
        ways, parents = successors(layers[-1][0][:, -1], limits_mps2, problem.step_s, steps)
        order = by_turns(one_of_each_cell(ways[:, -1], random), ways[:, -1], aim, random)
        kept = free_ones(problem, order, ways, step)
        if len(kept) == 0:
            return None
        layers.append((ways[kept], parents[kept]))
        for i, k in np.ndindex(len(kept), steps):
            if step + k + 1 >= earliest and problem.is_reached(ways[kept[i], k], step + k + 1):
                return drive_to(layers, i, k + 1)
    return None


def told(drive, step_s):
    along = np.diff(drive[:, 3]) / step_s
    lateral = np.max(drive[:, 3]**2 * np.abs(np.tan(drive[:, 4])) / WHEELBASE_M)
    return (f"drivable: a search finds a drive of {step_s * (len(drive) - 1):.1f} s with "
            f"{along.min():.1f} to {along.max():.1f} m/s² along, {lateral:.1f} m/s² to the side")


def verdict(scenario_file):
    """Whether a problem can be solved, in a line."""
    problem = Problem(scenario_file)
    shown = proof(problem)
    if shown:
        return f"unsolvable, {shown}"
    for limits_mps2 in ((-8.0, 4.0), (-MOST_MPS2, MOST_MPS2)):
        drive = find_drive(problem, limits_mps2)
        if drive is not None:
            return told(drive, problem.step_s)
    return f"open: no drive found among {KEPT_STATES} states of each layer, and no proof"


def main():
    if len(sys.argv) < 2:
        sys.exit("usage: solvable.py SCENARIO.xml...")
    for file in map(Path, sys.argv[1:]):
        print(f"{file.stem}: {verdict(file)}", flush=True)


if __name__ == "__main__":
    main()
