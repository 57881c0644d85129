"""Usage: compare_logs.py ROADBED
Writes bags of known drives by rosbags (SQLite; packed by message and by file; MCAP, plain and with
Zstandard) and looks at what ROADBED reads in them: places bit for bit, times and headings to within
a nanosecond and 1e-12 rad. Exit status 1 where they differ.
"""

import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_HUMBLE)
ODOMETRY, TRANSFORMS = "nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage"
START_NS, STEP_NS, COUNT = 1_700_000_000_123_456_789, 50_000_000, 400
KINDS = {
    "sqlite": (StoragePlugin.SQLITE3, None),
    "sqlite_message": (StoragePlugin.SQLITE3, CompressionMode.MESSAGE),
    "sqlite_file": (StoragePlugin.SQLITE3, CompressionMode.FILE),
    "mcap": (StoragePlugin.MCAP, None),
    "mcap_zstd": (StoragePlugin.MCAP, CompressionMode.STORAGE),
}


def make(kind, **fields):
    return STORE.types[kind](**fields)


def drive(i):
    heading = 0.01 * i
    return 432_100.3 + 40 * math.sin(heading), -17.7 - 40 * math.cos(heading), heading


def header(i):
    t = START_NS + STEP_NS * i
    stamp = make("builtin_interfaces/msg/Time", sec=t // 10**9, nanosec=t % 10**9)
    return make("std_msgs/msg/Header", stamp=stamp, frame_id="map")


def turned(heading):
    return make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=math.sin(heading / 2), w=math.cos(heading / 2))


def odometry(i):
    x, y, heading = drive(i)
    pose = make("geometry_msgs/msg/Pose", position=make("geometry_msgs/msg/Point", x=x, y=y, z=3.0),
                orientation=turned(heading))
    zero = make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0)
    twist = make("geometry_msgs/msg/Twist", linear=make("geometry_msgs/msg/Vector3", x=8.0, y=0.0, z=0.0),
                 angular=zero)
    return make(ODOMETRY, header=header(i), child_frame_id="base_link",
                pose=make("geometry_msgs/msg/PoseWithCovariance", pose=pose, covariance=np.zeros(36)),
                twist=make("geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=np.zeros(36)))


def transforms(i):
    x, y, heading = drive(i)
    place = make("geometry_msgs/msg/Vector3", x=x, y=y, z=3.0)
    transform = make("geometry_msgs/msg/Transform", translation=place, rotation=turned(heading))
    return make(TRANSFORMS, transforms=[make("geometry_msgs/msg/TransformStamped", header=header(i),
                                             child_frame_id="base_link", transform=transform)])


def write(folder, storage, packing):
    writer = Writer(folder, version=9, storage_plugin=storage)
    if packing is not None:
        writer.set_compression(packing, CompressionFormat.ZSTD)
    with writer:
        topics = [(writer.add_connection("/odometry", ODOMETRY, typestore=STORE), ODOMETRY, odometry),
                  (writer.add_connection("/tf", TRANSFORMS, typestore=STORE), TRANSFORMS, transforms)]
        for i in range(COUNT):
            for connection, kind, message in topics:
                writer.write(connection, START_NS + STEP_NS * i, STORE.serialize_cdr(message(i), kind))


def fault_of(program, bag, topic, folder):
    area = folder / "area.geojson"
    ring = [[0, -1e4], [1e6, -1e4], [1e6, 1e4], [0, 1e4], [0, -1e4]]
    area.write_text(json.dumps({"type": "Polygon", "coordinates": [ring], "crs": None}))
    saved = folder / "saved.csv"
    run = subprocess.run([program, "audit", "--on", f"area:{area}", "--trajectory", bag, "--topic", topic,
                          "--save-drive", saved, "--force", "--quiet"], capture_output=True, text=True)
    if run.returncode not in (0, 1):
        return run.stderr.strip()
    rows = list(csv.DictReader(saved.open()))
    if len(rows) != COUNT:
        return f"{len(rows)} rows"
    for i, row in enumerate(rows):
        x, y, heading = drive(i)
        if float(row["x_m"]) != x or float(row["y_m"]) != y:
            return f"row {i}: {row['x_m']}, {row['y_m']}, not {x}, {y}"
        if abs(float(row["t_s"]) - 1e-9 * STEP_NS * i) > 1e-9:
            return f"row {i}: {row['t_s']} s"
        if abs(float(row["heading_rad"]) - heading) > 1e-12:
            return f"row {i}: {row['heading_rad']} rad, not {heading}"
    return ""


def main():
    program, status = sys.argv[1], 0
    with tempfile.TemporaryDirectory() as name:
        for kind, (storage, packing) in KINDS.items():
            bag = Path(name) / kind
            write(bag, storage, packing)
            for topic in ("/odometry", "/tf"):
                if fault := fault_of(program, bag, topic, Path(name)):
                    print(f"{kind}, {topic}: {fault}")
                    status = 1
    print(f"logs: {len(KINDS)} bags, {COUNT} poses each of two topics: " + ("equal" if status == 0 else "different"))
    return status


sys.exit(main())
