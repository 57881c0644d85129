#!/usr/bin/env python3
"""Reads back what `roadbed occupancy export` writes with GDAL (rasterio, pyogrio).

usage: check_occupancy_exports.py ROADBED      needs the packages of requirements.txt

A cloud of random points becomes an octree in systems that have an EPSG code, that have none, and in
none; its cells are counted here, by numpy. GeoTIFF: place, system, names of bands, and every number
of every band. GeoJSON, GeoPackage and FlatGeobuf: rectangles that do not overlap, with the volume of
all cells, which GDAL and PROJ see in the same place. One line per system, exit status 1 if anything
is wrong."""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyogrio
import pyproj
import rasterio
import shapely

CELL_M = 0.5
FROM_M, TO_M = 100.6, 103.1  # some of the cells' heights, none of their borders
SYSTEMS = ("EPSG:25832",
           "+proj=tmerc +lat_0=49 +lon_0=8 +k=1 +x_0=500000 +y_0=5500000 +ellps=GRS80", "")


def cells_of(points):
    return np.unique(np.floor(points / CELL_M).astype(np.int64), axis=0)


def check_raster(file, cells, crs, faults):
    between = cells[((cells[:, 2] + 1) * CELL_M > FROM_M) & (cells[:, 2] * CELL_M < TO_M)]
    first = between[:, :2].min(axis=0)
    size = between[:, :2].max(axis=0) - first + 1
    lowest = np.full(size[::-1], np.nan, np.float32)
    highest = lowest.copy()
    for x, y, z in between:
        row, column = size[1] - 1 - (y - first[1]), x - first[0]
        lowest[row, column] = np.fmin(lowest[row, column], z * CELL_M)
        highest[row, column] = np.fmax(highest[row, column], (z + 1) * CELL_M)
    occupied = np.where(np.isnan(lowest), np.nan, 1).astype(np.float32)
    rows, columns = np.nonzero(~np.isnan(lowest))
    clearance = np.array([[CELL_M * np.hypot(rows - r, columns - c).min() for c in range(size[0])]
                          for r in range(size[1])], np.float32)
    with rasterio.open(file) as raster:
        if raster.descriptions != ("occupied", "lowest_m", "highest_m", "clearance_m"):
            faults.append(f"bands are {raster.descriptions}")
        west, north = first[0] * CELL_M, (first[1] + size[1]) * CELL_M
        if not np.allclose(raster.transform[:6], (CELL_M, 0, west, 0, -CELL_M, north), atol=1e-9):
            faults.append(f"lies at {raster.transform}")
        if not np.isnan(raster.nodata):
            faults.append(f"no data is {raster.nodata}")
        code = int(crs[5:]) if crs.startswith("EPSG:") else None
        if (raster.crs.to_epsg() if raster.crs else None) != code:
            faults.append(f"system is {raster.crs}")
        for name, band, expected in zip(raster.descriptions, raster.read(),
                                        (occupied, lowest, highest, clearance)):
            if not np.allclose(band, expected, rtol=0, atol=1e-5, equal_nan=True):
                faults.append(f"{name} differs")


def check_rectangles(file, cells, crs, faults):
    meta, _, shapes, columns = pyogrio.raw.read(file, layer=pyogrio.list_layers(file)[0][0])
    shapes = shapely.from_wkb(shapes)
    heights = dict(zip(meta["fields"], columns))
    if Path(file).suffix == ".geojson" and crs:
        back = pyproj.Transformer.from_crs("EPSG:4326", crs, always_xy=True)
        shapes = shapely.transform(shapes, lambda xy: np.column_stack(back.transform(*xy.T)))
    elif crs and meta["crs"] is None:
        faults.append(f"{file}: has no system")
    boxes = np.column_stack([shapely.bounds(shapes)[:, :2], heights["from_z_m"],
                             shapely.bounds(shapes)[:, 2:], heights["to_z_m"]]) / CELL_M
    whole = np.rint(boxes).astype(np.int64)
    if np.abs(boxes - whole).max() > 1e-3:
        faults.append(f"{Path(file).suffix}: corners are {np.abs(boxes - whole).max()} cells off")
    found = [np.stack(np.meshgrid(*(np.arange(box[i], box[i + 3]) for i in range(3))), -1)
             .reshape(-1, 3) for box in whole]
    found = np.concatenate(found)
    if len(found) != len(cells) or not np.array_equal(np.unique(found, axis=0), cells):
        faults.append(f"{Path(file).suffix}: {len(found)} cells, {len(cells)} expected")
    return len(whole)


def check(roadbed, crs, folder):
    random = np.random.default_rng(20261126)
    points = np.concatenate([random.uniform((0, 0, 100), (40, 25, 104), (300, 3)),
                             random.uniform((5, 5, 100), (25, 6.5, 102), (4000, 3))])
    points += (500_000, 5_500_000, 0)
    np.savetxt(folder / "cloud.xyz", points, "%.6f")
    points = np.loadtxt(folder / "cloud.xyz")
    octree = folder / "cloud.bt"
    subprocess.run([roadbed, "occupancy", "build", folder / "cloud.xyz", "-o", octree, "--force",
                    "--quiet", "--resolution", str(CELL_M), *(["--crs", crs] if crs else [])],
                   check=True)
    cells, faults, count = cells_of(points), [], 0
    for suffix in (".tif", ".geojson", ".gpkg", ".fgb"):
        file = folder / f"cells{suffix}"
        heights = [f"--heights={FROM_M},{TO_M}"] if suffix == ".tif" else []
        subprocess.run([roadbed, "occupancy", "export", octree, "-o", file, "--force", "--quiet",
                        *heights], check=True)
        if suffix == ".tif":
            check_raster(file, cells, crs, faults)
        else:
            count = check_rectangles(file, cells, crs, faults)
    return faults, len(cells), count


def main():
    failed = False
    for crs in SYSTEMS:
        with tempfile.TemporaryDirectory() as folder:
            faults, cells, rectangles = check(sys.argv[1], crs, Path(folder))
        print(f"{crs or 'no system'}: {cells} cells, {rectangles} rectangles: "
              + ("; ".join(faults) or "agree"))
        failed = failed or bool(faults)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
