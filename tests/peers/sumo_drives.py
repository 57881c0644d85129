#!/usr/bin/env python3
"""Drives with roadbed's planner in the traffic of SUMO, which answers.

usage: sumo_drives.py ROADBED [--map MAP.xodr]... [--seeds N] [--density VEHICLES_PER_KM]...
                      [--limit SECONDS] [--style gentle|normal|sporty] [--log DIR]

Each map is converted by netconvert, without an offset, so that both see the same coordinates. A drive
is a random trip of at least 400 m among random trips of others; SUMO moves these every 0.1 s, `roadbed
pilot` is told of those within 200 m and of the traffic lights, and the vehicle is put where its
trajectory has it 0.1 s later (where that is beside SUMO's lanes across a junction, as those of the map
differ, on the nearest one for 3 s: nobody sees a vehicle that is on none). The same trip in the same
traffic is then driven by SUMO's own driver, who speeds up by 2.6 m/s², brakes by 4.5, keeps 1 s to
others and does not slow down for bends of the road; --style sporty comes nearer to that than our normal
style.
    jams       of the drives that are not done in time, those that SUMO's own driver does not do either
    hits       collisions that SUMO reports of the vehicle, each 0.1 s; nearer than 2.5 m to who is ahead on
               the lane that SUMO has it on is one
    touches    vehicles whose body meets its body
    brakes     vehicles directly behind it that brake as hard as SUMO's can (9 m/s²), which SUMO reports as
               emergency braking
    hard       those that brake harder than they like to (4.5 m/s²), for 0.1 s or more; and behind it while
               SUMO's own driver drives
    red        stop lines passed while SUMO shows red
    time       of the trips that both finish, up to where roadbed slows down for the goal, at least 50 m
               before it: roadbed's over SUMO's
    alike      the same over that of SUMO's driver who is held to our style's lateral acceleration in bends
A row per map and density, and one of all. Exit status 1 if there is a hit, a touch, an emergency braking, a
red light, or a trip not finished in time that SUMO's own driver finishes."""
import argparse
import json
import math
import random
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import libsumo
import numpy as np
import sumo
import sumolib

DATA = Path(__file__).resolve().parents[2] / "data"
sys.path.insert(0, str(DATA))
from road_borders import in_piece, read_roads  # noqa: E402

STEP_S = 0.1
EXACTLY, NEAREST_LANE = 2, 0  # where moveToXY puts a vehicle; nobody sees one that is on no lane
SEEN_AGAIN_S = 3.0
SEEN_M = 200.0
LENGTH_M, WIDTH_M, REAR_OVERHANG_M = 4.508, 1.610, 0.8312829  # the pilot's default vehicle
FRONT_M = LENGTH_M - REAR_OVERHANG_M
COMFORTABLE_MPS2, HARDEST_MPS2 = 4.5, 9.0  # braking of SUMO's vehicles
SLOWS_MPS2 = {"gentle": 1.0, "normal": 1.5, "sporty": 2.2}  # for the goal
LATERAL_MPS2 = {"gentle": 1.5, "normal": 2.5, "sporty": 3.5}  # in bends; both as the styles
LEAST_TRIP_M = 400.0
NOT_ADDED_WITHIN_M = 50.0  # of where the ego is
LEVEL_M = 2.5  # roads over one another are farther apart
ARRIVED_M = 50.0


def with_limits_of_lanes(map_file, folder):
    """The map with the limits of its roads said of each lane, where netconvert looks for them."""
    tree = ElementTree.parse(map_file)
    for road in tree.getroot().iter("road"):
        limits = [(float(part.get("s")), part.find("speed")) for part in road.iter("type")]
        for section in road.iter("laneSection"):
            here = [limit for s, limit in limits if s <= float(section.get("s")) + 1e-6]
            if not here or here[-1] is None:
                continue
            for lane in section.iter("lane"):
                if lane.get("id") != "0" and lane.find("speed") is None:
                    ElementTree.SubElement(lane, "speed", sOffset="0", **here[-1].attrib)
    written = folder / map_file.name
    tree.write(written)
    return written


def net_of(map_file, folder):
    """The net that netconvert makes of a map."""
    net = folder / (map_file.stem + ".net.xml")
    subprocess.run([str(Path(sumo.SUMO_HOME) / "bin" / "netconvert"),
                    "--opendrive-files", str(with_limits_of_lanes(map_file, folder)),
                    "--offset.disable-normalization", "--opendrive.import-all-lanes", "false",
                    "--output.original-names", "--no-warnings", "--output-file", str(net)],
                   check=True, stdout=subprocess.DEVNULL)
    return net


def roads_of_route(options, map_file, start, goal):
    """Ids of the roads that roadbed's route leads along."""
    done = subprocess.run([options.roadbed, "route", str(map_file), "--json",
                           "--from={:.3f},{:.3f},{:.4f}".format(*start),
                           "--to={:.3f},{:.3f},{:.4f}".format(*goal)],
                          check=False, capture_output=True, text=True)
    legs = json.loads(done.stdout).get("lanes", []) if done.returncode == 0 else []
    return {leg["lane"].split("/")[0] for leg in legs}


class Traffic:
    """SUMO with random trips of others; one at a time, as libsumo is."""

    def __init__(self, net, density, seed):
        self.random = random.Random(seed)
        self.edges = [edge for edge in net.getEdges()
                      if edge.allows("passenger") and edge.getLength() > 20.0]
        self.boxes = {edge.getID(): edge.getBoundingBox() for edge in self.edges}
        length_km = sum(edge.getLength() * edge.getLaneNumber() for edge in self.edges) / 1000.0
        self.wanted = max(1, round(density * length_km))
        libsumo.start(["sumo", "--net-file", net.file, "--step-length", str(STEP_S), "--seed", str(seed),
                       "--no-step-log", "--no-warnings", "--collision.action", "warn",
                       "--collision.check-junctions", "--time-to-teleport", "-1",
                       "--default.speeddev", "0.1"])
        libsumo.vehicletype.copy("DEFAULT_VEHTYPE", "ego")
        libsumo.vehicletype.setLength("ego", LENGTH_M)
        libsumo.vehicletype.setWidth("ego", WIDTH_M)
        libsumo.vehicletype.setSpeedFactor("ego", 1.0)
        libsumo.vehicletype.setSpeedDeviation("ego", 0.0)
        self.added = 0

    def trip(self, least_m=0.0):
        """Edges from one random edge to another; None if none is found."""
        for _ in range(50):
            first, last = self.random.choice(self.edges), self.random.choice(self.edges)
            if first == last:
                continue
            found = libsumo.simulation.findRoute(first.getID(), last.getID(), "DEFAULT_VEHTYPE")
            if found.edges and found.length >= least_m:
                return list(found.edges)
        return None

    def is_near_ego(self, edge_id):
        """SUMO looks for a free place on an edge before it moves who is on the way to it."""
        if "ego" not in libsumo.vehicle.getIDList():
            return False
        x, y = libsumo.vehicle.getPosition("ego")
        left, below, right, above = self.boxes[edge_id]
        return (left - NOT_ADDED_WITHIN_M < x < right + NOT_ADDED_WITHIN_M
                and below - NOT_ADDED_WITHIN_M < y < above + NOT_ADDED_WITHIN_M)

    def fill(self):
        """As many others as there are to be, a few more each time; nobody appears beside the ego."""
        others = libsumo.vehicle.getIDCount() + len(libsumo.simulation.getPendingVehicles())
        for _ in range(min(5, self.wanted - others)):
            edges = self.trip()
            if edges is None:
                return
            if self.is_near_ego(edges[0]):
                continue
            name = f"other{self.added}"
            self.added += 1
            libsumo.route.add("route" + name, edges)
            libsumo.vehicle.add(name, "route" + name, departLane="best", departPos="random_free",
                                departSpeed="max")

    def step(self):
        self.fill()
        libsumo.simulationStep()


def heading_of(angle_deg):
    """SUMO counts from north, clockwise."""
    return math.radians(90.0 - angle_deg)


def seen_objects(ego_front):
    objects = []
    for name in libsumo.vehicle.getIDList():
        if name == "ego":
            continue
        x, y = libsumo.vehicle.getPosition(name)
        if math.dist((x, y), ego_front) > SEEN_M:
            continue
        heading = heading_of(libsumo.vehicle.getAngle(name))
        length = libsumo.vehicle.getLength(name)
        objects.append({"id": name, "kind": "car", "x_m": x - 0.5 * length * math.cos(heading),
                        "y_m": y - 0.5 * length * math.sin(heading), "heading_rad": heading,
                        "speed_mps": libsumo.vehicle.getSpeed(name), "length_m": length,
                        "width_m": libsumo.vehicle.getWidth(name)})
    return objects


def body_of(x, y, heading, length, width):
    """Corners of a body with this centre."""
    along, across = np.array([math.cos(heading), math.sin(heading)]), np.array([-math.sin(heading),
                                                                                  math.cos(heading)])
    return np.array([[x, y] + 0.5 * (i * length * along + j * width * across)
                     for i, j in ((1, 1), (1, -1), (-1, -1), (-1, 1))])


def are_apart(one, other):
    """Whether the direction of a side parts two rectangles."""
    sides = np.array([corners[i] - corners[i + 1] for corners in (one, other) for i in (0, 1)])
    first, second = one @ sides.T, other @ sides.T
    return bool(np.any((first.max(0) < second.min(0)) | (second.max(0) < first.min(0))))


def touched_by(ego, objects):
    """Names of the objects that the vehicle touches; not of those on a road over or under it."""
    x, y, heading = ego[:3]
    middle_m = 0.5 * LENGTH_M - REAR_OVERHANG_M
    own = body_of(x + middle_m * math.cos(heading), y + middle_m * math.sin(heading), heading,
                  LENGTH_M, WIDTH_M)
    own_z = libsumo.vehicle.getPosition3D("ego")[2]
    return {one["id"] for one in objects if math.dist((one["x_m"], one["y_m"]), (x, y)) < 20.0
            and abs(libsumo.vehicle.getPosition3D(one["id"])[2] - own_z) < LEVEL_M
            and not are_apart(own, body_of(one["x_m"], one["y_m"], one["heading_rad"],
                                           one["length_m"], one["width_m"]))}


def colour_of(state):
    return {"r": "red", "u": "red", "y": "yellow", "Y": "yellow"}.get(state, "green")


def place_on_road(road, s_m, forward):
    """Position and direction of travel on the reference line of a road."""
    piece = [one for one in road.pieces if float(one.get("s")) <= s_m + 1e-6][-1]
    x, y, heading = in_piece(piece, s_m - float(piece.get("s")))
    return x, y, heading + (0.0 if forward else math.pi)


def lights_of_lanes(map_file):
    """The lights that an OpenDRIVE file has for lanes by name, "12_-1": ids, and where to stop."""
    root = ElementTree.parse(map_file).getroot()
    lights = {one.get("id") for one in root.iter("signal") if one.get("dynamic") == "yes"}
    found = {}
    for name, road in read_roads(root).items():
        for one in [*road.node.iter("signal"), *road.node.iter("signalReference")]:
            for span in one.iter("validity") if one.get("id") in lights else ():
                ends = sorted((int(span.get("fromLane")), int(span.get("toLane"))))
                for lane in range(ends[0], ends[1] + 1):
                    line = place_on_road(road, float(one.get("s")), lane < 0)
                    found.setdefault(f"{name}_{lane}", {})[one.get("id")] = line
    return found


class Lights:
    """Signals of the map by the links that SUMO switches: those that the map has for the lane across
    the junction; of links without one, those that netconvert names."""

    def __init__(self, map_file, roads):
        self.roads = roads  # of the route
        self.lines = {}  # traffic light and link to where the map has drivers stop
        of_lanes = lights_of_lanes(map_file)
        self.links = []  # (traffic light, link, signal)
        self.own = None  # traffic light and link that the vehicle takes
        self.by_lane = {}  # traffic light and link by the lane across the junction
        for light in libsumo.trafficlight.getIDList():
            for index, connections in enumerate(libsumo.trafficlight.getControlledLinks(light)):
                signals = {}
                for _, _, across in connections:
                    self.by_lane[across] = (light, index)
                    for lane in libsumo.lane.getParameter(across, "origId").split() if across else ():
                        signals |= of_lanes.get(lane, {})
                self.lines[light, index] = next(iter(signals.values()), None)
                named = libsumo.trafficlight.getParameter(light, f"linkSignalID:{index}").split()
                self.links += [(light, index, one) for one in sorted(signals) or named]

    def now(self):
        """The link that the vehicle takes counts for the signals that it shares with others, also
        where it waits at the map's line, which may be within SUMO's junction."""
        if not libsumo.vehicle.getLaneID("ego").startswith(":"):
            self.own = self.by_lane.get(lane_across(self.roads))
        shown = {}
        for light, index, signal in self.links:
            state = libsumo.trafficlight.getRedYellowGreenState(light)[index]
            freer = ["red", "yellow", "green"]
            shown[signal] = max(shown.get(signal, "red"), colour_of(state), key=freer.index)
        for light, index, signal in self.links:
            if (light, index) == self.own:
                shown[signal] = colour_of(libsumo.trafficlight.getRedYellowGreenState(light)[index])
        return [{"signal": signal, "colour": colour} for signal, colour in sorted(shown.items())]


def edge_of(lane):
    return lane.rsplit("_", 1)[0]


def lane_across(roads):
    """The lane across the next junction that is of one of these roads; None if there is none."""
    lane = libsumo.vehicle.getLaneID("ego")
    if not lane or lane.startswith(":"):
        return None
    across = [link[4] for link in libsumo.lane.getLinks(lane) if link[4]]
    return next((one for one in across
                 if libsumo.lane.getParameter(one, "origId").rsplit("_", 1)[0] in roads), None)


class Pilot:
    """`roadbed pilot`, and where its trajectory has the vehicle."""

    def __init__(self, options, map_file, start, speed_mps, goal, log):
        x, y, heading = start
        self.state = [x, y, heading, speed_mps, 0.0, 0.0]
        self.log = open(log, "w", encoding="utf-8") if log else None
        self.process = subprocess.Popen(
            [options.roadbed, "pilot", str(map_file), "--options", str(options.style_file),
             "--goal", "{:.3f},{:.3f},{:.4f}".format(*goal)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def front(self):
        x, y, heading = self.state[:3]
        return x + FRONT_M * math.cos(heading), y + FRONT_M * math.sin(heading)

    def drive(self, t_s, objects, lights):
        x, y, heading, speed, acceleration, steering = self.state
        line = {"t_s": t_s, "ego": {"x_m": x, "y_m": y, "heading_rad": heading, "speed_mps": speed,
                                    "acceleration_mps2": acceleration, "steering_rad": steering},
                "obstacles": objects, "lights": lights}
        self.process.stdin.write(json.dumps(line) + "\n")
        self.process.stdin.flush()
        answer = json.loads(self.process.stdout.readline())
        if "error" in answer:
            raise RuntimeError(answer["error"])
        if self.log:
            brief = {key: answer[key] for key in ("t_s", "behaviour", "reason", "lead")}
            self.log.write(json.dumps({**brief, "ego": line["ego"], "seen": len(objects)}) + "\n")
        rows = answer["trajectory"]
        later = next((row for row in rows if row[0] >= t_s + STEP_S - 1e-6), rows[-1])
        self.state = later[1:7]
        return answer

    def close(self):
        self.process.stdin.close()
        self.process.wait()
        if self.log:
            self.log.close()


def lane_pose(net, edge_id, at_end):
    """Of the leftmost lane that cars may use, as parking lanes are right of others: where it begins
    or ends, 5 m within."""
    lane = [lane for lane in net.getEdge(edge_id).getLanes() if lane.allows("passenger")][-1]
    shape = lane.getShape()
    at_m = lane.getLength() - 5.0 if at_end else 5.0
    x, y = sumolib.geomhelper.positionAtShapeOffset(shape, at_m)
    ahead = sumolib.geomhelper.positionAtShapeOffset(shape, at_m + 0.5)
    return x, y, math.atan2(ahead[1] - y, ahead[0] - x)


class Bends:
    """How fast a driver is on a trip who knows what its bends allow, and brakes for them in time."""
    STEP_M, OVER_M = 2.0, 6.0  # the net's lines are coarse: a bend is measured over some metres

    def __init__(self, net, edges, lateral_mps2):
        points = self.line_of(net, edges)
        along_m = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        self.at_m = np.arange(0.0, along_m[-1], self.STEP_M)
        place = [np.interp(self.at_m, along_m, points[:, axis]) for axis in (0, 1)]
        self.points = np.stack(place, axis=1)
        over = round(self.OVER_M / self.STEP_M)
        before = self.points[over:-over] - self.points[:-2 * over]
        after = self.points[2 * over:] - self.points[over:-over]
        turned = np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0],
                            np.einsum("ij,ij->i", before, after))
        bend = np.pad(np.abs(turned) / self.OVER_M, over)
        self.most_mps = np.sqrt(lateral_mps2 / np.maximum(bend, 1e-6))

    @staticmethod
    def line_of(net, edges):
        """Along the leftmost lanes, and those across junctions."""
        points = []
        for edge, following in zip(edges, [*edges[1:], None]):
            lane = [one for one in net.getEdge(edge).getLanes() if one.allows("passenger")][-1]
            points += lane.getShape()
            across = [way.getViaLaneID() for way in net.getEdge(edge).getOutgoing().get(
                net.getEdge(following), [])] if following else []
            points += libsumo.lane.getShape(across[-1]) if across and across[-1] else []
        kept = [points[0], *(b for a, b in zip(points, points[1:]) if math.dist(a, b) > 0.1)]
        return np.array([point[:2] for point in kept])

    def limit_mps(self, place):
        here = int(np.argmin(np.linalg.norm(self.points - place, axis=1)))
        ahead_m = self.at_m[here:] - self.at_m[here]
        return float(np.min(np.sqrt(self.most_mps[here:] ** 2 + 2.0 * COMFORTABLE_MPS2 * ahead_m)))


def note_brakes_behind(result):
    """Who brakes harder than is liked directly behind the vehicle, and who as hard as it can."""
    for name in libsumo.vehicle.getIDList():
        braking_mps2 = -libsumo.vehicle.getAcceleration(name)
        if name == "ego" or braking_mps2 < COMFORTABLE_MPS2 + 0.1:
            continue
        leader = libsumo.vehicle.getLeader(name, 60.0)
        if leader and leader[0] == "ego":
            result["hard"].add(name)
            if braking_mps2 > HARDEST_MPS2 - 0.1:
                result["brakes"].add(name)


class RedLights:
    """Counts links taken that showed red when they were entered, and still past the map's line:
    netconvert ends lanes up to 15 m before it; 4 m on where the map has no line for the link. Lanes
    across a junction overlap where they begin, so which one it was is known on the edge behind it."""
    PAST_LINE_M = 4.0

    def __init__(self, lights):
        self.lights = lights
        self.passed, self.before = 0, None
        self.red_at_line, self.red_past_it = set(), None

    def judge(self, front):
        """After each step, with the position of the vehicle's front bumper."""
        lane = libsumo.vehicle.getLaneID("ego")
        if not lane:
            return
        if not lane.startswith(":"):
            if edge_of(lane) in self.red_at_line & (self.red_past_it or set()):
                self.passed += 1
            self.before, self.red_at_line, self.red_past_it = lane, self.red_now(lane), None
        elif self.before and self.red_past_it is None and self.is_past_line(front):
            self.red_past_it = self.red_now(self.before)

    def is_past_line(self, front):
        line = self.lights.lines.get(self.lights.own)
        if line is None:
            return libsumo.vehicle.getLanePosition("ego") > self.PAST_LINE_M
        x, y, heading = line
        return (front[0] - x) * math.cos(heading) + (front[1] - y) * math.sin(heading) > 0.0

    @staticmethod
    def red_now(lane):
        """Edges that the links of a lane lead to while they show red."""
        return {edge_of(link[0]) for link in libsumo.lane.getLinks(lane) if link[5] in "ru"}


def run(options, net, map_file, density, seed, drive):
    """One drive. Returns what became of it."""
    traffic = Traffic(net, density, seed)
    result = {"hits": 0, "touches": set(), "brakes": set(), "hard": set(), "red": 0,
              "time_s": None, "why": ""}
    try:
        for _ in range(round(20.0 / STEP_S)):
            traffic.step()
        edges = traffic.trip(LEAST_TRIP_M)
        if edges is None or not is_on_road(options, map_file, lane_pose(net, edges[-1], True)):
            return None
        libsumo.route.add("ego", edges)
        libsumo.vehicle.add("ego", "ego", typeID="ego", departLane="best", departPos="9.0",
                            departSpeed="0", arrivalPos="max")
        for _ in range(round(30.0 / STEP_S)):
            traffic.step()
            if "ego" in libsumo.vehicle.getIDList():
                break
        else:
            return None
        drive(
            options, net, map_file, traffic, edges, result, f"{map_file.stem}_{density:g}_{seed}")
        return result
    finally:
        libsumo.close()


def is_on_road(options, map_file, place):
    """Whether a place of the net is on a lane of the map, too: edges are drawn anew by netconvert."""
    done = subprocess.run([options.roadbed, "locate", str(map_file), "--json",
                           "--at={:.3f},{:.3f}".format(*place[:2])],
                          check=True, capture_output=True, text=True)
    return any(lane["distance_m"] == 0.0 for lane in json.loads(done.stdout)["points"][0]["lanes"])


def has_arrived(options, edges, goal):
    """Before either driver slows down for the goal, where SUMO's takes the vehicle away."""
    fastest_mps = libsumo.lane.getMaxSpeed(edges[-1] + "_0")
    slows_m = 0.5 * fastest_mps * fastest_mps / SLOWS_MPS2[options.style]
    return (libsumo.vehicle.getRoadID("ego") == edges[-1]
            and math.dist(libsumo.vehicle.getPosition("ego"), goal) < max(ARRIVED_M, slows_m))


def drive_by_sumo(options, net, map_file, traffic, edges, result, name, bends=None):
    begin_s = libsumo.simulation.getTime()
    goal = lane_pose(net, edges[-1], True)[:2]
    while libsumo.simulation.getTime() - begin_s < options.limit:
        if bends:
            libsumo.vehicle.setMaxSpeed("ego", bends.limit_mps(libsumo.vehicle.getPosition("ego")))
        traffic.step()
        if "ego" not in libsumo.vehicle.getIDList():
            result["time_s"] = libsumo.simulation.getTime() - begin_s
            return
        note_brakes_behind(result)
        if has_arrived(options, edges, goal):
            result["time_s"] = libsumo.simulation.getTime() - begin_s
            return


def drive_alike(options, net, map_file, traffic, edges, result, name):
    """SUMO's driver with our style's lateral acceleration."""
    bends = Bends(net, edges, LATERAL_MPS2[options.style])
    drive_by_sumo(options, net, map_file, traffic, edges, result, name, bends)


def drive_by_roadbed(options, net, map_file, traffic, edges, result, name):
    x, y = libsumo.vehicle.getPosition("ego")
    heading = heading_of(libsumo.vehicle.getAngle("ego"))
    start = (x - FRONT_M * math.cos(heading), y - FRONT_M * math.sin(heading), heading)
    goal = lane_pose(net, edges[-1], True)
    log = options.log / (name + ".jsonl") if options.log else None
    pilot = Pilot(options, map_file, start, 0.0, goal, log)
    lights = Lights(map_file, roads_of_route(options, map_file, start, goal))
    red = RedLights(lights)
    begin_s = libsumo.simulation.getTime()
    unseen_s = -math.inf
    answer = {"reason": "never asked"}
    try:
        while libsumo.simulation.getTime() - begin_s < options.limit:
            now_s = libsumo.simulation.getTime()
            objects = seen_objects(pilot.front())
            result["touches"] |= touched_by(pilot.state, objects)
            answer = pilot.drive(round(now_s - begin_s, 3), objects, lights.now())
            front = pilot.front()
            if not libsumo.vehicle.getLaneID("ego"):
                unseen_s = now_s
            where = NEAREST_LANE if now_s - unseen_s < SEEN_AGAIN_S else EXACTLY
            libsumo.vehicle.moveToXY("ego", "", -1, *front, 90.0 - math.degrees(pilot.state[2]),
                                     keepRoute=where)
            traffic.step()
            if "ego" not in libsumo.vehicle.getIDList():
                result["why"] = "SUMO took it away"
                return
            result["hits"] += sum("ego" in (hit.collider, hit.victim)
                                  for hit in libsumo.simulation.getCollisions())
            note_brakes_behind(result)
            red.judge(front)
            result["red"] = red.passed
            if has_arrived(options, edges, goal[:2]) or answer["at_goal"]:
                result["time_s"] = libsumo.simulation.getTime() - begin_s
                return
        result["why"] = answer["reason"]
    finally:
        pilot.close()


HEADER = (f"{'map':16} {'veh/km':>6} {'drives':>6} {'done':>5} {'jams':>5} {'hours':>6} {'hits':>5} {'touches':>7} "
          f"{'brakes':>6} {'hard':>9} "
          f"{'red':>4} {'time':>6} {'alike':>6}")


class Row:
    """What became of the drives on a map at a density."""

    def __init__(self, name, density):
        self.name, self.density = name, density
        self.drives = self.done = self.jams = 0
        self.hits = self.touches = self.brakes = self.hard = self.their_hard = self.red = 0
        self.hours, self.ratios, self.alike = 0.0, [], []

    @staticmethod
    def of_all(rows):
        row = Row("together", "")
        for name in ("drives", "done", "jams", "hits", "touches", "brakes", "hard", "their_hard", "red",
                     "hours", "ratios", "alike"):
            setattr(row, name, sum((getattr(one, name) for one in rows), getattr(row, name)))
        return row

    def add(self, seed, own, drive, limit_s):
        if own is None:
            return
        self.drives += 1
        self.done += own["time_s"] is not None
        self.hours += (own["time_s"] or limit_s) / 3600.0
        self.hits += own["hits"]
        self.touches += len(own["touches"])
        self.brakes += len(own["brakes"])
        self.hard += len(own["hard"])
        self.red += own["red"]
        if any(own[name] for name in ("why", "hits", "touches", "red", "brakes", "hard")):
            print(f"  {self.name} {self.density} seed {seed}: {own['hits']} hits, "
                  f"{len(own['touches'])} touches, {own['red']} red, "
                  f"{len(own['brakes'])} brakes, {len(own['hard'])} hard; {own['why']}",
                  file=sys.stderr, flush=True)
        for driver, ratios in ((drive_by_sumo, self.ratios), (drive_alike, self.alike)):
            theirs = drive(driver)
            if driver is drive_by_sumo and theirs:
                self.jams += not own["time_s"] and not theirs["time_s"]
                self.their_hard += len(theirs["hard"])
            if own["time_s"] and theirs and theirs["time_s"]:
                ratios.append(own["time_s"] / theirs["time_s"])

    def is_good(self):
        return (self.hits == self.touches == self.brakes == self.red == 0
                and self.done + self.jams == self.drives)

    def __str__(self):
        time, alike = (f"{statistics.median(ratios):6.2f}" if ratios else "     -"
                       for ratios in (self.ratios, self.alike))
        hard = f"{self.hard}, {self.their_hard}"
        return (f"{self.name:16} {self.density:>6} {self.drives:6} {self.done:5} {self.jams:5} "
                f"{self.hours:6.2f} {self.hits:5} {self.touches:7} {self.brakes:6} {hard:>9} {self.red:4} "
                f"{time} {alike}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("roadbed")
    parser.add_argument("--map", type=Path, action="append")
    parser.add_argument("--density", type=float, action="append")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--limit", type=float, default=300.0)
    parser.add_argument("--style", choices=["gentle", "normal", "sporty"], default="normal")
    parser.add_argument("--log", type=Path)
    options = parser.parse_args()
    if options.log:
        options.log.mkdir(parents=True, exist_ok=True)
    print(HEADER)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        options.style_file = Path(folder) / "style.json"
        options.style_file.write_text(json.dumps({"style": options.style}), encoding="utf-8")
        for map_file in options.map or [DATA / "town.xodr", DATA / "motorway.xodr"]:
            net = sumolib.net.readNet(str(net_of(map_file, Path(folder))))
            net.file = str(Path(folder) / (map_file.stem + ".net.xml"))
            for density in options.density or [2.0, 6.0, 12.0]:
                rows.append(Row(map_file.stem[:16], f"{density:g}"))
                for seed in range(1, options.seeds + 1):
                    def drive(driver):
                        return run(options, net, map_file, density, seed, driver)
                    rows[-1].add(seed, drive(drive_by_roadbed), drive, options.limit)
                print(rows[-1], flush=True)
    together = Row.of_all(rows)
    print(together)
    return 0 if together.is_good() else 1


if __name__ == "__main__":
    sys.exit(main())
