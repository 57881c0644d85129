#!/usr/bin/env python3
"""Reads back what roadbed exports with GDAL (pyogrio) and judges it with GEOS (shapely).

usage: check_exports.py ROADBED MAP...      needs the PyPI packages pyogrio and shapely

Per map: each layer of the GeoPackage opens, has a style, and every shape is valid; FlatGeobuf and
GeoPackage hold the same lanes, which GDAL finds by their spatial indexes; an independent union of the lanes has the area of the roads,
junctions and drivable surface; two exports have the same bytes. One line per map, exit status 1 if
anything is wrong."""
import json
import sqlite3
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import pyogrio
import shapely

# What welding within 1 mm may change along the outlines of a surface, on either side.
WELD_M = 2e-3


def read(file, layer=None):
    meta, _, shapes, columns = pyogrio.raw.read(file, layer=layer)
    return shapely.from_wkb(shapes), dict(zip(meta["fields"], columns))


def check_layers(package, faults):
    styled = set(pyogrio.raw.read(package, layer="layer_styles")[3][2])
    for name, kind in pyogrio.list_layers(package):
        if kind is None:
            continue
        shapes, _ = read(package, name)
        bad = shapes[~shapely.is_valid(shapes)]
        bad = bad[bad != None]  # noqa: E711 (an array of shapes)
        if len(bad):
            faults.append(f"{name}: {len(bad)} not valid: {shapely.is_valid_reason(bad[0])}")
        if name not in styled:
            faults.append(f"{name}: has no style")


def compare_area(what, ours, lanes, faults):
    """A union by GEOS: it closes hairline gaps by a grid, as welding does."""
    union = shapely.union_all(shapely.set_precision(lanes, 1e-4), grid_size=1e-4)
    allowed = WELD_M * union.length + 1e-6
    found = shapely.area(ours).sum()
    if abs(found - union.area) > allowed:
        faults.append(f"{what}: {found:.4f} m², GEOS has {union.area:.4f} m²")


def check_surfaces(package, faults):
    lanes, columns = read(package, "lanes")
    drivable = [kind in ("driving", "bidirectional", "entry", "exit", "onRamp", "offRamp",
                         "connectingRamp") for kind in columns["type"]]
    compare_area("drivable_surface", read(package, "drivable_surface")[0], lanes[drivable], faults)
    names = {name for name, _ in pyogrio.list_layers(package)}
    if "roads" in names:
        roads, of_roads = read(package, "roads")
        for road, shape in list(zip(of_roads["road"], roads))[:60]:
            if shape is not None:
                compare_area(f"road {road}", shape, lanes[columns["road"] == road], faults)
    if "junctions" in names:
        junctions, of_junctions = read(package, "junctions")
        for junction, shape in zip(of_junctions["junction"], junctions):
            inside = (columns["junction"] == junction) & drivable
            if shape is not None:
                compare_area(f"junction {junction}", shape, lanes[inside], faults)


def check_index(file, layer, shapes, faults):
    """GDAL sees the index, and finds by it what is in a box."""
    suffix = Path(file).suffix
    if pyogrio.read_info(file, layer=layer)["capabilities"]["fast_spatial_filter"] is not True:
        faults.append(f"GDAL does not see the index of {suffix}")
    box = tuple(shapes[0].bounds)
    found = pyogrio.raw.read(file, layer=layer, bbox=box)[2]
    expected = sum(s is not None and s.intersects(shapely.box(*box)) for s in shapes)
    if len(found) != expected:
        faults.append(f"a box of {suffix} holds {len(found)} lanes, {expected} expected")


def check_changes(package, faults):
    """The triggers keep the index right when features change; returns nothing, spoils the file."""
    database = sqlite3.connect(package)
    database.create_function("ST_IsEmpty", 1, lambda blob: 0)
    for i, name in enumerate(("ST_MinX", "ST_MaxX", "ST_MinY", "ST_MaxY")):
        side = 8 + 8 * i  # of the envelope behind the header
        database.create_function(
            name, 1, lambda blob, at=side: struct.unpack_from("<d", blob, at)[0])
    database.execute("update lanes set fid = 1000000 where fid = 1")
    database.execute("update lanes set geom = null where fid = 2")
    database.execute("delete from lanes where fid = 3")
    left = {row[0] for row in database.execute("select fid from lanes where geom notnull")}
    if left != {row[0] for row in database.execute("select id from rtree_lanes_geom")}:
        faults.append("the index of .gpkg is not kept when lanes change")
    database.close()


def check(roadbed, map_file, folder):
    faults = []
    outputs = {suffix: str(folder / f"map{suffix}") for suffix in (".gpkg", ".fgb", ".geojson")}
    for output in outputs.values():
        subprocess.run([roadbed, "export", map_file, "-o", output, "--quiet"], check=True)
    again = str(folder / "again.gpkg")
    subprocess.run([roadbed, "export", map_file, "-o", again, "--quiet"], check=True)
    if Path(again).read_bytes() != Path(outputs[".gpkg"]).read_bytes():
        faults.append("two exports differ")
    check_layers(outputs[".gpkg"], faults)
    check_surfaces(outputs[".gpkg"], faults)
    of_package, of_flat = read(outputs[".gpkg"], "lanes"), read(outputs[".fgb"])
    by_name = dict(zip(of_flat[1]["lane"], of_flat[0]))
    for name, shape in zip(of_package[1]["lane"], of_package[0]):
        if shape is not None and not shapely.equals_exact(by_name.get(name), shape):
            faults.append(f"lane {name} differs between .gpkg and .fgb")
    check_index(outputs[".fgb"], None, of_package[0], faults)
    check_index(outputs[".gpkg"], "lanes", of_package[0], faults)
    check_changes(outputs[".gpkg"], faults)
    json.loads(Path(outputs[".geojson"]).read_text())
    return faults, len(of_package[0])


def main():
    roadbed, files = sys.argv[1], sys.argv[2:]
    wrong = False
    for file in files:
        with tempfile.TemporaryDirectory() as folder:
            faults, lanes = check(roadbed, file, Path(folder))
        print(f"{Path(file).name}: {lanes} lanes, " + ("; ".join(faults[:8]) or "as GDAL reads it"))
        wrong = wrong or bool(faults)
    sys.exit(wrong)


if __name__ == "__main__":
    main()
