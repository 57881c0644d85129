#!/usr/bin/env python3
"""Makes motorway.xodr, a motorway of six lanes with an exit and an entry on either carriageway.
Usage: data/make_motorway.py

Each carriageway is three roads of three lanes, with a ramp's lane on the right:

    1: 1100 m        10    2: 800 m, two bends  11    3: 1100 m
    ------------------------------------------------------------------------
    - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - -
    - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - -
    -----------.__________                    ______________.---------------
                \\_________ 4, 300 m  5, 300 m __________/

The other one is the same, turned by half a turn, with 5 more to each number.
"""

from math import radians
from pathlib import Path as File

from make_town import CRS, EAST, WEST, Town
from opendrive import BROKEN, SOLID, Lane, Poly3, Section, smooth, write_map
from plan_view import Path, Pose

BEFORE_M, BETWEEN_M, AFTER_M, RAMP_M = 1100.0, 800.0, 1100.0, 300.0
SPLIT_M = 60.0  # over which a ramp leaves or joins
EXIT_M, ENTRY_M, TAPER_M = 200.0, 250.0, 50.0
LANE_M, SHOULDER_M, MEDIAN_M = 3.75, 2.5, 4.0
RAMP_ANGLE = radians(6)
SPEED_KMH, RAMP_KMH = 120, 80


def lanes(s, ramp_lane=None):
    """The reference line is the carriageway's left edge."""
    right = [Lane("R1", "driving", LANE_M, BROKEN), Lane("R2", "driving", LANE_M, BROKEN),
             Lane("R3", "driving", LANE_M, SOLID)]
    if ramp_lane is not None:
        right[-1].mark = BROKEN
        right.append(ramp_lane)
    return Section(s, [], right + [Lane("RB", "shoulder", SHOULDER_M)], SOLID)


def main_road(town, number, path, sections):
    return town.road(number, "Motorway", path, sections, speed_kmh=SPEED_KMH, kind="motorway")


def ramp_bend(path):
    """The first or last bend of a ramp, along SPLIT_M."""
    return path.bend(-RAMP_ANGLE, SPLIT_M / (2 * RAMP_ANGLE), 0.5)


def ramp_road(town, number, name, kind, path):
    ramp = [Lane("R1", kind, LANE_M, SOLID), Lane("RB", "shoulder", SHOULDER_M)]
    return town.road(number, name, path, [Section(0.0, [], ramp, SOLID)], speed_kmh=RAMP_KMH,
                     kind="motorway")


def go_on(town, junction, before, after):
    """The carriageway past a ramp."""
    across = [(Lane("R1", "driving", LANE_M, BROKEN), -1, -1),
              (Lane("R2", "driving", LANE_M, BROKEN), -2, -2),
              (Lane("R3", "driving", LANE_M), -3, -3)]
    path = Path(before.path.end).line_to(after.path.start)
    town.connect(junction, (before, "end"), (after, "start"), path, across, SPEED_KMH, "motorway",
                 SOLID)
    before.successor = after.predecessor = ("junction", junction.id, None)


def connect_ramp(town, junction, start, end, path, kind, before, after):
    beside = [(Lane("R1", kind, LANE_M, SOLID), before, after),
              (Lane("RB", "shoulder", SHOULDER_M), before - 1, after - 1)]
    town.connect(junction, start, end, path, beside, RAMP_KMH, "motorway", SOLID)


def carriageway(town, first, start):
    """Five roads and two junctions, numbered from `first` and 9 + `first` on."""
    exit_lane = Lane("R4", "exit", [smooth(0.0, 0.0, LANE_M, TAPER_M), Poly3(TAPER_M, LANE_M)],
                     SOLID)
    entry_lane = Lane("R4", "entry", [Poly3(0.0, LANE_M),
                                      smooth(ENTRY_M - TAPER_M, LANE_M, 0.0, TAPER_M)], SOLID)
    ahead = Pose(SPLIT_M, 0, EAST)
    before = main_road(town, first, Path(start).line(BEFORE_M),
                       [lanes(0.0), lanes(BEFORE_M - EXIT_M, exit_lane)])
    # To the left and as much to the right, so that the other one, turned, runs beside it.
    bends = lambda path: path.bend(radians(12), 900, 0.4).bend(radians(-12), 900, 0.4)
    straight_m = 0.5 * (BETWEEN_M - bends(Path(Pose(0, 0, 0))).length)
    between = main_road(town, first + 1,
                        bends(Path(before.path.end * ahead).line(straight_m)).line(straight_m),
                        [lanes(0.0)])
    after = main_road(town, first + 2, Path(between.path.end * ahead).line(AFTER_M),
                      [lanes(0.0, entry_lane), lanes(ENTRY_M)])
    beside_m = -3 * LANE_M

    junction = town.junction(first + 9, "Exit")
    go_on(town, junction, before, between)
    path = ramp_bend(Path(before.path.end.beside(beside_m)))
    ramp = ramp_road(town, first + 3, "Exit", "offRamp", Path(path.end).line(RAMP_M))
    connect_ramp(town, junction, (before, "end"), (ramp, "start"), path, "offRamp", -4, -1)
    ramp.predecessor = ("junction", junction.id, None)

    junction = town.junction(first + 10, "Entry")
    go_on(town, junction, between, after)
    from_foot = ramp_bend(Path(Pose(0, 0, 0))).end
    foot = after.path.start.beside(beside_m) * Pose(0, 0, 0).in_frame_of(from_foot)
    ramp = ramp_road(town, first + 4, "Entry", "onRamp",
                     Path(foot * Pose(-RAMP_M, 0, 0)).line(RAMP_M))
    path = ramp_bend(Path(foot))
    connect_ramp(town, junction, (ramp, "end"), (after, "start"), path, "onRamp", -1, -4)
    ramp.successor = ("junction", junction.id, None)
    return after.path.end


def main():
    town = Town()
    end = carriageway(town, 1, Pose(0, 0, EAST))
    carriageway(town, 6, end.beside(MEDIAN_M).reverse())
    write_map(File(__file__).with_name("motorway.xodr"), "roadbed motorway", CRS,
              town.roads, town.junctions, town.controllers)


if __name__ == "__main__":
    main()
