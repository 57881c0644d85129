"""What each fuzz target reads: its sources, its seeds and the words that it knows."""

import os
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CORPUS = ROOT / "tests/fuzz/corpus"

#: Sources that read the bytes of a target, as patterns of paths in the tree.
SOURCES = {
    "argoverse": r"map/argoverse/",
    "autoware_vehicle": r"tools/files/(autoware_vehicle|vehicle_file)",
    "certificate": r"tools/audit/certificate_json|planning/audit/check/certificate_check",
    "cloud_message": r"map/logs/cloud_message"
                     r"|map/occupancy/clouds/(message_points|point_time|sweep_poses)",
    "common_road": r"map/commonroad/(document|lanes|links|read|scenario|traffic_rules"
                   r"|values)\.",
    "compiled_map": r"map/compiled/|map/storage/chunked_file",
    "drive_file": r"tools/files/(drive_file|pose_lines|argoverse_drive|solution_drive)",
    "drive_record": r"tools/report/drive_record",
    "edit": r"map/(edit/|files/xml_places)",
    "feather": r"map/logs/(argoverse|feather|flat_tables|pose_columns|unpack_block)",
    "geojson": r"map/geojson/",
    "jobs": r"tools/batch/job(_lines|_result)?\.",
    "json": r"map/files/parse_json|tools/files/json",
    "kitti": r"map/occupancy/clouds/read_kitti",
    "lane_table": r"map/lane_table/(geojson|geopackage|mapping|read|shapes)",
    "lanelet2": r"map/lanelet2/(?!autoware|rules|write)",
    "las": r"map/occupancy/clouds/read_las|map/occupancy/laz/|map/files/wkt_units",
    "log": r"map/logs/(bag|cdr|foxglove_poses|log|mcap\.|pose_messages|protobuf|timed_pose"
           r"|transform_tree)",
    "obstacles_csv": r"tools/files/(obstacles_csv|csv)",
    "octree": r"map/occupancy/octree/octree_file\.",
    "od_csv": r"tools/files/(points_csv|csv)",
    "open_drive": r"map/opendrive/(?!rules|write)",
    "outside_plan": r"tools/simulation/outside_planner",
    "pcd": r"map/occupancy/clouds/read_pcd",
    "pilot_lines": r"tools/simulation/pilot_lines",
    "planner_options": r"tools/simulation/planner_options",
    "ply": r"map/occupancy/clouds/read_ply",
    "points_csv": r"tools/files/(points_csv|csv)",
    "route_network": r"planning/route/stored_network",
    "scenario": r"tools/simulation/scenario\.",
    "sensor_poses": r"map/occupancy/clouds/sensor_poses",
    "tiles_index": r"map/occupancy/octree/tiles_index",
    "trajectory_csv": r"tools/files/(trajectory_csv|csv)",
    "unpack": r"map/files/unpack",
    "validate": r"map/((validation|opendrive/rules|lanelet2/(autoware|rules)|commonroad/rules)/"
                r"|suppressions)",
    "vehicle_json": r"tools/files/(vehicle_json|json)",
    "xml_scanner": r"map/files/xml(_characters|_scanner)?\.",
    "xyz": r"map/occupancy/clouds/read_xyz",
}

#: Functions beside them that read nothing: they write, or say what was read.
WRITERS = re.compile(r"write_|add_list|json_of|FileWriter")

#: Of single targets: functions and classes that open files, whose bytes the others get, that say what
#: was read, or that read a format that another target is there for.
BESIDES = {
    "autoware_vehicle": "read_vehicle read_vehicle_shape measures_text named_vehicle common_road",
    "certificate": "file_json part_json places_json observed_json times_json conflicts_json"
                   " add_ground add_claims add_parts text_of dumped read_certificate_json"
                   " files_named_by_certificate verdict certified_clearance_m measured_fraction",
    "drive_file": "of_log drive_of_rows gaps_between gaps_note jumps_note drive_of_measured read_drive"
                  " notes_text is_solution is_drive_table vehicle_of_solution",
    "drive_record": "relative_name read_drive_record check_sources file_of",
    "jobs": "hash_of hash_of_bad_line line_of line_of_bad_line line failure text_of add_file"
            " to_string may_pass one_line program json_text",
    "od_csv": "parse_point_table read_point_table column_of_axis check_width number",
    "outside_plan": "PlannerProcess shape_json line_json scene_json observation_json observe seen"
                    " outside_planner",
    "points_csv": "parse_od_csv read_point_table",
    "scenario": "read_scenario read_noise_json files_named_by_scenario apply_to is_random parse_seed",
}  # fmt: skip


def reads_nothing(name: str, function: str) -> bool:
    """Tell whether a function, as C++ writes it, is beside the readers of a target."""
    words = BESIDES.get(name, "-").replace(" ", "|")
    return bool(WRITERS.search(function) or re.search(rf"::({words})(\[abi:\w+\])?(\(|<|::)", function))


#: Other folders whose files are seeds, too.
FOLDERS = {
    "edit": "tests/fuzz/corpus/validate",
    "lanelet2": "tests/fuzz/corpus/validate",
    "open_drive": "tests/fuzz/corpus/validate",
}

#: Suffixes of files of others that are seeds, too, where ROADBED_REAL_DATA is set.
SUFFIXES = {
    "edit": (".osm", ".xodr"),
    "lanelet2": (".osm",),
    "open_drive": (".xodr",),
    "validate": (".osm", ".xodr"),
}
MOST_BYTES = 4_096  # of such a file and of what is made of it; of larger ones a few a second are read


def sources_of(name: str) -> list[Path]:
    """Return the sources of a target, and the target itself, relative to the tree."""
    files = (file.relative_to(ROOT) for folder in ("map", "planning", "tools")
             for file in (ROOT / folder).rglob("*") if file.suffix in (".h", ".cpp"))  # fmt: skip
    read = [file for file in files if re.match(SOURCES[name], str(file))]
    return sorted(read) + [Path(f"tests/fuzz/{name}_fuzz.cpp")]


def words_of(name: str) -> list[str]:
    """Return the words that a target's sources look for: short literals, for libFuzzer."""
    literal = re.compile(r'"((?:[ !#-\[\]-z|~]|\\[nt"\\])+)"')
    words = {
        word
        for file in sources_of(name)
        for line in (ROOT / file).read_text().splitlines() if not line.startswith("#include")
        for word in literal.findall(line) if len(word) <= 32 and word.count(" ") < 2
    }  # fmt: skip
    return sorted(word.replace("\\n", "\\x0A").replace("\\t", "\\x09") for word in words)


def options_of(name: str) -> list[str]:
    """Return libFuzzer's options for a target.

    Weighing features takes up to a quarter of the time, so inputs are taken as they come.
    """
    if name in SUFFIXES:
        return [f"-max_len={MOST_BYTES}", "-entropic=0"]
    # Of a packed byte of .laz a hundred points may come; rows of a table are all alike, and so are
    # lines of jobs and the parts of a JSON document of no kind.
    most_bytes = {"las": 1600, "jobs": 1024, "json": 512, "pilot_lines": 1024}.get(
        name, 512 if name.endswith("_csv") else None)  # fmt: skip
    return ["-entropic=0"] + ([f"-max_len={most_bytes}"] if most_bytes else [])


def seeds_of(name: str, build: Path) -> list[str]:
    """Return what a target starts from as its arguments: what it has found first."""
    folders = [build / "found" / f"{name}_fuzz", CORPUS / name]
    folders += [ROOT / FOLDERS[name]] if name in FOLDERS else []
    words = [str(folder) for folder in folders if folder.is_dir()]
    real = os.environ.get("ROADBED_REAL_DATA")
    if real and name in SUFFIXES:
        files = [str(file) for file in sorted(Path(real).rglob("*"))
                 if file.suffix in SUFFIXES[name] and file.stat().st_size <= MOST_BYTES]  # fmt: skip
        words.append("-seed_inputs=" + ",".join(files))
    return words
