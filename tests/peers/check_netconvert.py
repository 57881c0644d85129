#!/usr/bin/env python3
"""Exports maps to OpenDRIVE and has SUMO's netconvert read what was written.

Usage: check_netconvert.py ROADBED MAP...      needs the PyPI package eclipse-sumo

An OpenDRIVE map is compiled first, as it would come back as it stands otherwise. Of every road outside
junctions, each side must have as many driving lanes in the net as in the file, where it has most.
Prints a row per map; exit status 1 if a lane is missing.
"""
import collections
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

NETCONVERT = pathlib.Path(sys.executable).parent / "netconvert"


def lanes_written(file):
    """By road and side, the most driving lanes of a section."""
    most = collections.Counter()
    for road in xml.parse(file).getroot().iter("road"):
        if road.get("junction") != "-1":
            continue
        for section in road.iter("laneSection"):
            for side in ("left", "right"):
                count = sum(lane.get("type") == "driving" for lane in section.iterfind(f"{side}/lane"))
                if count:
                    most[road.get("id"), side] = max(most[road.get("id"), side], count)
    return most


def lanes_read(file):
    """The same of the net, where an edge of right lanes has a minus before its road's id."""
    most = collections.Counter()
    for edge in xml.parse(file).getroot().iterfind("edge"):
        if edge.get("function") == "internal":
            continue
        minus, road = re.match(r"(-?)([^.#]*)", edge.get("id")).groups()
        key = road, "right" if minus else "left"
        most[key] = max(most[key], len(edge.findall("lane")))
    return most


def check(roadbed, path, scratch):
    def run(*words):
        subprocess.run([str(word) for word in words], check=True, capture_output=True)

    source, out, net = path, scratch / "map.xodr", scratch / "map.net.xml"
    if path.endswith(".xodr"):
        source = scratch / "map.rbm"
        run(roadbed, "import", path, "-o", source, "--force")
    run(roadbed, "export", source, "-o", out, "--force")
    run(NETCONVERT, "--opendrive-files", out, "-o", net)
    written, read = lanes_written(out), lanes_read(net)
    missing = {key: count - read[key] for key, count in written.items() if count > read[key]}
    print(f"{'BAD' if missing else 'ok '} {pathlib.Path(path).name}: {len(written)} sides of roads, "
          f"{sum(written.values())} lanes, {sum(missing.values())} not in the net")
    for (road, side), count in list(missing.items())[:3]:
        print(f"    road {road}, {side}: {count} of {written[road, side]}")
    return not missing


def main():
    roadbed, *paths = sys.argv[1:]
    with tempfile.TemporaryDirectory() as scratch:
        fine = [check(roadbed, path, pathlib.Path(scratch)) for path in paths]
    return 0 if all(fine) else 1


if __name__ == "__main__":
    sys.exit(main())
