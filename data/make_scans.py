#!/usr/bin/env python3
"""Makes scans/*.pcd, what a laser scanner would see on the way of drive.json, and
scenarios/narrow_gap.pcd. Usage: data/make_scans.py

A car with a scanner on its roof stands still every few metres along the way. Each scan is a binary
PCD of float32 x y z in the map's coordinates, its VIEWPOINT the scanner's place. Rays meet the
ground, house fronts, garden walls, lamp posts, traffic lights and parked cars: those of drive.json
and some in the parking lane. Same seed, same bytes.
"""

import json
import struct
from itertools import product
from math import atan2, cos, hypot, pi, radians, sin, sqrt
from pathlib import Path
from random import Random
from xml.etree import ElementTree

from road_borders import read_roads

DATA = Path(__file__).parent
SCANNER_HEIGHT = 2.2  # m
REACH = 50.0  # m
DOWN_TO_UP = [  # degrees
    -27, -21, -17.5, -15, -13, -11.2, -9.8, -8.6, -7.6, -6.8, -6.0, -5.3, -4.6, -4.0, -3.4, -2.8,
    -2.2, 0, 4,
]
ALONG, ACROSS = 0.7, 4  # degrees between rays: within ALONG_WIDTH of the street, and elsewhere
ALONG_WIDTH = 20
RANGE_NOISE = 0.01  # m, standard deviation
THINNING = 0.3  # m: one point of a scan per cube of this size

# (road, section, lane) one after the other, as route goes from drive.json's start to its goal.
WAY = [
    (1, 3, 1), (1, 2, 2), (1, 1, 2), (1, 0, 2), (1007, 0, -1),
    (2, 0, -1), (2, 1, -1), (2, 2, -1), (2, 3, -1), (2201, 0, -1), (22, 0, -1), (2300, 0, -1),
    (23, 0, -1), (2000, 0, -1), (20, 0, -1), (2102, 0, -1), (7, 0, 1),
]


class Box:
    """Stands upright, turned by a heading."""

    def __init__(self, x, y, heading, length, width, bottom, top):
        self.x, self.y, self.bottom, self.top = x, y, bottom, top
        self.half = length / 2, width / 2
        self.c, self.s = cos(heading), sin(heading)
        self.radius = hypot(*self.half)

    def hit(self, ox, oy, oz, dx, dy, dz):
        """Distance along the ray to where it enters, None where it misses."""
        x, y = ox - self.x, oy - self.y
        near, far = 0.0, 1e9
        for place, step, low, high in (
            (self.c * x + self.s * y, self.c * dx + self.s * dy, -self.half[0], self.half[0]),
            (self.c * y - self.s * x, self.c * dy - self.s * dx, -self.half[1], self.half[1]),
            (oz, dz, self.bottom, self.top),
        ):
            if abs(step) < 1e-12:
                if not low <= place <= high:
                    return None
                continue
            a, b = sorted(((low - place) / step, (high - place) / step))
            near, far = max(near, a), min(far, b)
        return near if near <= far else None


class Post:
    """An upright cylinder."""

    def __init__(self, x, y, radius, top):
        self.x, self.y, self.radius, self.top = x, y, radius, top

    def hit(self, ox, oy, oz, dx, dy, dz):
        x, y = ox - self.x, oy - self.y
        a, b, c = dx * dx + dy * dy, x * dx + y * dy, x * x + y * y - self.radius**2
        if b * b < a * c:
            return None
        distance = (-b - sqrt(b * b - a * c)) / a
        return distance if distance > 0 and 0 <= oz + distance * dz <= self.top else None


def car(x, y, heading, length=4.4, width=1.8):
    cabin = -0.1 * length
    return [
        Box(x, y, heading, length, width, 0.15, 0.85),
        Box(x + cabin * cos(heading), y + cabin * sin(heading), heading,
            0.55 * length, width - 0.2, 0.85, 1.45),
    ]


def parked_cars(scenario):
    boxes = []
    for obstacle in scenario["obstacles"]:
        if "parked" in obstacle:
            pose = obstacle["parked"]
            boxes += car(pose["x_m"], pose["y_m"], pose["heading_rad"],
                         obstacle["length_m"], obstacle["width_m"])
    return boxes


def parking_lane(roads):
    """Cars in the parking lane of Church Street."""
    boxes = []
    for s in (42.0, 49.0, 63.0, 70.0, 84.0):
        x, y, heading = roads["3"].middle(1, -2, s)
        boxes += car(x, y, heading)
    return boxes


def beside_pavement(road, section, lane, s, distance):
    """A place `distance` behind a pavement, and the direction of the street."""
    inner, outer = road.borders(section, lane, s)
    x, y, heading = road.middle(section, lane, s)
    width = hypot(outer[0] - inner[0], outer[1] - inner[1])
    share = 1 + distance / width
    return (inner[0] + share * (outer[0] - inner[0]), inner[1] + share * (outer[1] - inner[1]),
            heading)


def street_sides(road):
    """Section, outermost lane (the pavement) and range of s along both sides of a street."""
    for index, section in enumerate(road.sections):
        lanes = road.lanes(section)
        for lane in (max(lanes), min(lanes)):
            if lanes[lane].get("type") == "sidewalk":
                yield index, lane, *road.ranges[index]


def street_front(road, random):
    """Houses, or garden walls between them, and lamp posts in the pavement's outer half."""
    things = []
    for index, lane, start, end in street_sides(road):
        s = start + 4.0
        while s < end - 4.0:
            length = min(random.uniform(8.0, 14.0), end - s)
            middle = min(s + length / 2, end)
            if random.random() < 0.65:
                x, y, heading = beside_pavement(road, index, lane, middle, 5.5)
                height = random.choice((3.0, 6.0, 9.0))
                things.append(Box(x, y, heading, length - 1.0, 8.0, 0.0, height))
            else:
                x, y, heading = beside_pavement(road, index, lane, middle, 0.5)
                things.append(Box(x, y, heading, length, 0.3, 0.0, 1.2))
            x, y, _ = beside_pavement(road, index, lane, s, -0.4)
            things.append(Post(x, y, 0.1, 5.0))
            s += length + 1.0
    return things


def traffic_lights(roads):
    posts = []
    for road in roads.values():
        for signal in road.node.findall("signals/signal"):
            if signal.get("dynamic") == "yes":
                sections = road.lanes(road.sections[0])
                x, y, _ = beside_pavement(road, 0, max(sections), float(signal.get("s")), -0.5)
                posts.append(Post(x, y, 0.12, 3.5))
    return posts


def town_things(roads, scenario):
    random = Random(20261121)
    things = parked_cars(scenario) + parking_lane(roads) + traffic_lights(roads)
    for name in ("1", "2", "3", "7"):
        things += street_front(roads[name], random)
    things.append(Post(500.0, 200.0, 4.0, 3.0))  # the monument on the roundabout
    return things


def standing_places(roads, step):
    """Poses every `step` metres along the way, the first where it begins."""
    to_go = 0.0
    for name, index, lane in WAY:
        road = roads[str(name)]
        start, end = road.ranges[index]
        while to_go < end - start:
            yield road.middle(index, lane, start + to_go if lane < 0 else end - to_go)
            to_go += step
        to_go -= end - start


def first_hit(things, ox, oy, oz, dx, dy, dz):
    """Distance to the nearest thing or the ground, None beyond reach."""
    nearest = -oz / dz if dz < 0 else REACH
    for thing in things:
        distance = thing.hit(ox, oy, oz, dx, dy, dz)
        if distance is not None and distance < nearest:
            nearest = distance
    return nearest if nearest < REACH else None


def directions(random):
    """Angles from the street's direction, all around, each a little off."""
    angle = 0.0
    while angle < 360:
        along = min(angle % 180, 180 - angle % 180) < ALONG_WIDTH
        step = ALONG if along else ACROSS
        yield radians(angle + step * random.random())
        angle += step


class Scanner:
    """Stands at a place and keeps the points [m] that it has seen from there."""

    def __init__(self, things, x, y, heading, random):
        self.place, self.heading, self.random = (x, y, SCANNER_HEIGHT), heading, random
        self.points = []
        self.views = []  # of each thing: itself, its direction and half its angle of view
        for thing in things:
            distance = hypot(thing.x - x, thing.y - y)
            if distance < REACH + thing.radius:
                near = distance <= thing.radius
                half = pi if near else atan2(thing.radius, distance - thing.radius)
                self.views.append((thing, atan2(thing.y - y, thing.x - x), half))

    def ahead(self, turn):
        return [thing for thing, bearing, half in self.views
                if abs((turn - bearing + pi) % (2 * pi) - pi) <= half]

    def look(self, turn, up, ahead=None):
        """Distance to what is seen there, and the point, measured with noise; None for nothing."""
        ray = cos(turn) * cos(up), sin(turn) * cos(up), sin(up)
        distance = first_hit(self.ahead(turn) if ahead is None else ahead, *self.place, *ray)
        if distance is None:
            return None
        measured = distance + self.random.gauss(0.0, RANGE_NOISE)
        return distance, tuple(o + measured * d for o, d in zip(self.place, ray))

    def sweep(self):
        """Looks all around and keeps one point per cube."""
        kept = {}
        for direction in directions(self.random):
            turn = self.heading + direction
            ahead = self.ahead(turn)
            for degrees in DOWN_TO_UP:
                seen = self.look(turn, radians(degrees), ahead)
                if seen is not None:
                    kept.setdefault(tuple(int(v // THINNING) for v in seen[1]), seen[1])
        self.points += kept.values()
        return self

    def look_through(self, x, y, z):
        """The point seen through a place in free space, None where the view is not free."""
        dx, dy, dz = x - self.place[0], y - self.place[1], z - self.place[2]
        flat = hypot(dx, dy)
        seen = self.look(atan2(dy, dx), atan2(dz, flat))
        return None if seen is None or seen[0] < hypot(flat, dz) + CELL else seen[1]


# Where the car goes, space is to be measured over the whole height of a car, in cubes of CELL.
CELL = 0.2  # m
LAYERS = range(1, 8)  # of cubes above the ground
RIGHT, LEFT = -1.6, 2.2  # m from the way's middle


def columns_of_way(roads):
    """Columns of cubes that the car may pass through, in order of the way."""
    columns = {}
    for x, y, heading in standing_places(roads, CELL / 2):
        for k in range(int((LEFT - RIGHT) / CELL * 2) + 1):
            t = RIGHT + k * CELL / 2
            columns[int((x - sin(heading) * t) // CELL), int((y + cos(heading) * t) // CELL)] = None
    return columns


def cubes_seen(place, point, columns):
    """Cubes of the columns that a ray more than grazes, if it ends in the middle of a cube, as one
    does from which an octree is built."""
    span = [(b // CELL + 0.5) * CELL - a for a, b in zip(place, point)]
    if span[2] >= 0:
        return
    top = (LAYERS.stop * CELL - place[2]) / span[2]  # share of the ray above the highest layer
    steps = int(hypot(*span) * (1 - top) / (0.4 * CELL)) + 1
    before = None
    for k in range(steps):
        share = top + (1 - top) * k / steps
        cube = tuple(int((a + share * d) // CELL) for a, d in zip(place, span))
        if cube == before and cube[:2] in columns:
            yield cube
        before = cube


def look_where_nobody_looked(roads, scanners):
    """Single rays through those cubes of the way that no sweep has met."""
    columns = columns_of_way(roads)
    seen = set()
    for scanner in scanners:
        for point in scanner.points:
            seen.update(cubes_seen(scanner.place, point, columns))
    for i, j in columns:
        x, y = (i + 0.5) * CELL, (j + 0.5) * CELL
        near = sorted(scanners, key=lambda s: hypot(s.place[0] - x, s.place[1] - y))[:12]
        for layer in LAYERS:
            if (i, j, layer) in seen:
                continue
            for scanner, share in product(near, (0.5, 0.3, 0.7)):
                point = scanner.look_through(x, y, (layer + share) * CELL)
                cubes = set(cubes_seen(scanner.place, point, columns)) if point else set()
                if (i, j, layer) in cubes:
                    scanner.points.append(point)
                    seen |= cubes
                    break


def write_pcd(file, scanner):
    points, sensor = scanner.points, scanner.place
    header = (
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\n"
        f"TYPE F F F\nCOUNT 1 1 1\nWIDTH {len(points)}\nHEIGHT 1\n"
        f"VIEWPOINT {sensor[0]:.3f} {sensor[1]:.3f} {sensor[2]:.3f} 1 0 0 0\n"
        f"POINTS {len(points)}\nDATA binary\n"
    )
    file.write_bytes(header.encode() + b"".join(struct.pack("<3f", *p) for p in points))


def narrow_gap():
    """Two walls along the lane that leave 2.9 m between them, seen from in front of them."""
    walls = [Box(170.0, y, 0.0, 12.0, 0.3, 0.0, 1.2) for y in (196.75, 199.95)]
    return Scanner(walls, 155.0, 198.25, 0.0, Random(20261121)).sweep()


def main():
    roads = read_roads(ElementTree.parse(DATA / "town.xodr").getroot())
    things = town_things(roads, json.loads((DATA / "drive.json").read_text()))
    random = Random(20261122)
    scanners = [Scanner(things, *pose, random).sweep() for pose in standing_places(roads, 12.0)]
    look_where_nobody_looked(roads, scanners)

    folder = DATA / "scans"
    folder.mkdir(exist_ok=True)
    for old in folder.glob("*.pcd"):
        old.unlink()
    for number, scanner in enumerate(scanners):
        write_pcd(folder / f"scan_{number:02}.pcd", scanner)
    write_pcd(DATA / "scenarios" / "narrow_gap.pcd", narrow_gap())


if __name__ == "__main__":
    main()
