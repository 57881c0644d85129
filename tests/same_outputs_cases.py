"""The cases of tests/same_outputs: which command lines are run, on which files.

A case is a few command lines that share a folder, where `data` and `real` lead to the maps, clouds
and scenarios. `{words}` in braces stand for what the old program answers when asked first
(same_outputs_places.py), so that every map gets places that are on it.
"""

import shlex
from dataclasses import dataclass, field
from pathlib import Path

from same_outputs_places import PAIRS, on_map, through_cloud

COMMANDS = ("import", "info", "validate", "export", "map", "locate", "route", "reach", "reference",
            "plan", "control", "drive", "simulate", "occupancy", "audit", "figures", "report", "batch",
            "jobs")
PARTS = ("map diff", "map clip", "map merge", "map transform", "map tile", "control design",
         "drive info", "occupancy build", "occupancy info", "report compare",
         *(f"jobs {kind}" for kind in ("import", "validate", "route", "simulate", "audit")))
FORMATS = ("geojson", "gpkg", "fgb", "svg", "csv", "osm", "xml")
MAPS = (".xodr", ".osm", ".xml", ".geojson")
CLOUDS = (".pcd", ".las", ".laz", ".ply", ".xyz", ".graph", ".bt", ".ot")
NO_INPUTS = ("README.md", "LICENSE", "LICENSE.txt", "COPYING", "NOTICE", "SOURCE.txt", "COMMIT.txt")

TOWN, OCTREE = "data/town.xodr", "data/town.bt"
TRIP = "--from lane:1/3/1@6 --to lane:7/0/1@35"  # as in data/drive.json
PROOF = "--json --certificate proof.json --svg a.svg --report a.html --junit a.xml --geojson a.geojson"
STRAIGHT = "t_s,x_m,y_m,heading_rad\n0,150,198.3,0\n4,190,198.7,0.02\n"
VEHICLE = """{"length_m": 5.2, "width_m": 1.9, "wheelbase_m": 3.0, "height_m": 1.9%s}"""
PARTS_OF_BODY = """,
 "mirrors": {"beyond_m": 0.2, "rear_m": 1.7, "front_m": 1.9, "from_height_m": 0.9, "to_height_m": 1.2},
 "parts": [{"name": "load", "rear_m": -1.2, "front_m": 2.4, "right_m": -1.1, "left_m": 1.1,
            "from_height_m": 1.2, "to_height_m": 2.1}]"""
JOBS = """{"job":"import","inputs":["data/country.xodr"]}
{"job":"validate","inputs":["data/crossing.osm"],"options":{"fail-on":"info"},"outputs":["sarif"]}
{"job":"route","inputs":["data/town.xodr"],"options":{"from":"lane:1/3/1@6","to":"lane:7/0/1@35"},"outputs":["output.csv"]}
{"job":"simulate","inputs":["data/scenarios/parked_car.json"]}
{"job":"audit","inputs":[],"options":{"occupancy":"data/town.bt","map":"data/town.xodr","lane":"lane:1/3/1","speed":20},"outputs":["save-drive","certificate","report","junit"]}
{"job":"import","inputs":["missing.xodr"]}
{"job":"import","inputs":["data/town.xodr"],"options":{"threads":2}}
{no JSON
"""


@dataclass(frozen=True)
class Case:
    """A name, command lines without the program (`< F` at the end: F is standard input), files
    that are there before, and whom to ask for the words in braces: a function and its file."""

    name: str
    commands: list[str]
    files: dict[str, str] = field(default_factory=dict)
    asks: tuple | None = None


def all_cases(root: Path, real: Path | None) -> list[Case]:
    """Those on data/, then those on the real data where it is there; in a fixed order."""
    folders = {"data": root / "data"} | ({"real": real} if real else {})
    files = [f"{name}/{path.relative_to(folder)}" for name, folder in folders.items()
             for path in sorted(folder.rglob("*")) if path.is_file()]
    files = [file for file in files if Path(file).name not in NO_INPUTS]
    cases = [*own_cases()]
    for file in files:
        suffix = Path(file).suffix
        is_scan = file.startswith("data/scans/") and not file.endswith("scan_00.pcd")
        if suffix in MAPS:
            cases += map_cases(shlex.quote(file))
        elif suffix in CLOUDS and not is_scan:
            cases += cloud_cases(shlex.quote(file))
        elif file.startswith("real/"):
            cases.append(Case(f"info/{file}/text", [f"info {shlex.quote(file)}"]))
        if file == "data/drive.json" or "/scenarios/" in file and suffix == ".json":
            cases += scenario_cases(file)
        if suffix == ".xml" and (file == "data/junction.xml" or "/commonroad/" in file):
            cases += [simulate_case(shlex.quote(file))]
    return cases + (real_cases() if real else [])


def map_cases(f: str):
    """Every command that reads a map."""
    places = (on_map, f)
    yield Case(f"import/{f}", [f"import {f} -o map.rbm", "info map.rbm --verify",
                               "info map.rbm --json", "export map.rbm -o map.csv",
                               f"map diff {f} map.rbm --json",
                               f"import {f} -o coarse.rbm --max-error 0.1 --json",
                               f"map diff map.rbm coarse.rbm"])
    yield Case(f"info/{f}/text", [f"info {f}"])
    yield Case(f"info/{f}/json", [f"info {f} --json"])
    yield Case(f"validate/{f}/text", [f"validate {f}"])
    yield Case(f"validate/{f}/files",
               [f"validate {f} --json --fail-on warning --junit v.xml --sarif v.sarif "
                "--geojson v.geojson --svg v.svg"])
    for suffix in FORMATS:
        yield Case(f"export/{f}/{suffix}", [f"export {f} -o map.{suffix}"])
    yield Case(f"export/{f}/anchored", [f"export {f} --crs unknown --anchor 48.78,9.18 -o map.{s}"
                                        for s in ("osm", "geojson")])
    yield Case(f"locate/{f}", [f"locate {f} --points points.csv --count 3 --json",
                               f"locate {f} --at {{from1}} --drivable"],
               {"points.csv": "{points}"}, places)
    for n in range(1, PAIRS + 1):
        pair = f"--from {{from{n}}} --to {{to{n}}}"
        yield Case(f"route/{f}/pair{n}",
                   [f"route {f} {pair} --json",
                    f"route {f} {pair} --cost distance --alternatives 3 -o way.geojson"], {}, places)
        yield Case(f"reference/{f}/pair{n}", [f"reference {f} {pair} -o line.csv"], {}, places)
    pair = "--from {from1} --to {to1}"
    yield Case(f"route/{f}/rules",
               [f"route {f} {pair} --via {{from2}} --avoid {{avoid}} --json -o way.svg",
                f"route {f} {pair} --participant bicycle --max-speed 20 --lane-change-cost 1 "
                "--left-turn-cost 9 -o way.csv"], {}, places)
    yield Case(f"route/{f}/batch", [f"route {f} --batch pairs.csv -o answers.csv",
                                    f"route {f} --batch pairs.csv --matrix --json"],
               {"pairs.csv": "{pairs}"}, places)
    yield Case(f"route/{f}/compiled", [f"import {f} -o map.rbm --quiet",
                                       f"route map.rbm {pair} --json",
                                       f"reference map.rbm {pair} -o line.csv --step 0.5",
                                       "locate map.rbm --points points.csv",
                                       "validate map.rbm"], {"points.csv": "{points}"}, places)
    yield Case(f"reach/{f}", [f"reach {f} --from {{from1}} --within 60s --json -o reach.geojson",
                              f"reach {f} --from {{from2}} --within 300m -o reach.csv",
                              f"reach {f} --from {{from1}} --within 20s -o reach.svg --quiet"],
               {}, places)
    yield Case(f"reference/{f}/points",
               ["reference --waypoints p.csv -o smooth.csv --max-move 0.5",
                "reference --waypoints p.csv -o spline.csv --interpolate --ends clamped "
                "--headings 10,-20 --step 0.7"], {"p.csv": "{waypoints}"}, places)


def cloud_cases(f: str):
    """Every command that reads a cloud or octree, with a drive straight through its box."""
    crossing = (through_cloud, f)
    yield Case(f"occupancy/{f}/info", [f"occupancy info {f}", f"occupancy info {f} --json"])
    yield Case(f"occupancy/{f}/build", [f"occupancy build {f} -o a.bt", "occupancy info a.bt --json",
                                        f"occupancy build {f} -o a.ot --resolution 0.5",
                                        "occupancy info a.ot --json"])
    yield Case(f"occupancy/{f}/carved",
               [f"occupancy build {f} -o a.bt --resolution 0.2 --sensor {{sensor}} --carve-range 9",
                f"occupancy build {f} -o b.bt --resolution 0.2 --sensor {{sensor}} --no-sticky",
                f"occupancy build {f} -o c.tiles --tiles 50 --resolution 0.4",
                "occupancy info c.tiles"], {}, crossing)
    yield Case(f"occupancy/{f}/filtered",
               [f"occupancy build {f} -o a.bt --voxel 0.5 --outlier-neighbours 8"])
    yield Case(f"audit/{f}",
               [f"occupancy build {f} -o a.bt --resolution 0.2 --quiet",
                f"audit --occupancy a.bt --trajectory t.csv --ground {{ground}} {PROOF}",
                "audit --check proof.json",
                "audit --occupancy a.bt --trajectory t.csv --ground {ground} --unknown free "
                "--clearance 0.5"], {"t.csv": "{crossing}"}, crossing)


def scenario_cases(f: str):
    """What reads a scenario of this project."""
    yield simulate_case(f)
    yield Case(f"plan/{f}", [f"plan {f} -o plan --explain",
                             f"plan {f} -o other --json --circles 3 --weights weights.json"],
               {"weights.json": '{"curvature": 2.5, "lateral_jerk": 0.3}'})


def simulate_case(f: str) -> Case:
    """A drive, its audit against an octree with what moves in the scenario, both compared."""
    return Case(f"simulate/{f}",
                [f"simulate {f} -o drive", f"simulate {f} -o foreseen --predict --json",
                 "report compare drive foreseen",
                 "occupancy build point.xyz -o point.bt --sensor 0,0,9 --quiet",
                 "audit --occupancy point.bt --trajectory drive/trajectory.csv --unknown free "
                 f"--obstacles {f} {PROOF}",
                 "audit --check proof.json"], {"point.xyz": "0 0 0.5\n"})


def own_cases():
    """What is asked once, on files of data/ only."""
    scans = " ".join(f"data/scans/scan_{n:02}.pcd" for n in range(46))
    car = {"car.json": VEHICLE % "", "noise.json": '{"gap_m": 0.3, "position_m": 0.05}'}
    yield Case("program/version", ["--version"])
    for command in ("", *COMMANDS, *PARTS):
        yield Case(f"{(command or 'program').replace(' ', '/')}/help", [f"{command} --help"])
    yield Case("program/usage",
               ["", "nosuch", "--threads 0 info data/town.xodr", *COMMANDS, *PARTS,
                f"route {TOWN} --from 1 --to 2", f"reach {TOWN} --from lane:1/3/1 --within 9",
                f"export {TOWN} -o a.nosuch", f"import {TOWN} -o a.svg", f"info {TOWN} --nosuch"])
    yield Case("program/unusable",
               ["info missing.xodr", "info data/README.md", "info empty.osm", "info cut.rbm",
                f"import {TOWN} -o missing/a.rbm", f"import {TOWN} -o there.rbm",
                f"route {TOWN} --from lane:1/9/9 --to 0,0", f"export {TOWN} -o a.fgb --layer areas",
                "simulate empty.json -o drive", "occupancy info empty.bt", "audit --check empty.json",
                f"audit --occupancy {OCTREE} --trajectory empty.csv", "batch missing.jsonl -o out"],
               {"empty.osm": "", "cut.rbm": "roadbed map v003", "there.rbm": "mine",
                "empty.json": "{}", "empty.bt": "", "empty.csv": "t_s,x_m\n"})
    yield Case("validate/rules", ["validate --rules", "validate --rules --json"])
    yield Case("validate/limits",
               [f"validate {TOWN} --json --fail-on info --max-gap 1e-9 --max-kink 1e-9 --max-step 0 "
                "--max-slope 0.01 --max-curvature 0.01 --max-speed 5 --min-overlap 0"])
    for layer in ("lanes", "borders", "drivable_surface", "objects", "stop_lines", "signals"):
        yield Case(f"export/{TOWN}/{layer}", [f"export {TOWN} --layer {layer} -o {layer}.{suffix}"
                                              for suffix in ("fgb", "geojson")])
    yield Case("import/crs", [f"import {TOWN} -o a.rbm --crs EPSG:25832 --json",
                              "import data/junction.xml -o b.rbm --crs nonsense",
                              "info b.rbm", "export a.rbm -o a.geojson"])
    yield Case("map/diff", [f"map diff {TOWN} data/country.xodr",
                            f"map diff {TOWN} data/crossing.osm --json --tolerance 0.5"])
    yield Case("drive/info", ["drive info t.csv", "drive info t.csv --json"], {"t.csv": STRAIGHT})
    yield Case("control/design",
               ["control design", "control design --json",
                "control design --weights 1 2 0.5 --input-weight 5 --delay 3 --json",
                "control design --headway 0.2 --lag 2 --gain 0.4 --step 0.5",
                "control design --headway -1 --step 0"])
    yield Case("figures/all", ["figures -o figures"])
    yield Case("simulate/folder",
               ["simulate data/scenarios -o drives --threads 2",
                "report compare drives/cut_in drives/overtake --json --max largest_cross_track_m=0",
                f"audit --occupancy {OCTREE} --trajectory drives --report a.html --junit a.xml "
                f"--geojson a.geojson --json --map {TOWN}"])
    yield Case("simulate/options",
               ["simulate data/scenarios/parked_car.json -o a --vehicle car.json --json",
                "simulate data/scenarios/stop_and_go.json -o b --noise noise.json --seed 7 --json",
                "simulate data/scenarios/stop_and_go.json -o c --seed 8 --timings timings.csv",
                "simulate data/scenarios/parked_car.json -o d --seed x"], car)
    yield Case("simulate/candidates", ["simulate data/scenarios/lane_change.json -o a --candidates"])
    yield Case("plan/replay", ["simulate data/scenarios/pass_car.json -o drive --quiet",
                               "plan drive@4.25 -o plan --explain", "plan drive@17 -o json --json",
                               "plan drive@99 -o none", "plan drive@x -o none", "plan data@0 -o none"])
    audit = f"audit --occupancy {OCTREE}"
    yield Case("audit/drive",
               ["simulate data/drive.json -o drive", f"{audit} --trajectory drive/trajectory.csv "
                f"--map {TOWN} --obstacles data/drive.json {PROOF}", "audit --check proof.json",
                f"{audit} --trajectory drive/trajectory.csv --ground measured --inflate 0.2"])
    yield Case("audit/lane", [f"{audit} --map {TOWN} --lane lane:1/3/1 --offset 0.3 "
                              f"--save-drive drive.csv {PROOF}", "audit --check proof.json --json"])
    yield Case("audit/route", [f"{audit} --map {TOWN} {TRIP} --speed 30 --unknown occupied"])
    yield Case("audit/unknown",
               [f"{audit} --trajectory t.csv --unknown {how} --json --ground {ground}"
                for how in ("free", "occupied", "report") for ground in ("0", "0.3", "measured")],
               {"t.csv": STRAIGHT})
    yield Case("audit/vehicle", [f"{audit} --trajectory t.csv --vehicle car.json {PROOF}",
                                 "audit --check proof.json"],
               {"t.csv": STRAIGHT, "car.json": VEHICLE % PARTS_OF_BODY})
    yield Case("audit/obstacles",
               [f"{audit} --trajectory t.csv --obstacles boxes.csv {PROOF}",
                "audit --check proof.json"],
               {"t.csv": STRAIGHT,
                "boxes.csv": "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n0,a,190,202,3.1,4,1.8\n"
                             "4,a,150,202,3.1,4,1.8\n0,post,170,196,0,0.3,0.3\n"})
    yield Case("occupancy/scans",
               [f"occupancy build {scans} --resolution 0.2 -o town.bt", "occupancy info town.bt",
                f"occupancy build {scans} --resolution 0.3 -o log.ot --no-sticky",
                f"occupancy build {scans} --resolution 0.3 -o hits.bt --no-carving --voxel 0.4",
                f"occupancy build {scans} --resolution 0.3 -o still.bt --remove-seen-through 2",
                f"audit --occupancy still.bt --trajectory t.csv {PROOF}"], {"t.csv": STRAIGHT})
    yield Case("occupancy/tiles",
               [f"occupancy build {scans} --resolution 0.2 --tiles 60 -o town.tiles",
                "occupancy info town.tiles --json",
                f"audit --occupancy town.tiles --trajectory t.csv {PROOF}",
                "audit --check proof.json"], {"t.csv": STRAIGHT})
    yield Case("reference/closed",
               ["reference --waypoints p.csv -o a.csv --interpolate --ends periodic",
                "reference --waypoints p.csv -o b.csv --vehicle car.json --half-width 2 "
                "--speed-limit 60"],
               car | {"p.csv": "x_m,y_m\n0,0\n40,-5\n60,30\n20,50\n-20,30\n0,0\n"})
    yield Case("jobs/kinds",
               ["jobs import 'data/*.xodr' -o import.jsonl",
                "jobs validate 'data/*.xodr' 'data/*.osm' --fail-on error warning -o validate.jsonl",
                "jobs simulate 'data/scenarios/s*.json' --seed 1..3 --predict -o simulate.jsonl",
                f"jobs route {TOWN} --batch pairs.csv -o route.jsonl",
                f"jobs audit --occupancy {OCTREE} --trajectory t.csv --inflate 0 0.2 -o audit.jsonl",
                f"jobs simulate {TOWN} --seed 1,2 -o wrong.jsonl"],
               {"t.csv": STRAIGHT, "pairs.csv": "from,to\nlane:1/3/1@6,lane:7/0/1@35\n"})
    jobs = {"jobs.jsonl": JOBS}
    yield Case("batch/threads", ["batch jobs.jsonl -o out --list-missing",
                                 "batch jobs.jsonl -o out --threads 2 --json",
                                 "batch jobs.jsonl -o out --merge"], jobs)
    yield Case("batch/isolate", ["batch jobs.jsonl -o out --isolate --time-limit 60 "
                                 "--job-memory 2GB --threads 2"], jobs)
    yield Case("batch/serve", ["batch --serve -o out < jobs.jsonl"], jobs)


def real_cases() -> list[Case]:
    """What is asked once, on the real data."""
    asam, drives = "real/opendrive/asam-ev+qc-opendrive", "real/control"
    links = f"{asam}/junction_connection_linkage/junction_connection_linkage"
    return [
        Case("map/diff/real", [f"map diff {links}_valid.xodr {links}_invalid.xodr --json"]),
        Case("batch/real", [f"jobs validate '{asam}/*/*.xodr' 'real/lanelet2/*/*.osm' -o jobs.jsonl",
                            "batch jobs.jsonl -o out --threads 2 --json"]),
        Case("reference/real",
             [f"reference --waypoints {drives}/{course}_course.csv -o {course}.csv {how}"
              for course, how in (("lqr", "--interpolate"), ("stanley", "--max-move 0.3"))]),
    ]
