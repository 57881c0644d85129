"""Which inputs are grown, and what gets them."""

from collections.abc import Callable
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

import inputs

DATA = Path(__file__).resolve().parents[2] / "data"
Commands = list[tuple[str, list[str]]]


@dataclass
class Case:
    name: str
    make: Callable[[Path, int], Path]
    size: int  # the first of three
    commands: Commands


def map_commands(at: str = "50,-1.7", *more: str) -> Commands:
    """On the file: import, validate; on what was imported: the others."""
    def export(suffix: str):
        return (f"export {suffix}", ["export", "in.rbm", "-o", "out" + suffix, "--force"])

    commands: Commands = [
        ("import", ["import", "IN", "-o", "in.rbm", "--force"]),
        ("validate", ["validate", "IN"]),
        ("info", ["info", "in.rbm"]),
        ("locate", ["locate", "in.rbm", "--at", at]),
        export(".csv"),
        export(".svg"),
        export(".gpkg"),
        export(".html"),
        ("route", ["route", "in.rbm", "--from", at, "--to", at]),
    ]
    extra = {
        "reach": ("reach", ["reach", "in.rbm", "--from", at, "--within", "60s"]),
        "diff": ("map diff", ["map", "diff", "in.rbm", "in.rbm"]),
        ".xodr": export(".xodr"),
        ".osm": export(".osm"),
        "anchored .osm": (
            "export .osm",
            ["export", "in.rbm", "-o", "out.osm", "--anchor", "48,9", "--force"],
        ),
        ".nod.xml": export(".nod.xml"),
        ".xml": export(".xml"),
        ".geojson": export(".geojson"),
        ".fgb": export(".fgb"),
    }
    return commands + [extra[name] for name in more]


LANES_ROUTES: Commands = [
    ("import", ["import", "IN", "-o", "in.rbm", "--force"]),
    ("route", ["route", "in.rbm", "--from", "lane:1/0/-1@5", "--to", "lane:1/0/-3@95"]),
    ("route same lane", ["route", "in.rbm", "--from", "lane:1/0/-1@5", "--to", "lane:1/0/-1@95"]),
    ("reach", ["reach", "in.rbm", "--from", "lane:1/0/-1@5", "--within", "60s"]),
    ("export .svg", ["export", "in.rbm", "-o", "out.svg", "--force"]),
    ("info", ["info", "in.rbm"]),
    ("validate", ["validate", "IN"]),
]
AUTOWARE: Commands = [("validate autoware", ["validate", "IN", "--profile", "autoware"])]
AREA: Commands = [
    ("info", ["info", "IN"]),
    ("import", ["import", "IN", "-o", "in.rbm", "--force"]),
    ("validate", ["validate", "IN"]),
    ("export .svg", ["export", "IN", "-o", "out.svg", "--force"]),
    ("export .csv", ["export", "IN", "-o", "out.csv", "--force"]),
]
MAP: Commands = [
    ("map stats", ["map", "stats", "IN"]),
    ("map query", ["map", "query", "IN", "width > 1 and slope < 50", "--format", "csv"]),
    ("map diff", ["map", "diff", "IN", "IN"]),
]
PART, BOTH = ["-o", "part.xml", "--force"], ["-o", "both.xml", "--force"]
EDIT: Commands = [
    ("map clip", ["map", "clip", "IN", "--bbox=-1e7,-1e7,55,1e7", *PART]),
    ("map tile", ["map", "tile", "IN", "100000", "-o", "tiles", "--force"]),
    ("map merge", ["map", "merge", "IN", "IN", *BOTH]),
    ("map merge parts", ["map", "merge", "IN", "part.xml", *BOTH]),
    ("map transform", ["map", "transform", "IN", "--turn", "30deg", *BOTH]),
    ("elevation", ["map", "transform", "IN", "--elevation", str(DATA / "town.bt"), *BOTH]),
    ("map fix", ["map", "fix", "IN", "-o", "mended.xml", "--force"]),
    *MAP,
]
COLUMNS: Commands = [
    ("import", ["import", "IN", "--columns", "columns.json", "-o", "in.rbm", "--force"]),
    ("route", ["route", "in.rbm", "--from", "50,0", "--to", "50,0"]),
]
COLUMNS_XODR: Commands = [
    COLUMNS[0],
    ("export .xodr", ["export", "in.rbm", "-o", "out.xodr", "--force"]),
]
TOWN_XODR, TOWN_OSM = str(DATA / "town.xodr"), str(DATA / "crossing.osm")
REGION: Commands = [
    (f"map clip {map_file[-4:]}", ["map", "clip", map_file, "--polygon", "IN", *PART])
    for map_file in (TOWN_XODR, TOWN_OSM)
] + [
    (
        "occupancy crop",
        ["occupancy", "crop", str(DATA / "town.bt"), "--polygon", "IN", "-o", "part.bt", "--force"],
    )
]
ALIGN: Commands = [("--align", ["map", "transform", TOWN_XODR, "--align", "IN", *BOTH])]
GROUND: Commands = [
    (f"elevation {map_file[-4:]}", ["map", "transform", map_file, "--elevation", "IN", *BOTH])
    for map_file in (TOWN_XODR, TOWN_OSM)
]
TILES: Commands = [("map tile", ["map", "tile", "IN", "500", "-o", "tiles", "--force"])]
NARROW_TILES: Commands = [("map tile", ["map", "tile", "IN", "5", "-o", "tiles", "--force"])]
SCENARIO: Commands = [("simulate", ["simulate", "IN", "-o", "out", "--force"])]
TOWN = ["--occupancy", str(DATA / "town.bt"), "--unknown", "free", "--certificate", "out.json"]
AUDIT: Commands = [
    ("audit", ["audit", *TOWN, "--trajectory", "IN", "--force"]),
    ("audit --check", ["audit", "--check", "out.json"]),
]
MOVERS: Commands = [
    (
        "audit --obstacles",
        ["audit", *TOWN, "--trajectory", "in.csv", "--obstacles", "IN", "--force"],
    ),
    ("audit --check", ["audit", "--check", "out.json"]),
]
AREAS: Commands = [
    (
        "audit --on area",
        ["audit", "--on", "area:IN", "--trajectory", "in.csv", "--certificate", "out.json", "--force"],
    ),
    ("audit --check", ["audit", "--check", "out.json"]),
]
CLOUD: Commands = [
    ("occupancy info", ["occupancy", "info", "IN"]),
    ("occupancy build", ["occupancy", "build", "IN", "-o", "out.bt", "--force"]),
]
OBJECTS: Commands = [
    ("occupancy objects", ["occupancy", "objects", "IN", "-o", "objects.csv", "--force"])
]
TILES_INFO: Commands = [("occupancy info", ["occupancy", "info", "in.tiles"])]
FAR_POINTS: Commands = [
    ("occupancy build", ["occupancy", "build", "IN", "-o", "out.bt", "--force"]),
    ("occupancy .tif", ["occupancy", "export", "out.bt", "-o", "out.tif", "--force"]),
    ("occupancy .pgm", ["occupancy", "export", "out.bt", "-o", "out.pgm", "--force"]),
    (
        "occupancy objects",
        ["occupancy", "objects", "IN", "-o", "objects.csv", "--least-points", "1", "--force"],
    ),
]
LOG: Commands = [("drive info", ["drive", "info", "IN"])]
OCTREE: Commands = CLOUD + [
    ("occupancy merge", ["occupancy", "merge", "IN", "IN", "-o", "both.bt", "--force"]),
    (
        "occupancy crop",
        ["occupancy", "crop", "IN", "--heights=-1e4,1e4", "-o", "part.bt", "--force"],
    ),
    (
        "audit",
        ["audit", "--occupancy", "IN", "--trajectory", "in.csv", "--unknown", "free"],
    )
]

ALL = map_commands(
    "50,-1.7",
    *("reach", "diff", ".xodr", "anchored .osm", ".xml", ".nod.xml", ".geojson", ".fgb"),
)
CHECK: Commands = [("audit --check", ["audit", "--check", "IN"])]
LOCATE: Commands = [("locate --points", ["locate", TOWN_XODR, "--points", "IN"])]
ROUTES: Commands = [
    ("route --batch", ["route", TOWN_XODR, "--batch", "IN", "-o", "out.csv", "--force"])
]
LINES: Commands = [
    ("reference", ["reference", "--waypoints", "IN", "-o", "out.csv", "--force"]),
    (
        "reference --interpolate",
        ["reference", "--waypoints", "IN", "--interpolate", "-o", "out.csv", "--force"],
    ),
]
POSES: Commands = [
    (
        "occupancy build",
        ["occupancy", "build", "cloud.pcd", "--poses", "IN", "-o", "out.bt", "--force"],
    )
]
BATCH: Commands = [("batch", ["batch", "IN", "-o", "out", "--threads", "1"])]

CASES = [
    Case("roads apart", inputs.roads_apart, 100, ALL + EDIT),
    Case("roads in a row", inputs.roads_in_a_row, 100, map_commands("50,-1.7", "reach", "anchored .osm") + EDIT),
    Case("same roads", inputs.same_roads, 10, map_commands("50,-1.7", "diff", "anchored .osm", ".geojson") + EDIT),
    Case("shifted roads", inputs.shifted_roads, 10, map_commands("20,-1.7") + EDIT),
    Case("roads through one place", inputs.crossing_roads, 10, map_commands("20,0") + EDIT),
    Case("woven roads", inputs.woven_roads, 10, map_commands("20,5") + EDIT),
    Case("widening roads", inputs.widening_roads, 1, AREA),
    Case("winding roads", inputs.winding_roads, 1, map_commands("20,5") + EDIT),
    Case("connecting roads", inputs.connecting_roads, 10, map_commands("-50,-1.7") + EDIT),
    Case("lanes in a section", inputs.lanes_in_a_section, 10, LANES_ROUTES + EDIT),
    Case("narrow lanes", inputs.narrow_lanes, 100, map_commands("50,-0.005") + EDIT),
    Case("sections of a road", inputs.sections_of_a_road, 100, map_commands("50,-1.7", "reach") + EDIT),
    Case("pieces of a road", inputs.pieces_of_a_road, 1000, map_commands("50,-1.7") + EDIT),
    Case("widths of a lane", inputs.widths_of_a_lane, 1000, map_commands("50,-1.7") + EDIT),
    Case(
        "marks of a lane",
        inputs.marks_of_a_lane,
        500,
        map_commands("50,-1.7", ".xodr", "anchored .osm", ".geojson") + EDIT,
    ),
    Case("elevations of a road", inputs.elevations_of_a_road, 400, ALL + EDIT),
    Case("tilts of a road", inputs.tilts_of_a_road, 400, ALL + EDIT),
    Case("offsets of lanes", inputs.offsets_of_lanes, 400, ALL + EDIT),
    Case("borders of a lane", inputs.borders_of_a_lane, 400, ALL + EDIT),
    Case("heights of a lane", inputs.heights_of_a_lane, 400, ALL + EDIT),
    Case("arms of a junction", inputs.arms_of_a_junction, 10, ALL + EDIT),
    Case("strips of a road", inputs.strips_of_a_road, 100, map_commands("50,-1.7") + EDIT),
    Case("signals of a road", inputs.signals_of_a_road, 100, map_commands("50,-1.7") + EDIT),
    Case("lights and stop lines", inputs.lights_and_stop_lines, 10,
         map_commands("50,-1.7", "anchored .osm")),
    Case("crooked road", inputs.crooked_road, 50, map_commands("50,-1.7", ".nod.xml")),
    Case("signals of all lanes", inputs.signals_of_all_lanes, 50, ALL + EDIT),
    Case("repeated objects", inputs.repeated_objects, 10, map_commands("50,-1.7") + EDIT),
    Case("repeated outlines", inputs.repeated_outlines, 4,
         map_commands("50,-1.7", "anchored .osm", ".geojson", ".fgb")),
    Case("roads of one name", inputs.roads_of_one_name, 100, map_commands("50,-1.7")[:2] + EDIT),
    Case("unknown elements", inputs.unknown_elements, 3000, map_commands("50,-1.7") + EDIT),
    Case("attributes of a road", inputs.attributes_of_a_road, 1000, map_commands("50,-1.7")[:3] + EDIT),
    Case("nested elements", inputs.nested_elements, 1000, map_commands("50,-1.7")[:3] + EDIT),
    Case("long name", inputs.long_name, 10000, map_commands("50,-1.7") + EDIT),
    Case(
        "lanelets",
        inputs.lanelets_in_a_row,
        100,
        map_commands("50,1.5", "reach", ".osm") + AUTOWARE + EDIT,
    ),
    Case("winding lanelets", inputs.winding_lanelets, 10, map_commands("5,0") + AUTOWARE + EDIT),
    Case("same lanelets", inputs.same_lanelets, 10, map_commands("50,1.5", ".osm") + AUTOWARE + EDIT),
    Case("crossing lanelets", inputs.crossing_lanelets, 10, AUTOWARE + EDIT),
    Case("fan of lanelets", inputs.fan_of_lanelets, 10,
         map_commands("-20,1.5", ".nod.xml", ".xodr", ".osm", ".xml")),
    Case("same turns", inputs.same_turns, 10, map_commands("50,1.5", ".nod.xml", ".xodr") + AUTOWARE),
    Case("zigzag border", inputs.zigzag_border, 1000, map_commands("50,1.5") + AUTOWARE + EDIT),
    Case("border back and forth", inputs.border_back_and_forth, 1000, map_commands("50,1.5") + EDIT),
    Case("tags of a way", inputs.tags_of_a_way, 1000, map_commands("50,1.5")[:3] + EDIT),
    Case("regulations", inputs.regulations, 100, map_commands("50,1.5") + AUTOWARE + EDIT),
    Case(
        "CommonRoad lanelets",
        inputs.cr_lanelets_in_a_row,
        100,
        map_commands("50,1.5", ".xml") + EDIT,
    ),
    Case("same CommonRoad lanelets", inputs.cr_same_lanelets, 10, map_commands("50,1.5") + EDIT),
    Case("CommonRoad obstacles", inputs.cr_obstacles, 100, map_commands("50,1.5")[:3] + EDIT),
    Case("lanes of a table", inputs.table_lanes_in_a_row, 100, COLUMNS),
    Case("same lanes of a table", inputs.table_same_lanes, 10, COLUMNS),
    Case("slanting lanes of a table", inputs.table_slanting_lanes, 40, COLUMNS_XODR),
    Case("points of a table's lane", inputs.table_points_of_a_lane, 1000, COLUMNS),
    # Fewer than 10,000 lanes: from there on import adds up their areas, a step in time.
    Case("successors in a table", inputs.table_successors_of_a_lane, 50, COLUMNS),
    Case("circle", inputs.circle, 100, AREA),
    Case("roundabout", inputs.roundabout, 100, AREA),
    Case("random ring", inputs.random_ring, 30, AREA),
    Case("comb", inputs.comb, 300, AREA),
    Case("same squares", inputs.same_squares, 10, AREA),
    Case("squares apart", inputs.squares_apart, 100, AREA),
    Case("shifted squares", inputs.shifted_squares, 10, AREA),
    Case("holes", inputs.holes, 100, AREA),
    Case("properties of a feature", inputs.properties_of_a_feature, 1000, AREA[:3]),
    Case("Argoverse lanes", inputs.av_segments_in_a_row, 100, map_commands("50,1.5", ".osm") + MAP),
    Case("same Argoverse lanes", inputs.av_same_segments, 10, map_commands("50,1.5") + MAP),
    Case("points of an Argoverse lane", inputs.av_points_of_a_border, 1000, map_commands("5,1.5") + MAP),
    Case("successors of a lane", inputs.av_successors_of_a_segment, 100, map_commands("50,1.5") + MAP),
    Case("long intersections", inputs.av_long_intersections, 10, map_commands("50,1.5")[:3]),
    Case("objects in a list", inputs.objects_in_a_list, 3000, SCENARIO),
    Case("empty objects", inputs.empty_objects, 50000, SCENARIO),
    Case("traffic of a scenario", inputs.traffic_of_a_scenario, 5, SCENARIO),
    Case("keys of an object", inputs.keys_of_an_object, 10000, SCENARIO),
    Case("nested objects", inputs.nested_objects, 10000, SCENARIO),
    Case("numbers in a list", inputs.numbers_in_a_list, 100_000, CHECK),
    Case("rows of a drive", inputs.rows_of_a_drive, 1000, AUDIT),
    Case("rows apart", inputs.rows_apart, 100, AUDIT),
    Case("outlier", inputs.outlier, 20_000, AUDIT),
    Case("rows far apart", inputs.rows_far_apart, 500, AUDIT),
    Case("movers", inputs.movers, 1000, MOVERS),
    Case("movers that jump", inputs.movers_that_jump, 100, MOVERS),
    Case("empty parts of an index", inputs.empty_parts_of_an_index, 3000, TILES_INFO),
    Case("points far apart", inputs.points_far_apart, 30, FAR_POINTS),
    Case("areas of a drive", inputs.areas_of_a_drive, 20, AREAS),
    Case("points .xyz", inputs.xyz, 10000, CLOUD),
    Case("points .pcd", inputs.pcd_binary, 10000, CLOUD),
    Case("points in one place", inputs.pcd_one_place, 100_000, CLOUD + OBJECTS),
    Case("points above each other", inputs.pcd_column, 1000, CLOUD + OBJECTS),
    Case("compressed .pcd", inputs.pcd_bomb, 50_000, CLOUD),
    Case("packed log", inputs.log_bomb, 10_000_000, LOG),
    Case("packed cloud in a log", inputs.log_of_zeros, 2_000_000, CLOUD + OBJECTS),
    Case("log of huge chunks", inputs.log_chunks, 10_000, LOG),
    Case("full .bt", inputs.bt_checked, 10_000, OCTREE),
    Case("full .ot", inputs.ot_chain, 10_000, OCTREE),
    Case("points .ply", inputs.ply, 10_000, CLOUD),
    Case("points .las", inputs.las, 10_000, CLOUD),
    Case("poses", inputs.poses, 1000, POSES),
    Case("places", inputs.places, 1000, LOCATE),
    Case("pairs", inputs.pairs, 100, ROUTES),
    Case("way-points", inputs.way_points, 100, LINES),
    Case("way-points apart", inputs.way_points_apart, 1000, LINES),
    Case("vertices of a region", inputs.region_of_many_vertices, 1000, REGION),
    Case("spikes of a region", inputs.star_region, 1000, REGION),
    Case("regions", inputs.many_regions, 40, REGION),
    Case("pairs to align by", inputs.pairs_to_align, 1000, ALIGN),
    Case("ground of a map", inputs.ground, 40_000, GROUND),
    Case("tiles of roads", inputs.roads_apart, 100, TILES),
    Case("tiles of a road", inputs.sections_of_a_road, 100, NARROW_TILES),
    Case("tiles of lanelets", inputs.lanelets_in_a_row, 100, TILES),
    Case("tiles of CommonRoad", inputs.cr_lanelets_in_a_row, 100, TILES),
    Case("job lines", inputs.job_lines, 100, BATCH),
]

def all_cases(pattern: str):
    return [case for case in CASES if fnmatchcase(case.name, pattern)]
