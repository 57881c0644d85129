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
that is found is a proof. Where that finds none a drive is bred: what is done to the side and along
at twelve times, between which it is linear, by (mu/mu_w, lambda)-CMA-ES [Hansen 2016,
arXiv:1604.00772], from those on that are the least off the road, in others and away from the goal;
what comes of it is held against the checker, too. That none is found proves nothing, and says
"open"."""
import sys
import warnings
from pathlib import Path

import numpy as np
import shapely
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
# Of the breeding.
KNOTS, BROOD, GENERATIONS, RESTARTS = 12, 24, 900, 3
CELL_M, AROUND_M, KEPT_M = 0.2, 45.0, 0.03
GOAL_WEIGHT, M_PER_RAD, IN_OTHERS, OVER_LIMIT = 3.0, 4.0, 3.0, 0.3


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


def first_state(problem):
    start = problem.start
    axis = np.array([np.cos(start.orientation), np.sin(start.orientation)])
    return np.array([*(start.position - CENTRE_AHEAD_M * axis), start.orientation, start.velocity,
                     0.0])


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
    layers = [(first_state(problem)[None, None], np.array([-1]))]
    region = next(problem.regions())
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


# The breeding.

class Faults:
    """How wrong drives are, at a time step, in metres; 0 if the checker will most likely agree."""

    def __init__(self, problem):
        self.problem, self.at_step = problem, {}
        self.corner = np.array(problem.start.position) - AROUND_M
        ticks = CELL_M * np.arange(int(2.0 * AROUND_M / CELL_M) + 1)
        places = shapely.points(*np.meshgrid(self.corner[0] + ticks, self.corner[1] + ticks))
        beside = unary_union(list(off_road(problem.edge)))
        shapely.prepare(beside)
        inside = shapely.intersects(beside, places)
        self.room = np.where(inside, 0.0, shapely.distance(beside, places))
        self.room[inside] = -shapely.distance(beside.boundary, places[inside])
        self.region, self.goal = next(problem.regions()), problem.goals[0]

    def off_road(self, states):
        along = np.linspace(-0.5 * VEHICLE.l, 0.5 * VEHICLE.l, 9)
        points = [(a, side * 0.5 * VEHICLE.w) for a in along for side in (-1.0, 1.0)]
        axis = np.stack([np.cos(states[:, 2]), np.sin(states[:, 2])], axis=1)
        left = np.stack([-axis[:, 1], axis[:, 0]], axis=1)
        middle, wrong = centres(states), np.zeros(len(states))
        for a, b in points:
            cell = (middle + a * axis + b * left - self.corner) / CELL_M
            at = np.clip(cell.astype(int), 0, len(self.room) - 2)
            u, v = (cell - at).T
            j, i = at.T
            room = ((1 - u) * (1 - v) * self.room[i, j] + u * (1 - v) * self.room[i, j + 1]
                    + (1 - u) * v * self.room[i + 1, j] + u * v * self.room[i + 1, j + 1])
            wrong += np.maximum(0.0, KEPT_M - room)
        return wrong

    def others(self, step):
        if step not in self.at_step:
            there = [o.occupancy_at_time(step) for o in self.problem.scenario.obstacles]
            self.at_step[step] = [
                np.array(o.shape.shapely_object.convex_hull.exterior.coords)[:-1]
                for o in there if o is not None]
        return self.at_step[step]

    def in_others(self, states, step):
        middle, wrong = centres(states), np.zeros(len(states))
        axis = np.stack([np.cos(states[:, 2]), np.sin(states[:, 2])], axis=1)
        left = np.stack([-axis[:, 1], axis[:, 0]], axis=1)
        for other in self.others(step):
            side = np.roll(other, -1, axis=0) - other
            normal = np.stack([side[:, 1], -side[:, 0]], axis=1)
            normal /= np.maximum(1e-9, np.linalg.norm(normal, axis=1))[:, None]
            apart = np.full(len(states), -np.inf)
            for direction in [axis, -axis, left, -left, *normal, *-normal]:
                direction = np.broadcast_to(direction, middle.shape)
                reach = (0.5 * VEHICLE.l * np.abs(np.sum(direction * axis, axis=1))
                         + 0.5 * VEHICLE.w * np.abs(np.sum(direction * left, axis=1)))
                between = np.sum(direction * middle, axis=1) - np.max(direction @ other.T, axis=1)
                apart = np.maximum(apart, between - reach)
            wrong += np.maximum(0.0, KEPT_M - apart)
        return wrong

    def from_goal(self, states):
        miss = (shapely.distance(self.region, shapely.points(centres(states)))
                if self.region is not None else np.zeros(len(states)))
        for name, values, weight in (("orientation", states[:, 2], M_PER_RAD),
                                     ("velocity", states[:, 3], 1.0)):
            if not hasattr(self.goal, name):
                continue
            low, high = window_of(getattr(self.goal, name))
            if name == "orientation":  # the turn by 2 pi that is nearest
                turns = np.round((values - 0.5 * (low + high)) / (2.0 * np.pi))
                values = values - 2.0 * np.pi * turns
            miss = miss + weight * np.maximum(0.0, np.maximum(low - values, values - high))
        return miss


def between_knots(genes, share):
    """Of both rows of genes of each drive."""
    at = min(KNOTS - 2, int(share * (KNOTS - 1)))
    part = share * (KNOTS - 1) - at
    return np.clip((1.0 - part) * genes[:, :, at] + part * genes[:, :, at + 1], -1.0, 1.0)


def rolled_out(faults, genes, limits_mps2):
    """The states of drives, and of each what is wrong with it if it ends at its best step."""
    problem, count = faults.problem, len(genes)
    genes = genes.reshape(count, 2, KNOTS)
    earliest = min(window_of(goal.time_step)[0] for goal in problem.goals)
    states, steps = [np.repeat(first_state(problem)[None], count, axis=0)], problem.last_step()
    wrong, best = np.zeros(count), np.full(count, np.inf)
    first = problem.start.time_step
    for step in range(first, steps):
        lateral, along = between_knots(genes, (step - first + 0.5) / (steps - first)).T
        state, fits = follow(states[-1], lateral, along, limits_mps2, problem.step_s)
        states.append(state)
        wrong = wrong + OVER_LIMIT * ~fits + faults.off_road(state)
        wrong += IN_OTHERS * faults.in_others(state, step + 1)
        if step + 1 >= earliest:
            best = np.minimum(best, wrong + GOAL_WEIGHT * faults.from_goal(state))
    return np.stack(states, axis=1), best + 0.01 * np.sum(
        np.maximum(0.0, np.abs(genes) - 1.5), axis=(1, 2))


def held_against_checker(problem, drive):
    """The drive up to where its goal is reached; none if it is not, or not free up to there."""
    for k in range(1, len(drive)):
        step = problem.start.time_step + k
        if not problem.is_free(body_at(centres(drive[k][None])[0], drive[k, 2], 0.0), step):
            return None
        if problem.is_reached(drive[k], step):
            return drive[:k + 1]
    return None


class Breeding:
    """By the tutorial's equations and default parameters."""

    def __init__(self, random):
        n, self.random = 2 * KNOTS, random
        self.weights = np.log(BROOD / 2 + 0.5) - np.log(1.0 + np.arange(BROOD // 2))
        self.weights /= self.weights.sum()
        mu = self.mu = 1.0 / np.sum(self.weights**2)
        self.path_rate = (mu + 2) / (n + mu + 5)
        self.damping = 1 + self.path_rate + 2 * max(0.0, np.sqrt((mu - 1) / (n + 1)) - 1)
        self.rank_path_rate = (4 + mu / n) / (n + 4 + 2 * mu / n)
        self.rank_one = 2 / ((n + 1.3)**2 + mu)
        self.rank_mu = min(1 - self.rank_one, 2 * (mu - 2 + 1 / mu) / ((n + 2)**2 + mu))
        self.norm = np.sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n))
        self.mean, self.width, self.generation = 0.5 * random.standard_normal(n), 0.4, 0
        self.path, self.rank_path, self.covariance = np.zeros(n), np.zeros(n), np.eye(n)

    def brood(self):
        self.root = np.linalg.cholesky(self.covariance)
        self.normal = self.random.standard_normal((BROOD, len(self.mean)))
        return self.mean + self.width * self.normal @ self.root.T

    def learn(self, wrong):
        best = self.normal[np.argsort(wrong)[:BROOD // 2]]
        steps, self.generation = best @ self.root.T, self.generation + 1
        rate, rank_rate = self.path_rate, self.rank_path_rate
        self.mean = self.mean + self.width * self.weights @ steps
        self.path = (1 - rate) * self.path + np.sqrt(rate * (2 - rate) * self.mu) * (
            self.weights @ best)
        length = np.linalg.norm(self.path)
        is_steady = length / np.sqrt(1 - (1 - rate)**(2 * self.generation)) < (
            1.4 + 2 / (len(self.mean) + 1)) * self.norm
        self.rank_path = (1 - rank_rate) * self.rank_path + is_steady * np.sqrt(
            rank_rate * (2 - rank_rate) * self.mu) * (self.weights @ steps)
        self.covariance = ((1 - self.rank_one - self.rank_mu) * self.covariance
                           + self.rank_one * np.outer(self.rank_path, self.rank_path)
                           + self.rank_mu * (steps.T * self.weights) @ steps)
        self.width *= np.exp(rate / self.damping * (length / self.norm - 1))


def breed_drive(problem, limits_mps2):
    """As find_drive does."""
    faults, random = Faults(problem), np.random.default_rng(20261127)
    for _ in range(RESTARTS):
        breeding = Breeding(random)
        for _ in range(GENERATIONS):
            drives, wrong = rolled_out(faults, breeding.brood(), limits_mps2)
            if wrong.min() < 0.1:
                drive = held_against_checker(problem, drives[np.argmin(wrong)])
                if drive is not None:
                    return drive
            breeding.learn(wrong)
            if breeding.width < 1e-4:
                break
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
    for find in (find_drive, breed_drive):
        for limits_mps2 in ((-8.0, 4.0), (-MOST_MPS2, MOST_MPS2)):
            drive = find(problem, limits_mps2)
            if drive is not None:
                return told(drive, problem.step_s)
    return f"open: no drive found among {KEPT_STATES} states of each layer, none bred, and no proof"


def main():
    if len(sys.argv) < 2:
        sys.exit("usage: solvable.py SCENARIO.xml...")
    for file in map(Path, sys.argv[1:]):
        print(f"{file.stem}: {verdict(file)}", flush=True)


if __name__ == "__main__":
    main()
