#!/usr/bin/env python3
"""Makes country.xodr, a straight country road and a side road that meets it at a stop sign.
Usage: data/make_country.py

    1: 900 m, one lane each way      junction 10      2: 160 m
    ------------------------------------+-----------------------
                                   stop | 3: 120 m
"""

from math import pi
from pathlib import Path as File

from make_town import CRS, EAST, SOUTH, Town, country, incoming, outgoing
from opendrive import BROKEN, Lane, write_map
from plan_view import Path, Pose

MAIN_M, REACH_M = 900.0, 20.0  # of the western leg; from the junction's middle to its legs
MIDDLE = Pose(MAIN_M + REACH_M, 0.0, EAST)


def leg_end(leg):
    """Where the western leg, which ends here, leaves for the junction."""
    return leg.path.end


def through_or_turn(town, junction, start, start_lane, end, end_lane, poses):
    turn = poses[1].in_frame_of(poses[0]).heading
    path = Path(poses[0])
    path.line_to(poses[1]) if abs(turn) < 0.1 else path.turn_to(poses[1])
    town.connect(junction, start, end, path, [(Lane("R1"), start_lane, end_lane)], 50, "rural")


def main():
    town = Town()
    west = town.road(1, "Country road", Path(Pose(0, 0, EAST)).line(MAIN_M), [country(mark=BROKEN)],
                     speed_kmh=80, kind="rural")
    east = town.road(2, "Country road", Path(MIDDLE * Pose(REACH_M, 0, 0)).line(160),
                     [country(mark=BROKEN)], speed_kmh=80, kind="rural")
    side = town.road(3, "Side road", Path(MIDDLE * Pose(0, -REACH_M, SOUTH)).line(120),
                     [country(mark=BROKEN)], speed_kmh=50, kind="rural")
    junction = town.junction(10, "T-junction")
    into = {1: (leg_end(west), (1, "end"), -1), 2: (incoming(east, 1), (2, "start"), 1),
            3: (incoming(side, 1), (3, "start"), 1)}
    out_of = {1: (leg_end(west).reverse(), (1, "end"), 1), 2: (outgoing(east), (2, "start"), -1),
              3: (outgoing(side), (3, "start"), -1)}
    legs = {1: west, 2: east, 3: side}
    for start in legs:
        for end in legs:
            if start == end:
                continue
            from_pose, (_, from_contact), from_lane = into[start]
            to_pose, (_, to_contact), to_lane = out_of[end]
            through_or_turn(town, junction, (legs[start], from_contact), from_lane,
                            (legs[end], to_contact), to_lane, (from_pose, to_pose))
    west.successor = east.predecessor = side.predecessor = ("junction", junction.id, None)
    town.sign(side, s=1.0, t=5.0, orientation="-", type="206", name="stop", lanes=(1, 1))
    write_map(File(__file__).with_name("country.xodr"), "roadbed country road", CRS,
              town.roads, town.junctions, town.controllers)


if __name__ == "__main__":
    main()
