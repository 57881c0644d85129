#!/usr/bin/env python3
"""Makes argoverse_log/, a sensor log as Argoverse 2 has them: an invented street, what a scanner on
a car sees while it drives along it, and the boxes of the others. Usage: data/make_argoverse_log.py

Needs numpy and pyarrow. Same seed and same pyarrow, same bytes.

The street runs east and rises by 2 %. The ego keeps its lane at 8 m/s for 5 s, behind a car of the
same speed; one comes the other way, one has parked with two wheels on the ego's lane's edge, others
stand in the bays behind the kerb; houses and trees line both sides. Five sweeps are 0.2 s apart.
"""

import json
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.feather

FOLDER = Path(__file__).parent / "argoverse_log"
START_NS = 1_700_000_000_000_000_000
X0, Y0, Z0, SLOPE = 1000.0, 2000.0, 30.0, 0.02  # of the city; the street runs along y = Y0
LENGTH, LANE, SPEED, SECONDS = 120.0, 3.5, 8.0, 5.0
SCANNER = np.array([1.3, 0.0, 1.9])  # in the frame of the rear axle, which is 0.35 m above the road
AXLE_HEIGHT = 0.35
SWEEPS = (1.6, 1.8, 2.0, 2.2, 2.4)  # s
REACH = 60.0
ELEVATIONS = np.radians(np.concatenate([np.arange(-24, -6, 2.0), np.arange(-6, 6.1, 0.75)]))
AZIMUTHS = np.radians(np.arange(-180, 180, 0.6))
NOISE = 0.015  # m

# name, category, x and y at time 0, heading, speed, length, width, height
OTHERS = (
    ("ahead", "REGULAR_VEHICLE", 36.0, -1.75, 0.0, 8.0, 4.6, 1.85, 1.5),
    ("oncoming", "REGULAR_VEHICLE", 82.0, 1.75, np.pi, 11.0, 4.4, 1.8, 1.45),
    ("parked badly", "REGULAR_VEHICLE", 40.0, -4.15, 0.04, 0.0, 4.5, 1.8, 1.5),
    ("in a bay", "REGULAR_VEHICLE", 22.0, -5.0, 0.0, 0.0, 4.2, 1.75, 1.5),
    ("van in a bay", "BOX_TRUCK", 54.0, 5.1, np.pi, 0.0, 6.4, 2.1, 2.7),
    ("walker", "PEDESTRIAN", 46.0, 7.6, 0.0, 1.4, 0.6, 0.6, 1.75),
)
# x, y, length, width, height
THINGS = tuple(
    [(x, side * 13.0, 14.0, 6.0, 8.0) for side in (-1, 1) for x in (5.0, 21.0, 37.0, 53.0, 69.0, 85.0)]
    + [(x, side * 8.3, 0.35, 0.35, 6.0) for side in (-1, 1) for x in (12.0, 30.0, 48.0, 66.0, 84.0)]
)


def height(x):
    return Z0 + SLOPE * x


def ego_at(t):
    """Pose of the rear axle in the city: turn about y by the slope, and place."""
    pitch = -np.arctan(SLOPE)
    c, s = np.cos(pitch), np.sin(pitch)
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    x = 10.0 + SPEED * t
    return turn, np.array([X0 + x, Y0 - LANE / 2, height(x) + AXLE_HEIGHT]), (np.cos(pitch / 2), np.sin(pitch / 2))


def others_at(t):
    for name, category, x, y, heading, speed, length, width, high in OTHERS:
        x, y = x + speed * t * np.cos(heading), y + speed * t * np.sin(heading)
        yield name, category, np.array([X0 + x, Y0 + y, height(x) + high / 2 + 0.02]), heading, np.array([length, width, high])


def distances_to_box(origin, rays, centre, heading, size):
    """Where rays enter an upright box; infinite where they miss."""
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    start, steps = turn @ (origin - centre), rays @ turn.T
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = (-size / 2 - start) / steps, (size / 2 - start) / steps
    near, far = np.minimum(a, b).max(axis=1), np.maximum(a, b).min(axis=1)
    return np.where((near <= far) & (near > 0), near, np.inf)


def sweep(t, random):
    turn, place, _ = ego_at(t)
    origin = place + turn @ SCANNER
    azimuth, elevation = (grid.ravel() for grid in np.meshgrid(AZIMUTHS, ELEVATIONS))
    rays = np.stack([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)], 1)
    rays = rays @ turn.T
    down = rays[:, 2] - SLOPE * rays[:, 0]
    above = origin[2] - height(origin[0] - X0)
    nearest = np.where(down < 0, above / -np.minimum(down, -1e-9), np.inf)
    bodies = [(centre, heading, size - [0, 0, 0.3], 0.15) for _, _, centre, heading, size in others_at(t)]
    bodies += [(np.array([X0 + x, Y0 + y, height(x) + h / 2]), 0.0, np.array([l, w, h]), 0.0) for x, y, l, w, h in THINGS]
    for centre, heading, size, lift in bodies:  # cars are open below
        nearest = np.minimum(nearest, distances_to_box(origin, rays, centre + [0, 0, lift], heading, size))
    hit = nearest < REACH
    points = origin + rays[hit] * (nearest[hit] + random.normal(0, NOISE, hit.sum()))[:, None]
    return ((points - place) @ turn).astype(np.float16), np.repeat(np.arange(len(ELEVATIONS)), len(AZIMUTHS))[hit]


def write(name, columns):
    path = FOLDER / name
    path.parent.mkdir(parents=True, exist_ok=True)
    pyarrow.feather.write_feather(pa.table(columns), path, compression="zstd", compression_level=19)


def points(xs, y):
    return [{"x": X0 + x, "y": Y0 + y, "z": round(height(x), 3)} for x in xs]


def write_map():
    xs = (0.0, LENGTH / 2, LENGTH)
    lanes = {}
    for lane, (left, right, order) in {1: (0.0, -LANE, 1), 2: (0.0, LANE, -1)}.items():
        lanes[str(lane)] = {
            "id": lane, "is_intersection": False, "lane_type": "VEHICLE",
            "left_lane_boundary": points(xs[::order], left), "left_lane_mark_type": "DASHED_YELLOW",
            "right_lane_boundary": points(xs[::order], right), "right_lane_mark_type": "NONE",
            "successors": [], "predecessors": [], "left_neighbor_id": None, "right_neighbor_id": None,
        }  # fmt: skip
    area = points((0.0, LENGTH), -LANE) + points((LENGTH, 0.0), LANE)
    document = {"lane_segments": lanes, "pedestrian_crossings": {}, "drivable_areas": {"1": {"id": 1, "area_boundary": area}}}
    path = FOLDER / "map" / "log_map_archive_made____PIT_city_1.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(document, indent=1) + "\n")


def main():
    random = np.random.default_rng(20261126)
    write_map()
    times = np.arange(0, SECONDS + 1e-9, 0.05)
    poses = [ego_at(t) for t in times]
    stamps = [START_NS + round(t * 1e9) for t in times]
    none = [0.0] * len(times)
    write("city_SE3_egovehicle.feather", {
        "timestamp_ns": pa.array(stamps, pa.int64()),
        "qw": [pose[2][0] for pose in poses], "qx": none, "qy": [pose[2][1] for pose in poses], "qz": none,
        **{f"t{axis}_m": [pose[1][i] for pose in poses] for i, axis in enumerate("xyz")},
    })  # fmt: skip
    write("calibration/egovehicle_SE3_sensor.feather", {
        "sensor_name": ["up_lidar", "down_lidar"], "qw": [1.0, 0.0], "qx": [0.0, 1.0], "qy": [0.0] * 2, "qz": [0.0] * 2,
        **{f"t{axis}_m": [SCANNER[i]] * 2 for i, axis in enumerate("xyz")},
    })  # fmt: skip
    rows = []
    for t in times[::2]:
        turn, place, _ = ego_at(t)
        for name, category, centre, heading, size in others_at(t):
            at = turn.T @ (centre - place)
            rows.append((START_NS + round(t * 1e9), name, category, *size, np.cos(heading / 2), 0.0, 0.0, np.sin(heading / 2), *at))
    names = ("timestamp_ns", "track_uuid", "category", "length_m", "width_m", "height_m", "qw", "qx", "qy", "qz", "tx_m", "ty_m", "tz_m")
    columns = {name: pa.array(values) for name, values in zip(names, zip(*rows))}
    columns["num_interior_pts"] = pa.array([0] * len(rows), pa.int64())
    write("annotations.feather", columns)
    for t in SWEEPS:
        xyz, laser = sweep(t, random)
        write(f"sensors/lidar/{START_NS + round(t * 1e9)}.feather", {
            **{axis: pa.array(xyz[:, i]) for i, axis in enumerate("xyz")},
            "intensity": pa.array(np.zeros(len(xyz), np.uint8)), "laser_number": pa.array(laser.astype(np.uint8)),
            "offset_ns": pa.array(np.zeros(len(xyz), np.int32)),
        })  # fmt: skip


if __name__ == "__main__":
    main()
