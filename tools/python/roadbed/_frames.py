"""What needs other packages: geometries of Shapely, tables of GeoPandas."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from roadbed._roadbed import Lane, Lanes, Map


def each(lanes: Lanes) -> Iterator[Lane]:
    """The lanes one after the other."""
    return (lanes[index] for index in range(len(lanes)))


def polygon(corners: ArrayLike) -> Any:
    """A polygon of Shapely."""
    import shapely

    return shapely.Polygon(corners)


def geodataframe(road_map: Map, layer: str) -> Any:
    """A layer of a map as a table of GeoPandas."""
    import geopandas
    import shapely

    columns, shapes = road_map._layer(layer)
    return geopandas.GeoDataFrame(
        columns, geometry=shapely.from_wkb(shapes), crs=road_map.crs or None
    )
