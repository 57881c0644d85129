"""What a result has of geometry, as well-known binary (WKB), in the coordinates of its source."""

import csv
import json
import math
import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

Point = tuple[float, float]

_POINT, _LINE_STRING, _MULTI_POINT = 1, 2, 4


@dataclass(frozen=True)
class Geometry:
    """A shape of one result; all coordinates are finite."""

    type: str  #: `LineString` or `MultiPoint`
    points: tuple[Point, ...]
    crs: str | None = None  #: PROJ string or authority code; None: unknown

    def wkb(self) -> bytes:
        """Return the shape as little-endian WKB."""
        count = len(self.points)
        if self.type == "LineString":
            flat = [number for point in self.points for number in point]
            return struct.pack(f"<BII{2 * count}d", 1, _LINE_STRING, count, *flat)
        head = struct.pack("<BII", 1, _MULTI_POINT, count)
        return head + b"".join(struct.pack("<BIdd", 1, _POINT, *point) for point in self.points)

    def bounds(self) -> tuple[float, float, float, float]:
        """Return least x, least y, largest x, largest y."""
        xs, ys = zip(*self.points, strict=True)
        return min(xs), min(ys), max(xs), max(ys)


def _points(pairs: list[tuple[Any, Any]]) -> tuple[Point, ...]:
    """Return the pairs that are two finite numbers."""
    return tuple(
        (float(x), float(y))
        for x, y in pairs
        if isinstance(x, (int, float))
        and isinstance(y, (int, float))
        and math.isfinite(x)
        and math.isfinite(y)
    )


def _multi_point(pairs: list[tuple[Any, Any]]) -> Geometry | None:
    points = _points(pairs)
    return Geometry("MultiPoint", points) if points else None


def _line(pairs: list[tuple[Any, Any]], crs: str | None = None) -> Geometry | None:
    points = _points(pairs)
    return Geometry("LineString", points, crs) if len(points) >= 2 else None


def _conflicts(result: dict[str, Any], output: Path) -> Geometry | None:
    """Return where an audited vehicle is nearest to what it conflicts with."""
    places = [conflict["at"] for conflict in result["result"].get("conflicts", [])]
    return _multi_point([(place["x_m"], place["y_m"]) for place in places])


def _findings(result: dict[str, Any], output: Path) -> Geometry | None:
    """Return the places of what is wrong with a map."""
    findings = result["result"].get("findings", [])
    return _multi_point([(finding.get("x_m"), finding.get("y_m")) for finding in findings])


def _driven_line(result: dict[str, Any], output: Path) -> Geometry | None:
    """Return the line that the rear axle of a simulated vehicle took."""
    files = [file for file in result["files"] if file.endswith("/trajectory.csv")]
    path = output / files[0] if len(files) == 1 else None
    if path is None or not path.is_file():
        return None
    with path.open(encoding="utf-8", newline="") as rows:
        return _line([(float(row["x_m"]), float(row["y_m"])) for row in csv.DictReader(rows)])


def _route_line(result: dict[str, Any], output: Path) -> Geometry | None:
    """Return the way of the cheapest route, where the job asked for its GeoJSON."""
    files = [file for file in result["files"] if file.endswith(".geojson")]
    path = output / files[0] if len(files) == 1 else None
    if path is None or not path.is_file():
        return None
    document = json.loads(path.read_text(encoding="utf-8"))
    ways = [f for f in document["features"] if f["geometry"]["type"] == "LineString"]
    if not ways:
        return None
    named = document.get("crs") or {}
    crs = named.get("properties", {}).get("name")
    return _line([(pair[0], pair[1]) for pair in ways[0]["geometry"]["coordinates"]], crs)


#: How the geometry of a result is found, for the kinds that have one.
GEOMETRIES: dict[str, Callable[[dict[str, Any], Path], Geometry | None]] = {
    "validate": _findings,
    "route": _route_line,
    "simulate": _driven_line,
    "audit": _conflicts,
}
