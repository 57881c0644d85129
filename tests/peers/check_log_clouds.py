"""Usage: check_log_clouds.py ROADBED [ARGOVERSE_SWEEP.feather] [CLOUD.pcd…]
Writes bags of clouds by rosbags (SQLite, packed by message and by file; MCAP, plain and with
Zstandard) as PointCloud2 of several layouts, with poses as transforms or odometry, and holds what
ROADBED makes of them against the same points in files of their own: count and bounds as numbers of
double precision, and octrees byte for byte. Points are those of the sweeps and clouds named, and of
a scanner made here. Exit status 1 where they differ.
"""

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
CLOUD, ODOMETRY, TRANSFORMS = "sensor_msgs/msg/PointCloud2", "nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage"
START_NS, STEP_NS, SWEEPS = 1_700_000_000_123_456_789, 100_000_000, 4
KINDS = {
    "sqlite": (StoragePlugin.SQLITE3, None),
    "sqlite_message": (StoragePlugin.SQLITE3, CompressionMode.MESSAGE),
    "sqlite_file": (StoragePlugin.SQLITE3, CompressionMode.FILE),
    "mcap": (StoragePlugin.MCAP, None),
    "mcap_zstd": (StoragePlugin.MCAP, CompressionMode.STORAGE),
}
TYPES = {"i1": 1, "u1": 2, "i2": 3, "u2": 4, "i4": 5, "u4": 6, "f4": 7, "f8": 8}
# Fields of a point as numpy has them: order of bytes, offsets and what is between.
LAYOUTS = {
    "xyz": np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4")]),
    "pcl": np.dtype({"names": ["x", "y", "z", "intensity"], "formats": ["<f4"] * 4,
                     "offsets": [0, 4, 8, 16], "itemsize": 32}),
    "big": np.dtype({"names": ["ring", "z", "y", "x"], "formats": [">u2", ">f4", ">f4", ">f4"],
                     "offsets": [1, 5, 9, 13], "itemsize": 19}),
    "double": np.dtype([("x", "<f8"), ("y", "<f8"), ("z", "<f8")]),
}


def make(kind, **fields):
    return STORE.types[kind](**fields)


def header(t, frame):
    stamp = make("builtin_interfaces/msg/Time", sec=t // 10**9, nanosec=t % 10**9)
    return make("std_msgs/msg/Header", stamp=stamp, frame_id=frame)


def vector(kind, x, y, z):
    return make(f"geometry_msgs/msg/{kind}", x=x, y=y, z=z)


def pose_at(t):
    """Of base_link in map: place and heading."""
    heading = 0.4 * (t - START_NS) / 1e9
    return 432_100.3 + 40 * math.sin(heading), -17.7 - 40 * math.cos(heading), 3.0, heading


def turned(heading):
    return make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=math.sin(heading / 2), w=math.cos(heading / 2))


def odometry(t):
    x, y, z, heading = pose_at(t)
    pose = make("geometry_msgs/msg/Pose", position=vector("Point", x, y, z), orientation=turned(heading))
    twist = make("geometry_msgs/msg/Twist", linear=vector("Vector3", 16.0, 0.0, 0.0),
                 angular=vector("Vector3", 0.0, 0.0, 0.4))
    return make(ODOMETRY, header=header(t, "map"), child_frame_id="base_link",
                pose=make("geometry_msgs/msg/PoseWithCovariance", pose=pose, covariance=np.zeros(36)),
                twist=make("geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=np.zeros(36)))


def transforms(t):
    x, y, z, heading = pose_at(t)
    moved = make("geometry_msgs/msg/Transform", translation=vector("Vector3", x, y, z), rotation=turned(heading))
    return make(TRANSFORMS, transforms=[make("geometry_msgs/msg/TransformStamped", header=header(t, "map"),
                                             child_frame_id="base_link", transform=moved)])


def cloud(t, points, layout, rows=1):
    """PointCloud2 of points in rows with 7 bytes behind each."""
    table = np.zeros(len(points), dtype=layout)
    for i, axis in enumerate("xyz"):
        table[axis] = points[:, i]
    width, padding = len(points) // rows, 7 if rows > 1 else 0
    data = b"".join(table[i * width:(i + 1) * width].tobytes() + b"\xff" * padding for i in range(rows))
    fields = [make("sensor_msgs/msg/PointField", name=name, offset=layout.fields[name][1],
                   datatype=TYPES[layout.fields[name][0].str[1:]], count=1) for name in layout.names]
    return make(CLOUD, header=header(t, "base_link"), height=rows, width=width, fields=fields,
                is_bigendian=layout["x"].str[0] == ">", point_step=layout.itemsize,
                row_step=width * layout.itemsize + padding, data=np.frombuffer(data, np.uint8), is_dense=False)


def write(folder, kind, sweeps, layout, poses):
    storage, packing = KINDS[kind]
    writer = Writer(folder, version=9, storage_plugin=storage)
    if packing is not None:
        writer.set_compression(packing, CompressionFormat.ZSTD)
    with writer:
        points = writer.add_connection("/points", CLOUD, typestore=STORE)
        source = {"odometry": (ODOMETRY, odometry), "transforms": (TRANSFORMS, transforms)}.get(poses)
        if source:
            topic = writer.add_connection("/poses" if source[0] == ODOMETRY else "/tf", source[0], typestore=STORE)
        for i, sweep in enumerate(sweeps):
            t = START_NS + STEP_NS * i
            writer.write(points, t, STORE.serialize_cdr(cloud(t, sweep, layout, rows=1 + i % 2), CLOUD))
            if source:
                writer.write(topic, t, STORE.serialize_cdr(source[1](t), source[0]))


def run(program, *words):
    done = subprocess.run([program, *words], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, words))}: {done.stderr.strip()}")
    return done.stdout


def info(program, file):
    found = json.loads(run(program, "occupancy", "info", file, "--json"))
    return found["points"], found["bounds"]


def octree(program, folder, *words):
    run(program, "--quiet", "occupancy", "build", *words, "-o", folder / "out.bt", "--force")
    return (folder / "out.bt").read_bytes()


def write_pcd(file, points):
    head = ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
            f"WIDTH {len(points)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(points)}\nDATA binary\n")
    file.write_bytes(head.encode() + points.astype("<f4").tobytes())


def bounds_of(points):
    points = points.astype(np.float64)
    return {f"{end}_{axis}_m": float(getattr(points[:, i], end)())
            for end in ("min", "max") for i, axis in enumerate("xyz")}


def faults_of(program, folder, sweeps):
    files = [folder / f"{i}.pcd" for i in range(len(sweeps))]
    for file, sweep in zip(files, sweeps):
        write_pcd(file, sweep)
    poses = folder / "poses.txt"
    lines = []
    for i in range(len(sweeps)):
        x, y, z, heading = pose_at(START_NS + STEP_NS * i)
        lines.append(f"{i} {x!r} {y!r} {z!r} 0 0 {math.sin(heading / 2)!r} {math.cos(heading / 2)!r}\n")
    poses.write_text("".join(lines))
    standing, placed = octree(program, folder, *files), octree(program, folder, *files, "--poses", poses)
    expected = sum(map(len, sweeps)), bounds_of(np.concatenate(sweeps))
    for kind in KINDS:
        for name, layout in LAYOUTS.items():
            if kind != "mcap" and name not in ("xyz", "big"):
                continue
            for source in ("", "odometry", "transforms"):
                bag = folder / f"{kind}_{name}_{source}"
                write(bag, kind, sweeps, layout, source)
                if not source and info(program, bag) != expected:
                    yield f"{bag.name}: {info(program, bag)}, not {expected}"
                if octree(program, folder, bag) != (placed if source else standing):
                    yield f"{bag.name}: another octree than that of the files"


def scanner():
    """Sweeps of a scanner of 16 rings, an even number of points each."""
    random = np.random.default_rng(26)
    turns = np.linspace(0, 2 * np.pi, 900, endpoint=False)
    rises = np.linspace(-0.3, 0.2, 16)
    turn, rise = (grid.ravel() for grid in np.meshgrid(turns, rises))
    for _ in range(SWEEPS):
        reach = 15 + 5 * np.sin(3 * turn) + random.normal(0, 0.02, turn.size)
        yield np.stack([reach * np.cos(turn) * np.cos(rise), reach * np.sin(turn) * np.cos(rise),
                        reach * np.sin(rise)], axis=1).astype(np.float32)


def real(file):
    if file.suffix == ".feather":
        from pyarrow import feather
        table = feather.read_table(str(file), memory_map=False)
        points = np.stack([table[axis].to_numpy().astype(np.float32) for axis in "xyz"], axis=1)
    else:
        head, body = file.read_text().split("DATA ascii\n", 1)
        names = head.split("FIELDS ", 1)[1].split("\n", 1)[0].split()
        points = np.array([line.split() for line in body.splitlines()], np.float32)
        points = points[:, [names.index(axis) for axis in "xyz"]]
    points = points[np.isfinite(points).all(axis=1)]
    return points[:len(points) // 2 * 2]


def main():
    program, files = sys.argv[1], [Path(file) for file in sys.argv[2:]]
    cases = {"made": list(scanner())}
    for file in files:
        cases[file.name] = [real(file)] * 2
    status = 0
    for name, sweeps in cases.items():
        with tempfile.TemporaryDirectory() as folder:
            for fault in faults_of(program, Path(folder), sweeps):
                print(f"{name}, {fault}")
                status = 1
    print(f"clouds of logs: {len(cases)} drives in {len(KINDS)} kinds of bags: "
          + ("equal" if status == 0 else "different"))
    return status


sys.exit(main())
