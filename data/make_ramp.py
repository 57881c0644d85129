#!/usr/bin/env python3
"""Makes ramp.xodr, a road of two lanes of one direction that a ramp joins without a lane of its own,
and that goes on with one of them later.
Usage: data/make_ramp.py

    1: 300 m, two lanes    junction 10    2: 300 m, two lanes      3: 300 m, one lane
    -----------------------------------------------------+
    ----------------------------------------------------- \\-----------------------
                         /
          4: 150 m  ----
"""

from math import radians
from pathlib import Path as File

from make_town import CRS, EAST, Town, join
from opendrive import BROKEN, SOLID, Lane, Section, write_map
from plan_view import Path, Pose

BEFORE_M, JUNCTION_M, BETWEEN_M, AFTER_M, RAMP_M = 300.0, 60.0, 300.0, 300.0, 150.0
LANE_M, RAMP_ANGLE = 3.5, radians(8)


def lanes(*keys):
    return Section(0.0, [], [Lane(key, mark=SOLID if key == keys[-1] else BROKEN) for key in keys],
                   SOLID)


def main():
    town = Town()
    before = town.road(1, "Bypass", Path(Pose(0, 0, EAST)).line(BEFORE_M), [lanes("A", "B")],
                       speed_kmh=70, kind="rural")
    between = town.road(2, "Bypass", Path(Pose(BEFORE_M + JUNCTION_M, 0, EAST)).line(BETWEEN_M),
                        [lanes("A", "B")], speed_kmh=70, kind="rural")
    after = town.road(3, "Bypass", Path(Pose(BEFORE_M + JUNCTION_M + BETWEEN_M, 0, EAST))
                      .line(AFTER_M), [lanes("A")], speed_kmh=70, kind="rural")
    # The ramp's reference line is its left edge, which ends at the road's right edge.
    ramp_end = Pose(BEFORE_M, -2 * LANE_M - 4.0, RAMP_ANGLE)
    ramp = town.road(4, "Ramp", Path(ramp_end * Pose(-RAMP_M, 0, 0)).line(RAMP_M), [lanes("B")],
                     speed_kmh=70, kind="rural")
    junction = town.junction(10, "Ramp joins")
    start = Pose(BEFORE_M, 0, EAST)
    town.connect(junction, (before, "end"), (between, "start"),
                 Path(start).line(JUNCTION_M), [(Lane("A", mark=BROKEN), -1, -1),
                                                (Lane("B"), -2, -2)], 70, "rural")
    onto = Pose(BEFORE_M + JUNCTION_M, -LANE_M, EAST)
    town.connect(junction, (ramp, "end"), (between, "start"),
                 Path(ramp_end).turn_to(onto), [(Lane("B"), -1, -2)], 70, "rural")
    before.successor = ramp.successor = between.predecessor = ("junction", junction.id, None)
    join(between, after)
    write_map(File(__file__).with_name("ramp.xodr"), "roadbed ramp", CRS,
              town.roads, town.junctions, town.controllers)


if __name__ == "__main__":
    main()
