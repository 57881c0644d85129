"""LAZ files read by roadbed, held against what laspy unpacks: the octrees have to be the same.

Usage: check_laz.py ROADBED FILE.laz…
       check_laz.py --write FOLDER
       check_laz.py --seeds FOLDER

Besides the files, 14 are made, of every point format that laspy packs, with and without extra
bytes, of more points than a chunk has. --write makes the small ones that the tests of
map/occupancy/laz read, whose coordinates follow a formula: format_N.laz, and chunks_N.laz of
several chunks. --seeds makes packed_N.laz of few points, which the fuzz target of LAS begins with.
"""
import io
import json
import pathlib
import subprocess
import sys
import tempfile

import laspy
import lazrs
import numpy

MANY = 130_001
FORMATS = (0, 1, 2, 3, 6, 7, 8)
WAVES = (4, 5, 9, 10)  # only LASzip itself packs these


def formula(count):
    """Coordinates in steps, also in tests/map/occupancy/laz/laz_points_test.cpp."""
    i = numpy.arange(count)
    return 37 * i - i * i % 101, 5000 - 11 * i + i % 7 * 13, i * i * i % 997 - (i % 50 == 0) * 200_000


def scan(count):
    """Coordinates as of a scanner that turns and moves, with noise."""
    random = numpy.random.default_rng(3)
    i = numpy.arange(count)
    radius = 20 + 5 * numpy.sin(i * 3e-4) + random.normal(0, 0.02, count)
    return (1000 * radius * numpy.cos(i * 3e-3)).astype(int), \
        (1000 * radius * numpy.sin(i * 3e-3) + i * 0.1).astype(int), \
        (random.normal(0, 30, count) + i // 1000 % 7 * 500).astype(int)


def made(point_format, steps, extra):
    random = numpy.random.default_rng(point_format)
    count = len(steps[0])
    header = laspy.LasHeader(point_format=point_format, version="1.4" if point_format > 3 else "1.2")
    header.scales = [0.001] * 3
    cloud = laspy.LasData(header)
    cloud.X, cloud.Y, cloud.Z = steps
    cloud.intensity = random.integers(0, 4000, count)
    returns = random.choice([1, 1, 1, 2, 3, 5], count)
    cloud.number_of_returns = returns
    cloud.return_number = numpy.minimum(returns, random.integers(1, 6, count))
    cloud.classification = random.choice([1, 2, 2, 2, 6], count)
    cloud.user_data = random.integers(0, 3, count)
    cloud.point_source_id = numpy.arange(count) // 10_000
    names = cloud.points.array.dtype.names
    if "gps_time" in names:
        steps_s = random.choice([0, 1e-5, 2e-5, 1.0, 1e7, -1e7], count,
                                p=[0.3, 0.5, 0.17, 0.02, 0.005, 0.005])
        cloud.gps_time = numpy.cumsum(steps_s)
    if "red" in names:
        cloud.red = random.integers(0, 65_536, count)
        cloud.green = numpy.where(numpy.arange(count) % 3 == 0, cloud.red,
                                  random.integers(0, 65_536, count))
        cloud.blue = cloud.green // 2
    if point_format >= 6:
        cloud.scanner_channel = random.integers(0, 4, count)
    for name in names:
        if "wave" in name or name in ("x_t", "y_t", "z_t"):
            values = random.integers(0, 200, count).cumsum()
            cloud.points.array[name] = values.astype(cloud.points.array.dtype[name])
    if extra:
        cloud.add_extra_dim(laspy.ExtraBytesParams("amplitude", numpy.float32))
        cloud.amplitude = random.normal(0, 1, count)
    return cloud


def write(folder):
    for point_format in FORMATS + WAVES:
        cloud = made(point_format, formula(300), point_format in (3, 7))
        backend = laspy.LazBackend.Laszip if point_format in WAVES else laspy.LazBackend.Lazrs
        cloud.write(str(folder / f"format_{point_format}.laz"), laz_backend=backend)
    for point_format in (1, 3, 7):
        (folder / f"chunks_{point_format}.laz").write_bytes(
            in_chunks(made(point_format, formula(300), False), 70))


def write_seeds(folder):
    for point_format in FORMATS:
        (folder / f"packed_{point_format}.laz").write_bytes(
            in_chunks(made(point_format, formula(20), point_format in (3, 7)), 7))
    for point_format in WAVES:
        made(point_format, formula(20), False).write(
            str(folder / f"packed_{point_format}.laz"), laz_backend=laspy.LazBackend.Laszip)


def in_chunks(cloud, points):
    """The bytes of a LAZ file whose chunks have so many points, the last one fewer."""
    file = io.BytesIO()
    cloud.write(file, do_compress=True, laz_backend=laspy.LazBackend.Lazrs)
    packed = bytearray(file.getvalue())
    record = packed.index(b"laszip encoded") - 2 + 54
    begin = int.from_bytes(packed[96:100], "little")
    packed[record + 12:record + 16] = points.to_bytes(4, "little")
    out = io.BytesIO()
    out.write(packed[:begin])
    layout = lazrs.LazVlr(bytes(packed[record:record + 34 + 6 * packed[record + 32]]))
    packer = lazrs.LasZipCompressor(out, layout)
    packer.compress_many(cloud.points.array.tobytes())
    packer.done()
    return out.getvalue()


def unpack(file, plain):
    packed = laspy.read(str(file))
    header = laspy.LasHeader(point_format=packed.header.point_format, version=packed.header.version)
    header.scales, header.offsets = packed.header.scales, packed.header.offsets
    header.vlrs.extend(vlr for vlr in packed.vlrs if vlr.user_id != "copc")
    header.global_encoding = packed.header.global_encoding
    cloud = laspy.LasData(header)
    cloud.points = packed.points
    cloud.write(str(plain))


def what_is_read(program, cloud, folder):
    """Count and bounds of a cloud, and its octree unless it is in degrees."""
    info = json.loads(subprocess.run([program, "occupancy", "info", cloud, "--json"],
                                     capture_output=True, text=True, check=True).stdout)
    octree = folder / "out.bt"
    if info["unit"] != "degrees":
        subprocess.run([program, "--quiet", "occupancy", "build", cloud, "-o", octree, "--force",
                        "--resolution", "0.2"], check=True)
    return [info["points"], info["bounds"],
            octree.read_bytes() if info["unit"] != "degrees" else None]


def main():
    if sys.argv[1] in ("--write", "--seeds"):
        return {"--write": write, "--seeds": write_seeds}[sys.argv[1]](pathlib.Path(sys.argv[2]))
    program, files = sys.argv[1], [pathlib.Path(file) for file in sys.argv[2:]]
    same, wrong, unread = 0, [], []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for point_format in FORMATS:
            for extra in (False, True):
                file = folder / f"made_{point_format}{'_extra' if extra else ''}.laz"
                made(point_format, scan(MANY), extra).write(str(file))
                files.append(file)
        for file in files:
            plain = folder / "plain.las"
            try:
                unpack(file, plain)
            except BaseException as error:  # its Rust part panics  pylint: disable=broad-except
                unread.append(f"{file.name}: laspy cannot read it: {error}")
                continue
            packed, unpacked = (what_is_read(program, cloud, folder) for cloud in (file, plain))
            if packed == unpacked:
                same += 1
            else:
                wrong.append(f"{file.name}: {packed[:2]}, not {unpacked[:2]}, or the octrees differ")
    for line in unread + wrong:
        print(line)
    print(f"LAZ: {same} files as laspy unpacks them, {len(wrong)} not, {len(unread)} it cannot read")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
