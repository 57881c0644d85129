"""Usage: check_filters.py ROADBED [FILE.las|FILE.laz…]
Points that ROADBED keeps by class, return and intensity, held against laspy's: as many, within the
same bounds. Besides the files, those that check_laz.py makes are looked at, packed and plain.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import check_laz
import laspy
import numpy


def made(folder):
    for point_format in check_laz.FORMATS:
        for suffix in ("las", "laz"):
            file = folder / f"made_{point_format}.{suffix}"
            check_laz.made(point_format, check_laz.scan(check_laz.MANY), point_format % 2 == 0).write(str(file))
            yield file


def questions(cloud):
    """Options, and the points that they keep."""
    classes, intensity = numpy.asarray(cloud.classification).astype(int), numpy.asarray(cloud.intensity).astype(int)
    number, returns = numpy.asarray(cloud.return_number), numpy.asarray(cloud.number_of_returns)
    most, middle = int(numpy.bincount(classes).argmax()), int(numpy.median(intensity))
    yield ["--classes", str(most)], classes == most
    yield ["--without-classes", str(most)], classes != most
    yield ["--intensity", f"{middle},65535"], intensity >= middle
    yield ["--returns", "first"], number == 1
    yield ["--returns", "last"], number == returns
    yield ["--returns", "2,3"], (number == 2) | (number == 3)
    yield ["--classes", str(most), "--intensity", f"0,{middle}"], (classes == most) & (intensity <= middle)


def fault_of(program, file, options, x_kept):
    run = subprocess.run([program, "occupancy", "info", file, "--json", *options], capture_output=True,
                         text=True, check=True)
    info = json.loads(run.stdout)
    if info["points"] != len(x_kept):
        return f"{info['points']} points, not {len(x_kept)}"
    if len(x_kept) == 0:
        return ""
    off = max(abs(info["bounds"]["min_x_m"] - x_kept.min()), abs(info["bounds"]["max_x_m"] - x_kept.max()))
    return f"bounds are off by {off}" if off > 0.01 else ""


def main():
    program, count, faults = sys.argv[1], 0, []
    with tempfile.TemporaryDirectory() as name:
        for file in [*made(pathlib.Path(name)), *map(pathlib.Path, sys.argv[2:])]:
            try:
                cloud = laspy.read(str(file))
            except BaseException as error:  # its Rust part panics  pylint: disable=broad-except
                print(f"{file.name}: laspy cannot read it: {error}")
                continue
            for options, kept in questions(cloud):
                count += 1
                if fault := fault_of(program, file, options, numpy.asarray(cloud.x)[kept]):
                    faults.append(f"{file.name} {' '.join(options)}: {fault}")
    for fault in faults:
        print(fault)
    print(f"filters: {count} questions, {len(faults)} not answered as laspy does")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
