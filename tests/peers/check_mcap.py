"""Usage: check_mcap.py ROADBED DATA
Lets ROADBED drive a scenario of the folder DATA and audit it, each with a log (MCAP), and reads the
logs by the packages `mcap`, `mcap-protobuf-support` and `rerun-sdk`:
- every message, by its schema, in order of time, as many as statistics, index and topics say;
- fields of the schemas have the numbers and types that `foxglove-schemas-protobuf` gives them;
- rows, transforms and path are those of trajectory.csv; plans and hypotheses those of cycles.jsonl,
  among the candidates the chosen end states are feasible ones; clearances,
  stretches and conflicts those of `audit --json`; occupied points those of `occupancy export`;
- what Rerun shows of them: entities, their archetypes, and how many rows each has.
Exit status 1 where they differ.
"""

import csv
import importlib
import json
import math
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from pathlib import Path

import numpy as np
from google.protobuf import descriptor_pb2
from mcap.reader import NonSeekingReader, make_reader
from mcap_protobuf.decoder import DecoderFactory
from rerun.chunk import McapReader

FIELDS = ["t_s", "x_m", "y_m", "heading_rad", "speed_mps", "acceleration_mps2", "steering_rad", "curvature_per_m"]
# What Rerun makes of a topic; of scenes, which it does not draw yet, their fields.
SHOWN = {"/tf": "Transform3D:translation", "/occupancy": "Points3D:positions", "/log": "TextLog:text",
         "/fix": "GeoPoints:positions", "/drive/path": "InstancePoses3D:translations",
         "/plan": "InstancePoses3D:translations", "/drive": "roadbed.DriveState:message",
         "/plan/hypotheses": "roadbed.Hypotheses:message", "/plan/candidates": "roadbed.Candidates:message",
         "/plan/candidate_lines": "foxglove.SceneUpdate:message",
         "/audit/clearance": "roadbed.Clearance:message"}


def run(program, *words, status=(0,)):
    done = subprocess.run([program, *words], capture_output=True, text=True)
    if done.returncode not in status:
        raise RuntimeError(f"{' '.join(map(str, words))}: {done.stderr.strip()}")
    return done.stdout


def stamp_ns(time):
    return time.seconds * 10**9 + time.nanos


class Log:
    """All that a file holds, decoded, by topic."""

    def __init__(self, file):
        self.faults = []
        self.by_topic = defaultdict(list)
        with file.open("rb") as stream:
            reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
            self.summary = reader.get_summary()
            times = []
            for schema, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
                self.by_topic[channel.topic].append((message.log_time, decoded))
                times.append(message.log_time)
                if schema.name != decoded.DESCRIPTOR.full_name:
                    self.faults.append(f"{channel.topic} is {schema.name}, read as {decoded.DESCRIPTOR.full_name}")
            self.metadata = {record.name: record.metadata for record in reader.iter_metadata()}
        with file.open("rb") as stream:  # from its beginning, without the summary
            read = sum(1 for _ in NonSeekingReader(stream, validate_crcs=True).iter_messages())
        statistics = self.summary.statistics
        if not len(times) == read == statistics.message_count:
            self.faults.append(f"{len(times)} messages by index, {read} without, {statistics.message_count} counted")
        if times != sorted(times) or (times[0], times[-1]) != (statistics.message_start_time, statistics.message_end_time):
            self.faults.append("messages are not in order of time")
        counts = {self.summary.channels[i].topic: n for i, n in statistics.channel_message_counts.items()}
        if counts != {topic: len(messages) for topic, messages in self.by_topic.items()}:
            self.faults.append(f"topics have other counts than {counts}")
        if len(self.summary.chunk_indexes) != statistics.chunk_count or statistics.chunk_count < 1:
            self.faults.append("not every chunk has an index")
        for schema in self.summary.schemas.values():
            self.faults += schema_faults(schema)

    def only(self, topic):
        (message,) = self.by_topic[topic]
        return message[1]


def schema_faults(schema):
    """Fields that Foxglove's own schema does not have."""
    files = descriptor_pb2.FileDescriptorSet.FromString(schema.data)
    for file in files.file:
        if file.package != "foxglove":
            continue
        for message in file.message_type:
            module = importlib.import_module(f"foxglove_schemas_protobuf.{message.name}_pb2")
            theirs = module.DESCRIPTOR.message_types_by_name[message.name].fields_by_name
            for field in message.field:
                other = theirs.get(field.name)
                kind = other and (other.message_type or other.enum_type)
                if other is None or (other.number, other.type, other.is_repeated, kind.full_name if kind else "") != (
                        field.number, field.type, field.label == field.LABEL_REPEATED, field.type_name.lstrip(".")):
                    yield f"{message.name}.{field.name} is not as Foxglove has it"


def drive_faults(log, folder):
    rows = [[float(row[name]) for name in FIELDS] for row in csv.DictReader((folder / "trajectory.csv").open())]
    states = [[getattr(state, name) for name in FIELDS] for _, state in log.by_topic["/drive"]]
    if states != rows:
        yield "/drive is not trajectory.csv, bit for bit"
    if any(abs(time - 1e9 * state.t_s) > 0.5 or stamp_ns(state.timestamp) != time
           for time, state in log.by_topic["/drive"]):
        yield "/drive: times are not those of the rows"
    (_, scene), *moves = [entry for entry in log.by_topic["/tf"]]
    origin = np.array([scene.translation.x, scene.translation.y])
    if (scene.parent_frame_id, scene.child_frame_id) != ("map", "scene"):
        yield "/tf does not begin with the scene in the map"
    for (_, move), row in zip(moves, rows, strict=True):
        heading = 2 * math.atan2(move.rotation.z, move.rotation.w)
        if (move.parent_frame_id, move.child_frame_id) != ("map", "base_link") or (
                move.translation.x, move.translation.y) != (row[1], row[2]) or abs(
                math.remainder(heading - row[3], 2 * math.pi)) > 1e-12:
            yield f"/tf at {row[0]} s is another pose"
    path = [[pose.position.x, pose.position.y] for pose in log.only("/drive/path").poses]
    if not np.array_equal(np.array(path), np.array(rows)[:, 1:3] - origin):
        yield "/drive/path is not the drive"


def plan_faults(log, folder):
    cycles = [json.loads(line) for line in (folder / "cycles.jsonl").open()]
    plans = {time: plan for time, plan in log.by_topic["/plan"]}
    planned = [cycle for cycle in cycles if cycle.get("chosen")]
    if len(plans) < len(planned) or not planned:
        yield f"/plan has {len(plans)} messages, cycles.jsonl {len(planned)} plans"
    for cycle in planned:
        plan = plans.get(round(1e9 * cycle["t_s"]))
        if plan is None or len(plan.poses) < 2:
            yield f"/plan has none at {cycle['t_s']} s"
    yield from considered_faults(log, cycles)
    texts = [text.name for _, text in log.by_topic["/log"]]
    if "verdict" not in texts or len(texts) < 2:
        yield f"/log says {texts}"


def considered_faults(log, cycles):
    def number(value):
        return None if math.isnan(value) else value

    told = {time: [{"maneuver": one.maneuver, "d_e_m": number(one.end_d_m), "l_e_m": number(one.end_l_m),
                    "path_cost": number(one.path_cost), "drive_cost": number(one.drive_cost),
                    "driven": one.is_driven, "reason": one.reason} for one in message.hypotheses]
            for time, message in log.by_topic["/plan/hypotheses"]}
    if told != {round(1e9 * cycle["t_s"]): cycle["hypotheses"] for cycle in cycles if cycle["hypotheses"]}:
        yield "/plan/hypotheses are not those of cycles.jsonl"
    grids = {time: message for time, message in log.by_topic["/plan/candidates"]}
    chosen = [cycle for cycle in cycles if cycle.get("chosen")]
    if len(grids) < len(chosen):
        yield f"/plan/candidates has {len(grids)} messages for {len(chosen)} plans"
    for cycle in chosen:
        grid = grids[round(1e9 * cycle["t_s"])]
        causes = np.frombuffer(grid.causes, np.uint8)
        feasible = list(grid.cause_names).index("none")
        if len(causes) != len(grid.end_d_m) * len(grid.end_l_m) or causes.max() >= len(grid.cause_names):
            yield f"/plan/candidates at {cycle['t_s']} s has {len(causes)} causes"
        elif feasible not in causes:
            yield f"/plan/candidates at {cycle['t_s']} s has no feasible one, and one was chosen"
    yield from candidate_line_faults(log, grids)


def beside(points, stations, offsets):
    """Places beside a line, at stations of it; an offset is to the left."""
    pieces = np.diff(points, axis=0)
    lengths = np.linalg.norm(pieces, axis=1)
    begins = np.concatenate([[0], np.cumsum(lengths)[:-1]])
    at = np.clip(np.searchsorted(begins, stations, side="right") - 1, 0, len(lengths) - 1)
    ahead = pieces[at] / lengths[at, None]
    along = np.clip(stations - begins[at], 0, lengths[at])
    return points[at] + along[:, None] * ahead + offsets[:, None] * np.stack([-ahead[:, 1], ahead[:, 0]], 1)


def candidate_line_faults(log, grids):
    """Each line ends where one of the grid does that was rejected for what its entity is named."""
    (reference,) = [entity for entity in log.only("/scene/route").entities if entity.id == "reference 1"]
    line = np.array([[point.x, point.y] for point in reference.lines[0].points])
    drawn = dict(log.by_topic["/plan/candidate_lines"])
    if drawn.keys() != grids.keys():
        yield f"/plan/candidate_lines has {len(drawn)} messages for {len(grids)} grids"
        return
    for time, update in drawn.items():
        grid = grids[time]
        d_m, l_m, names = np.array(grid.end_d_m), np.array(grid.end_l_m), list(grid.cause_names)
        causes = np.frombuffer(grid.causes, np.uint8).reshape(len(l_m), len(d_m))
        start_m = beside(line, np.array([grid.start_s_m]), np.array([grid.start_d_m]))
        ends_m = beside(line, grid.start_s_m + np.repeat(l_m, len(d_m)), np.tile(d_m, len(l_m))).reshape(*causes.shape, 2)
        count = sum(len(entity.lines) for entity in update.entities)
        if not 1 <= count <= 48 or len(update.deletions) != 1:
            yield f"/plan/candidate_lines at {time} ns has {count} lines"
        for entity in update.entities:
            cause = names.index("none" if entity.id == "feasible" else entity.id)
            if dict((word.key, word.value) for word in entity.metadata)["candidates"] != str((causes == cause).sum()):
                yield f"/plan/candidate_lines at {time} ns counts others of {entity.id}"
            ends = ends_m[causes == cause]
            for drawn_line in entity.lines:
                first, last = ([place.x, place.y] for place in (drawn_line.points[0], drawn_line.points[-1]))
                if np.abs(start_m - first).max() > 1e-6 or np.linalg.norm(ends - last, axis=1).min() > 1e-6:
                    yield f"/plan/candidate_lines at {time} ns: {entity.id} goes from {first} to {last}"


def scene_faults(log):
    if len(log.only("/scene/lanes").entities) < 1:
        yield "/scene/lanes is empty"
    (vehicle,) = log.only("/scene/vehicle").entities
    if vehicle.frame_id != "base_link" or not vehicle.frame_locked or len(vehicle.cubes) < 1:
        yield "/scene/vehicle does not go with base_link"
    for _, update in log.by_topic.get("/scene/obstacles", []):
        if len(update.deletions) != 1 or any(len(entity.cubes) != 1 for entity in update.entities):
            yield "/scene/obstacles is not what is there at a time"


def occupancy_faults(log, program, octree, folder):
    run(program, "occupancy", "export", octree, "-o", folder / "all.ply", "--force")
    head, body = (folder / "all.ply").read_bytes().split(b"end_header\n", 1)
    kind = "<f8" if b"double" in head else "<f4"
    exported = np.frombuffer(body, kind).reshape(-1, 3).astype(float)
    cloud = log.only("/occupancy")
    points = np.frombuffer(cloud.data, "<f4").reshape(-1, cloud.point_stride // 4)
    if [(field.name, field.offset, field.type) for field in cloud.fields] != [
            (name, 4 * i, 7) for i, name in enumerate(["x", "y", "z", "size"])]:
        yield "/occupancy has other fields"
    origin = log.by_topic["/tf"][0][1].translation
    places = points[:, :3].astype(float) + [origin.x, origin.y, 0]
    known = {tuple(np.round(place, 2)) for place in exported}
    unknown = sum(tuple(np.round(place, 2)) not in known for place in places)
    if unknown or len(places) == 0 or len(set(map(tuple, np.round(places, 2)))) != len(places):
        yield f"/occupancy: {unknown} of {len(places)} points are no occupied cell"


def audit_faults(log, audit):
    clearances = {time: value.clearance_m for time, value in log.by_topic["/audit/clearance"]}
    if not clearances or abs(min(clearances.values()) - audit["least_clearance_m"]) > 0.02:
        yield "/audit/clearance has another least value"
    entities = log.only("/audit").entities
    stretches = [{pair.key: pair.value for pair in entity.metadata} for entity in entities if entity.id.startswith("stretch")]
    conflicts = [entity for entity in entities if entity.id.startswith("conflict")]
    shown = [(part["verdict"], float(part["from_s"]), float(part["to_s"])) for part in stretches]
    if shown != [(part["verdict"], part["from_s"], part["to_s"]) for part in audit["stretches"]]:
        yield f"/audit shows {shown}"
    if len(conflicts) != len(audit["conflicts"]) or not conflicts:
        yield f"/audit shows {len(conflicts)} conflicts, not {len(audit['conflicts'])}"
    if log.metadata["roadbed"]["verdict"].split(":")[0] != audit["verdict"]:
        yield f"the metadata says {log.metadata['roadbed']}"


def rerun_faults(log, file):
    """What Rerun's reader makes of the topics: how many rows have the component that it shows."""
    rows = Counter()
    for chunk in McapReader(str(file)).stream().to_chunks():
        for name in chunk.to_record_batch().schema.names:
            rows[str(chunk.entity_path), name] += chunk.num_rows
    for topic, messages in log.by_topic.items():
        component = SHOWN.get(topic, "foxglove.SceneUpdate:message")
        if rows[topic, component] != len(messages):
            yield f"Rerun has {rows[topic, component]} of {len(messages)} rows of {topic} as {component}"


def main():
    program, data, faults = sys.argv[1], Path(sys.argv[2]), []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        drive = folder / "drive"
        run(program, "--quiet", "simulate", data / "drive.json", "--candidates", "--mcap", "-o", drive)
        again = folder / "again"
        run(program, "--quiet", "simulate", data / "drive.json", "--candidates", "--mcap", "-o", again)
        if (drive / "drive.mcap").read_bytes() != (again / "drive.mcap").read_bytes():
            faults.append("another drive.mcap the second time")
        question = ["--occupancy", data / "town.bt", "--map", data / "town.xodr", "--clearance", "0.4", "--trajectory"]
        audit = json.loads(run(program, "--quiet", "audit", *question, drive / "trajectory.csv", "--mcap",
                               folder / "audit.mcap", "--json", status=(0, 1)))
        for file in (drive / "drive.mcap", folder / "audit.mcap"):
            log = Log(file)
            found = [*log.faults, *drive_faults(log, drive), *scene_faults(log)]
            if file.parent == drive:
                found += plan_faults(log, drive)
            else:
                found += audit_faults(log, audit)
                found += occupancy_faults(log, program, data / "town.bt", folder)
            found += rerun_faults(log, file)
            print(f"{file.name}: {file.stat().st_size} bytes, "
                  + ", ".join(f"{topic} {len(messages)}" for topic, messages in sorted(log.by_topic.items())))
            faults += [f"{file.name}: {fault}" for fault in found]
        # Back through roadbed's own reader, and another audit of the same drive.
        run(program, "--quiet", "audit", *question, drive / "drive.mcap", "--save-drive", folder / "back.csv",
            status=(0, 1))
        if (folder / "back.csv").read_bytes() != (drive / "trajectory.csv").read_bytes():
            faults.append("the drive of drive.mcap is not trajectory.csv, byte for byte")
    print("\n".join(faults[:20]))
    print("MCAP: " + ("equal" if not faults else f"{len(faults)} differences"))
    return 1 if faults else 0


sys.exit(main())
