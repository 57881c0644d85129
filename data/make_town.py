#!/usr/bin/env python3
"""Makes town.xodr, an invented small town in OpenDRIVE 1.6. Usage: data/make_town.py

The README beside it has a sketch and says what is where.
"""

from math import acos, pi, radians
from pathlib import Path as File

from opendrive import (
    BROKEN, DOUBLE, EDGE, SOLID, Junction, Lane, Mark, Poly3, Road, Section, Signal,
    ramp, smooth, write_map,
)
from plan_view import Path, Pose

CRS = "+proj=tmerc +lat_0=48.5 +lon_0=9 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs"
WEST, EAST, NORTH, SOUTH = pi, 0.0, pi / 2, -pi / 2
CURB = Mark("curb", "none", width=0.15)
TURN_LANE = 3.25  # m wide

CROSSROADS = Pose(300, 200, 0)
CROSSROADS_REACH = 20  # m from its centre to where its legs begin
ROUNDABOUT = Pose(500, 200, 0)
ARM_REACH = 40  # m from the roundabout's centre to where its arms end
RING_RADIUS, RING_WIDTH = 18.0, 4.5
MOUTH = radians(30)  # of the ring, from an arm to either end of its junction


class Town:
    """Roads, junctions and signals as they are added."""

    def __init__(self):
        self.roads, self.junctions, self.controllers = [], [], []
        self.signal_count = 0

    def road(self, number, name, path, sections, **more):
        self.roads.append(Road(number, name, path, sections, **more))
        return self.roads[-1]

    def junction(self, number, name):
        self.junctions.append(Junction(number, name))
        return self.junctions[-1]

    def connect(self, junction, start, end, path, lanes, speed_kmh, kind="town", mark=EDGE):
        """A connecting road; start and end are (road, contact point), lanes are
        (Lane, its lane before, its lane after)."""
        number = junction.id * 100 + len(junction.connections)
        links = [(before, -n) for n, (_, before, _) in enumerate(lanes, start=1)]
        junction.connections.append((start[0].id, number, links))
        self.road(
            number, "", path, [Section(0.0, [], [lane for lane, _, _ in lanes], mark)],
            speed_kmh=speed_kmh, kind=kind, junction=junction.id,
            predecessor=("road", start[0].id, start[1]), successor=("road", end[0].id, end[1]),
            predecessor_lanes={lane.key: before for lane, before, _ in lanes},
            successor_lanes={lane.key: after for lane, _, after in lanes},
        )

    def sign(self, road, **more):
        self.signal_count += 1
        road.signals.append(Signal(self.signal_count, **more))
        return self.signal_count


def join(before, after):
    """Links the end of a road to the start of the next, lane by lane of the same key."""
    before.successor, after.predecessor = ("road", after.id, "start"), ("road", before.id, "end")
    last, first = before.sections[-1], after.sections[0]
    for lane in last.left + last.right:
        before.successor_lanes[lane.key] = first.id_of(lane.key)
    for lane in first.left + first.right:
        after.predecessor_lanes[lane.key] = last.id_of(lane.key)


def pavement(side):
    return [Lane(side + "B", "border", 0.5, EDGE), Lane(side + "S", "sidewalk", 2.0)]


def street_side(side):
    return [Lane(side + "1", mark=CURB)] + pavement(side)


def street(s=0.0):
    """One lane each way between pavements."""
    return Section(s, street_side("L"), street_side("R"))


def shoulder(side, width=1.5):
    return [Lane(side + "B", "shoulder", width)]


def country(s=0.0, width=1.5, mark=BROKEN):
    """One lane each way between shoulders."""
    side = lambda name: [Lane(name + "1", mark=SOLID)] + shoulder(name, width)
    return Section(s, side("L"), side("R"), mark)


# --- the crossroads -----------------------------------------------------------------------------


def turn_lane_leg(town, number, name, path):
    """A street that begins at the crossroads, where a lane for left turns has opened."""

    def section(s, width, mark):
        turn = Lane("LT", "driving", width, mark)
        return Section(s, [turn] + street_side("L"), street_side("R"), DOUBLE)

    return town.road(
        number, name, path,
        [
            section(0.0, TURN_LANE, SOLID),
            section(15.0, TURN_LANE, BROKEN),
            section(40.0, [smooth(0.0, TURN_LANE, 0.0, 30.0)], BROKEN),
            street(70.0),
        ],
        offset=[Poly3(0.0, -TURN_LANE / 2)] + ramp([40.0, 70.0], [-TURN_LANE / 2, 0.0]),
    )


def outgoing(leg):
    offset = leg.offset[0].a if leg.offset else 0.0
    return leg.path.start.beside(offset)


def incoming(leg, lane):
    """Where a lane that comes in (id > 0) reaches the crossroads: its left border."""
    inner = sum(other.width for other in leg.sections[0].left[: lane - 1])
    return outgoing(leg).beside(inner).reverse()


def crossing(town, junction, leg_from, lane, leg_to):
    start, end = incoming(leg_from, lane), outgoing(leg_to)
    turn = end.in_frame_of(start).heading
    path = Path(start)
    path.line_to(end) if abs(turn) < 0.1 else path.turn_to(end)
    width = [smooth(0.0, leg_from.sections[0].left[lane - 1].width, 3.5, path.length)]
    lanes = [(Lane("R1", width=width), lane, -1)]
    if turn < -0.1:  # the pavement goes round the corner with those who turn right
        outer = zip(pavement("R"), (lane + 1, lane + 2), (-2, -3))
        lanes = [(Lane("R1", width=width, mark=CURB), lane, -1)] + list(outer)
    town.connect(junction, (leg_from, "start"), (leg_to, "start"), path, lanes, 50)


def crossroads(town, legs):
    """Legs counter-clockwise; each begins here. Left turns leave from the innermost lane."""
    junction = town.junction(10, "Crossroads")
    for index, leg in enumerate(legs):
        right, ahead, left = (legs[(index + k) % 4] for k in (1, 2, 3))
        through = leg.sections[0].id_of("L1")
        crossing(town, junction, leg, 1, left)
        crossing(town, junction, leg, through, ahead)
        crossing(town, junction, leg, through, right)
        leg.predecessor = ("junction", junction.id, None)
    traffic_lights(town, junction, legs)


def traffic_lights(town, junction, legs):
    for phase in (0, 1):
        signals = []
        for leg in (legs[phase], legs[phase + 2]):
            lanes = leg.sections[0].id_of("L1")
            width = sum(lane.width for lane in leg.sections[0].left[:lanes])
            t = (leg.offset[0].a if leg.offset else 0.0) + width + 1.0
            signals.append(town.sign(
                leg, s=1.0, t=t, orientation="-", type="1000001", name="traffic light",
                dynamic=True, lanes=(1, lanes),
            ))
        number = 1 + phase
        town.controllers.append((number, f"phase {number}", signals))
        junction.controllers.append(number)


# --- the roundabout -----------------------------------------------------------------------------


def on_ring(angle):
    """The ring's inner border, in driving direction (counter-clockwise)."""
    return ROUNDABOUT * Pose(0, 0, angle) * Pose(RING_RADIUS, 0, pi / 2)


def ring_path(start, end):
    return Path(on_ring(start)).arc(end - start, RING_RADIUS)


def mouth(town, number, arm, angle, ring_before, ring_after):
    """Where an arm, which ends here, meets the ring: past it, into it, out of it."""
    junction = town.junction(number, "Roundabout")
    lane = lambda start, end, length: Lane("R1", width=[smooth(0.0, start, end, length)])
    border = Lane("RB", "border", 0.5)
    before, after, at_arm = (ring_before, "end"), (ring_after, "start"), (arm, "end")

    path = ring_path(angle - MOUTH, angle + MOUTH)
    town.connect(junction, before, after, path, [(Lane("R1", width=RING_WIDTH), -1, -1)], 30)
    path = Path(arm.path.end).cubic_to(on_ring(angle + MOUTH))
    into = [(lane(3.5, RING_WIDTH, path.length), -1, -1), (border, -2, -2)]
    town.connect(junction, at_arm, after, path, into, 30)
    path = Path(on_ring(angle - MOUTH)).cubic_to(arm.path.end.reverse())
    out_of = [(lane(RING_WIDTH, 3.5, path.length), -1, 1), (border, -2, 2)]
    town.connect(junction, before, at_arm, path, out_of, 30)

    for road in (arm, ring_before):
        road.successor = ("junction", number, None)
    ring_after.predecessor = ("junction", number, None)
    town.sign(arm, s=arm.path.length - 1.0, t=-5.0, orientation="+", type="205",
              name="give way", lanes=(-1, -1))


def roundabout(town, arms):
    """Arms by the angle at which they leave the centre, counter-clockwise from 0."""
    ring = [
        town.road(
            20 + index, "Ring", ring_path(angle + MOUTH, angle + pi / 2 - MOUTH),
            [Section(0.0, [], [Lane("R1", width=RING_WIDTH), Lane("RB", "border", 0.5)], SOLID)],
            speed_kmh=30,
        )
        for index, angle in enumerate((0.0, pi / 2, pi, 3 * pi / 2))
    ]
    for index, arm in enumerate(arms):
        mouth(town, 20 + index, arm, index * pi / 2, ring[index - 1], ring[index])


# --- the bypass ---------------------------------------------------------------------------------

BYPASS_Y = 440.0
RAMP_ANGLE = radians(10)
SPLIT = 40.0  # m of bypass over which a ramp leaves or joins
OPENING = [smooth(0.0, 0.0, 3.5, 40.0)]
CLOSING = [smooth(0.0, 3.5, 0.0, 40.0)]


def dual(s, second=3.5, ramp_lane=None):
    """Two lanes each way; the ramp lane, if any, on the right."""
    left = [Lane("L1", mark=BROKEN), Lane("L2", "driving", second, SOLID)] + shoulder("L")
    right = [Lane("R1", mark=BROKEN), Lane("R2", "driving", second, SOLID)]
    if ramp_lane is not None:
        right[-1].mark = BROKEN
        right.append(ramp_lane)
    return Section(s, left, right + shoulder("R"), DOUBLE)


def bypass_road(town, number, x, length, sections):
    path = Path(Pose(x, BYPASS_Y, EAST)).line(length)
    return town.road(number, "Bypass", path, sections, speed_kmh=80, kind="motorway")


def bypass(town):
    exit_lane = Lane("R3", "exit", [smooth(0.0, 0.0, 3.5, 20.0), Poly3(20.0, 3.5)], SOLID)
    entry_lane = Lane("R3", "entry", [Poly3(0.0, 3.5), smooth(40.0, 3.5, 0.0, 20.0)], SOLID)
    west = bypass_road(town, 30, 90, 120, [
        dual(0.0, OPENING), dual(40.0), dual(50.0, ramp_lane=exit_lane)])
    middle = bypass_road(town, 31, 210 + SPLIT, 100, [dual(0.0)])
    east = bypass_road(town, 32, 350 + SPLIT, 140, [
        dual(0.0, ramp_lane=entry_lane), dual(60.0), dual(100.0, CLOSING)])
    return west, middle, east


def carriageways(town, junction, before, after):
    """Both directions of the bypass past a ramp."""
    lanes = lambda: [Lane("R1", mark=BROKEN), Lane("R2")]
    path = Path(before.path.end).line_to(after.path.start)
    eastward = [(lane, -n, -n) for n, lane in enumerate(lanes(), start=1)]
    town.connect(junction, (before, "end"), (after, "start"), path, eastward, 80, "motorway", SOLID)
    path = Path(after.path.start.reverse()).line_to(before.path.end.reverse())
    westward = [(lane, n, n) for n, lane in enumerate(lanes() + shoulder("R"), start=1)]
    town.connect(junction, (after, "start"), (before, "end"), path, westward, 80, "motorway", SOLID)
    before.successor = after.predecessor = ("junction", junction.id, None)


def split_bend(path):
    """The first or last bend of a ramp, along SPLIT metres."""
    return path.bend(-RAMP_ANGLE, SPLIT / (2 * RAMP_ANGLE), 0.5)


def ramp_road(town, number, name, path, kind, widths):
    lanes = [Lane("R1", kind, mark=SOLID), Lane("RB", "shoulder", widths)]
    return town.road(number, name, path, [Section(0.0, [], lanes, SOLID)], speed_kmh=60,
                     kind="motorway")


def off_ramp(town, west, middle, foot):
    junction = town.junction(30, "Off-ramp")
    carriageways(town, junction, west, middle)
    path = split_bend(Path(west.path.end.beside(-7.0)))
    road_path = Path(path.end).turn_to(foot)
    width = [Poly3(0.0, 1.5), smooth(road_path.length - 20, 1.5, 0.5, 20.0)]
    road = ramp_road(town, 33, "Off-ramp", road_path, "offRamp", width)
    lanes = [(Lane("R1", "offRamp", mark=SOLID), -3, -1), (Lane("RB", "shoulder", 1.5), -4, -2)]
    town.connect(junction, (west, "end"), (road, "start"), path, lanes, 60, "motorway", SOLID)
    road.predecessor = ("junction", junction.id, None)
    return road


def on_ramp(town, middle, east, foot):
    junction = town.junction(31, "On-ramp")
    carriageways(town, junction, middle, east)
    from_end = split_bend(Path(Pose(0, 0, 0))).end
    end = east.path.start.beside(-7.0)
    inverse = Pose(0, 0, 0).in_frame_of(from_end)
    start = end * inverse
    path = split_bend(Path(start))
    road_path = Path(foot).turn_to(start)
    width = [smooth(0.0, 0.5, 1.5, 20.0), Poly3(20.0, 1.5)]
    road = ramp_road(town, 34, "On-ramp", road_path, "onRamp", width)
    lanes = [(Lane("R1", "onRamp", mark=SOLID), -1, -3), (Lane("RB", "shoulder", 1.5), -2, -4)]
    town.connect(junction, (road, "end"), (east, "start"), path, lanes, 60, "motorway", SOLID)
    road.successor = ("junction", junction.id, None)
    return road


def ramp_feet(town, church, off, on):
    """Where both ramps meet Church Street."""
    junction = town.junction(32, "Ramps")
    foot = lambda before, after: [
        (Lane("R1", mark=SOLID), before, after), (Lane("RB", "border", 0.5), 2 * before, 2 * after)]
    path = Path(off.path.end).line_to(church.path.end.reverse())
    town.connect(junction, (off, "end"), (church, "end"), path, foot(-1, 1), 50)
    path = Path(church.path.end).line_to(on.path.start)
    town.connect(junction, (church, "end"), (on, "start"), path, foot(-1, -1), 50)
    off.successor = church.successor = on.predecessor = ("junction", junction.id, None)


# --- the other roads ----------------------------------------------------------------------------


def church_street(town):
    path = Path(CROSSROADS * Pose(0, CROSSROADS_REACH, NORTH)).line(135)
    parking = Lane("RP", "parking", ramp([0, 5, 65, 70], [0, 2.2, 2.2, 0]), CURB)
    right = [Lane("R1", mark=SOLID), parking] + pavement("R")
    sections = [street(), Section(30.0, street_side("L"), right), street(100.0)]
    return town.road(3, "Church Street", path, sections)


def country_road(town):
    path = Path(CROSSROADS * Pose(0, -CROSSROADS_REACH, SOUTH)).line(25)
    path.bend(radians(-50), 45, 0.3).line(10)
    bend_start = path.length
    path.bend(radians(140), 40, 0.3)
    bend_end = path.length
    path.line(15).bend(radians(-20), 90, 0.4).bend(radians(20), 90, 0.4)
    path.turn_to(ROUNDABOUT * Pose(0, -ARM_REACH, NORTH), 0.3)
    last = path.length - 20
    widen, narrow = [smooth(0.0, 0.5, 1.5, 20.0), Poly3(20.0, 1.5)], [smooth(0.0, 1.5, 0.5, 20.0)]
    third = (bend_end - bend_start) / 3
    return town.road(
        4, "Country road", path,
        [street(), country(25.0, widen), country(bend_start, mark=SOLID),
         country(bend_end), country(last, narrow, SOLID)],
        types=[(25.0, "rural", 70), (last, "town", 50)],
        superelevation=[Poly3(0.0, 0.0)] + ramp(
            [bend_start, bend_start + third, bend_end - third, bend_end], [0.0, 0.06, 0.06, 0.0]),
    )


def west_road(town, main):
    path = Path(main.path.end)
    path.turn_to(Pose(30, 320, NORTH), 0.3).turn_to(Pose(90, BYPASS_Y, EAST), 0.3)
    widen = [smooth(0.0, 0.5, 1.5, 20.0), Poly3(20.0, 1.5)]
    return town.road(5, "West road", path, [country(0.0, widen, SOLID)], speed_kmh=70,
                     kind="rural")


def east_road(town, start):
    path = Path(start).turn_to(Pose(600, 325, SOUTH), 0.3)
    path.turn_to(ROUNDABOUT * Pose(ARM_REACH, 0, WEST), 0.3)
    last = path.length - 20
    hill = ramp([40.0, path.length / 2, path.length - 40.0], [0.0, 4.0, 0.0])
    return town.road(
        6, "East road", path,
        [country(mark=SOLID), country(last, [smooth(0.0, 1.5, 0.5, 20.0)], SOLID)],
        speed_kmh=70, kind="rural", types=[(last, "town", 50)],
        elevation=[Poly3(0.0, 0.0)] + hill,
    )


def dead_end(town):
    """Mill Lane begins at its loop, round which one turns, and ends at the roundabout."""
    start = ROUNDABOUT * Pose(0, ARM_REACH + 70, SOUTH)
    lane = town.road(7, "Mill Lane", Path(start).line(70), [street()], speed_kmh=30,
                     kind="lowSpeed")
    junction = town.junction(7, "Loop")
    lane.predecessor = ("junction", junction.id, None)
    loop, mouth_radius = 9.5, 15.0
    flare = acos(mouth_radius / (mouth_radius + loop))  # where circles of both radii touch
    path = Path(start.reverse()).arc(-flare, mouth_radius)
    path.arc(pi + 2 * flare, loop).arc(-flare, mouth_radius)
    lanes = [(Lane("R1", mark=CURB), 1, -1), (Lane("RB", "border", 0.5), 2, -2)]
    town.connect(junction, (lane, "start"), (lane, "start"), path, lanes, 30, mark=SOLID)
    return lane


def speed_signs(town):
    """The limit at the start of each longer road, for those who drive along it."""
    for road in town.roads:
        if road.junction != -1 or road.path.length < 60:
            continue
        value = round(road.speed_kmh)
        common = {"type": "274", "subtype": str(value), "name": f"{value} km/h", "value": value}
        t = 5.0 + 3.5 * (road.kind == "motorway" and bool(road.sections[0].left))
        town.sign(road, s=5.0, t=-t, orientation="+", lanes=(-1, -1), **common)


def make_town():
    town = Town()
    at_crossroads = lambda heading: CROSSROADS * Pose(0, 0, heading) * Pose(CROSSROADS_REACH, 0, 0)
    main_west = turn_lane_leg(town, 1, "Main Street", Path(at_crossroads(WEST)).line(180))
    main_east = turn_lane_leg(
        town, 2, "Main Street",
        Path(at_crossroads(EAST)).line_to(ROUNDABOUT * Pose(-ARM_REACH, 0, EAST)))
    church, country_side = church_street(town), country_road(town)
    crossroads(town, [main_east, church, main_west, country_side])

    west = west_road(town, main_west)
    join(main_west, west)
    bypass_west, bypass_middle, bypass_east = bypass(town)
    join(west, bypass_west)
    foot = church.path.end * Pose(20, 0, 0)
    off = off_ramp(town, bypass_west, bypass_middle, foot.reverse())
    on = on_ramp(town, bypass_middle, bypass_east, foot)
    ramp_feet(town, church, off, on)

    east = east_road(town, bypass_east.path.end)
    join(bypass_east, east)
    roundabout(town, [east, dead_end(town), main_east, country_side])
    speed_signs(town)
    return town


if __name__ == "__main__":
    made = make_town()
    write_map(File(__file__).with_name("town.xodr"), "roadbed town", CRS,
              made.roads, made.junctions, made.controllers)
