"""Usage: check_objects.py ROADBED [LOG…]   (LOG: a log of Argoverse 2 with sensors/lidar)

Holds the objects that `roadbed occupancy objects` finds in the sweeps of a log against the vehicles
that people have annotated there, read by pandas and pyarrow.

A vehicle counts with 50 points in its annotated box, within 40 m of the ego; two annotations of one
box count once. It is found where one object's box holds 95 % of these points in plan, is at most
twice as large in plan, has its middle within half a metre of the annotated box, and finds no other
vehicle. At least 0.8 of them have to be found, and those that are found in two sweeps by the same id.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

VEHICLES = {
    "ARTICULATED_BUS", "BOX_TRUCK", "BUS", "LARGE_VEHICLE", "REGULAR_VEHICLE", "SCHOOL_BUS",
    "TRUCK", "TRUCK_CAB", "VEHICULAR_TRAILER",
}  # fmt: skip
LEAST_POINTS, REACH_M, SHARE, RECALL = 50, 40.0, 0.95, 0.8
SLACK_M = 1e-3  # points are halves of floats, which the boxes hold to rounding


def rotation(row):
    w, x, y, z = row.qw, row.qx, row.qy, row.qz
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def place(row):
    return np.array([row.tx_m, row.ty_m, row.tz_m])


def inside(points, centre, heading, length, width, slack=0.0):
    """Which points of the plane lie in a rectangle."""
    c, s = np.cos(heading), np.sin(heading)
    apart = points - centre
    along, left = apart @ [c, s], apart @ [-s, c]
    return (abs(along) <= length / 2 + slack) & (abs(left) <= width / 2 + slack)


def vehicles_at(annotations, stamp, ego_points):
    """Annotated vehicles that count, with their points: in the ego's frame."""
    found, boxes = [], set()
    for row in annotations[annotations.timestamp_ns == stamp].itertuples():
        box = tuple(round(value, 2) for value in (*place(row), row.length_m, row.width_m))
        if row.category not in VEHICLES or np.hypot(row.tx_m, row.ty_m) > REACH_M or box in boxes:
            continue
        boxes.add(box)
        own = (ego_points - place(row)) @ rotation(row)
        is_in = (abs(own) <= np.array([row.length_m, row.width_m, row.height_m]) / 2).all(axis=1)
        if is_in.sum() >= LEAST_POINTS:
            found.append((row, ego_points[is_in]))
    return found


def boxes_at(table, t):
    """Every object that is there at a time: id, centre, heading, length, width."""
    boxes = []
    for name, rows in table.groupby("id", sort=False):
        if len(rows) > 1 and not rows.t_s.iloc[0] - 1e-6 <= t <= rows.t_s.iloc[-1] + 1e-6:
            continue
        centre = [np.interp(t, rows.t_s, rows.x_m), np.interp(t, rows.t_s, rows.y_m)]
        heading = np.interp(t, rows.t_s, np.unwrap(rows.heading_rad))
        boxes.append((name, np.array(centre), heading, rows.length_m.max(), rows.width_m.max()))
    return boxes


def check(roadbed, log):
    annotations = pd.read_feather(log / "annotations.feather")
    poses = pd.read_feather(log / "city_SE3_egovehicle.feather").sort_values("timestamp_ns")
    sweeps = sorted((log / "sensors" / "lidar").glob("*.feather"), key=lambda file: int(file.stem))
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "obstacles.csv"
        command = [roadbed, "occupancy", "objects", *map(str, sweeps), "-o", str(output), "--quiet"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        table = pd.read_csv(output)
    counted, recalled, worst, ids = 0, 0, 1.0, {}
    for sweep in sweeps:
        stamp = int(sweep.stem)
        ego_points = pd.read_feather(sweep)[["x", "y", "z"]].to_numpy(np.float64)
        pose = next(poses[poses.timestamp_ns == stamp].itertuples())
        boxes = boxes_at(table, 1e-9 * (stamp - poses.timestamp_ns.iloc[0]))
        taken = set()
        for row, points in vehicles_at(annotations, stamp, ego_points):
            in_city = (points @ rotation(pose).T + place(pose))[:, :2]
            middle = (rotation(pose) @ place(row) + place(pose))[:2]
            front = (rotation(pose) @ rotation(row))[:2, 0]
            heading = np.arctan2(front[1], front[0])
            shares = [inside(in_city, *box[1:], SLACK_M).mean() for box in boxes]
            best = int(np.argmax(shares))
            name, centre, _, length, width = boxes[best]
            is_near = inside(centre[None], middle, heading, row.length_m + 1, row.width_m + 1)[0]
            is_close = length * width <= 2 * row.length_m * row.width_m
            is_found = shares[best] >= SHARE and is_near and is_close and name not in taken
            counted += 1
            if is_found:
                taken.add(name)
                recalled += 1
                worst = min(worst, shares[best])
                ids.setdefault(row.track_uuid, set()).add(name)
            else:
                print(
                    f"  not found: {row.category} {row.track_uuid[:8]} of {len(points)} points at "
                    f"{np.hypot(row.tx_m, row.ty_m):.0f} m, {shares[best]:.2f} of them in {name}, "
                    f"{length:.1f} by {width:.1f} m"
                )
    renamed = sum(len(names) > 1 for names in ids.values())
    print(
        f"{log.name}: {recalled} of {counted} annotated vehicles found in {len(sweeps)} sweeps "
        f"({recalled / counted:.2f}), boxes hold {worst:.3f} of their points at least, "
        f"{renamed} of {len(ids)} changed their ids"
    )
    return recalled >= RECALL * counted and renamed == 0


def main():
    roadbed, *logs = sys.argv[1:]
    logs = [Path(log) for log in logs if (Path(log) / "sensors" / "lidar").is_dir()]
    return 0 if all([check(roadbed, log) for log in logs]) else 1


if __name__ == "__main__":
    sys.exit(main())
