#!/usr/bin/env python3
"""Judges the nets for SUMO that roadbed writes: netconvert warns of nothing, duarouter routes alike.

Usage: check_sumo.py ROADBED [--pairs N] MAP...      needs the PyPI package eclipse-sumo

Pairs are random edges for cars. duarouter takes the way of least time with one speed everywhere,
roadbed the shortest from any lane of the first edge to any lane of the last one, as SUMO's routes
leave the lane open. There is to be no way for both, or the same edges, or ways that are as long. Where
roadbed finds none as a marking may not be crossed, or there is no room for a change, a way of edges
says nothing: these pairs are counted apart. The lanes' ends are to be the map's within a metre; where
more than one in ten are not, it is said. Prints a row per map; exit status 1 if one fails."""
import argparse
import csv
import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import sumo
import sumolib

KNOWN = {
    "very large coordinates": "x and y stay the source's own, which SUMO's GUI shows less finely",
}
BY_LANE = ("marking", "room", "change", "cross")  # words of reasons that edges know nothing of


def run(*words, **options):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)


class Net:
    """What netconvert makes of a map, with the map's lanes of each edge."""

    def __init__(self, file):
        self.net = sumolib.net.readNet(str(file), withInternal=True)
        self.lanes, self.group_of_lane, against, whole = {}, {}, set(), {}
        for edge in ElementTree.parse(file).getroot().iter("edge"):
            if edge.get("function") == "internal":
                continue
            for lane in edge.iter("lane"):
                words = {param.get("key"): param.get("value") for param in lane.iter("param")}
                if self.net.getLane(lane.get("id")).allows("passenger"):
                    self.lanes.setdefault(edge.get("id"), []).append(words["origId"])
                if "against" in words:
                    against.add(edge.get("id"))
                whole.setdefault(words["origId"], []).append(edge.get("id"))
        parts = {edge for edges in whole.values() if len(edges) > 1 for edge in edges}
        self.plain = sorted(edge for edge in self.lanes if edge not in against | parts)
        # Edges that share a lane, as parts of one or its two directions, are one group.
        self.group = {edge: edge for edge in self.lanes}
        for edges in whole.values():
            known = [edge for edge in edges if edge in self.group]
            for edge in known[1:]:
                self.merge(known[0], edge)
        self.group_of_lane = {lane: self.name(edge) for edge, lanes in self.lanes.items() for lane in lanes}

    def name(self, edge):
        while self.group[edge] != edge:
            edge = self.group[edge]
        return edge

    def merge(self, one, other):
        self.group[self.name(other)] = self.name(one)

    def groups_of_edges(self, edges):
        return without_repeats(self.name(edge) for edge in edges if edge in self.group)

    def groups_of_lanes(self, lanes):
        return without_repeats(self.group_of_lane[lane] for lane in lanes if lane in self.group_of_lane)

    def length_m(self, edges):
        """Of a way, from the middle of its first edge to the middle of its last one."""
        half = 0.5 * sum(self.net.getEdge(edge).getLength() for edge in (edges[0], edges[-1]))
        between = sum(self.net.getEdge(edge).getLength() for edge in edges[1:-1])
        across = sum(self.across_m(a, b) for a, b in zip(edges, edges[1:]))
        return half + between + across

    def across_m(self, a, b):
        """Of the shortest connection from an edge to the next one."""
        ways = []
        for connection in self.net.getEdge(a).getConnections(self.net.getEdge(b)):
            length_m, via = 0.0, connection.getViaLaneID()
            while via:
                lane = self.net.getLane(via)
                length_m += lane.getLength()
                onward = lane.getOutgoing()
                via = onward[0].getViaLaneID() if onward else ""
            ways.append(length_m)
        return min(ways, default=0.0)


def without_repeats(names):
    kept = []
    for name in names:
        if not kept or kept[-1] != name:
            kept.append(name)
    return kept


def duarouter_ways(net_file, pairs, scratch):
    """Edges by pair; None where there is no way."""
    even, trips, routes = scratch / "even.net.xml", scratch / "trips.xml", scratch / "routes.xml"
    even.write_text(re.sub(r' speed="[^"]*"', ' speed="10.00"', net_file.read_text("utf-8")), "utf-8")
    with open(trips, "w", encoding="utf-8") as file:
        file.write('<routes><vType id="car" vClass="passenger" maxSpeed="10"/>\n')
        for i, (a, b) in enumerate(pairs):
            file.write(f'<trip id="{i}" type="car" depart="{i}" from="{a}" to="{b}"/>\n')
        file.write("</routes>\n")
    done = run(Path(sumo.SUMO_HOME) / "bin" / "duarouter", "-n", even, "-t", trips, "-o", routes,
               "--ignore-errors", "--no-warnings", "--xml-validation", "never")
    if done.returncode:
        raise SystemExit(done.stderr)
    ways = [None] * len(pairs)
    for vehicle in ElementTree.parse(routes).getroot().iter("vehicle"):
        ways[int(vehicle.get("id"))] = vehicle.find("route").get("edges").split()
    return ways


def roadbed_ways(roadbed, source, net, pairs, scratch, lengths):
    """By pair the shortest row of answers, from any lane to any lane."""
    asked, answers, owner = scratch / "pairs.csv", scratch / "answers.csv", []
    with open(asked, "w", encoding="utf-8") as file:
        file.write("from,to\n")
        for i, (a, b) in enumerate(pairs):
            for start in net.lanes[a]:
                for goal in net.lanes[b]:
                    file.write(f'"lane:{start}@{0.5 * lengths[start]:.3f}",'
                               f'"lane:{goal}@{0.5 * lengths[goal]:.3f}"\n')
                    owner.append(i)
    done = run(roadbed, "route", source, "--batch", asked, "-o", answers, "--force", "--cost", "distance",
               "--lane-change-cost", "0", "--u-turn-cost", "0", "--least-lane-change", "0")
    if done.returncode not in (0, 1):
        raise SystemExit(done.stderr)
    best = [None] * len(pairs)
    with open(answers, newline="", encoding="utf-8") as file:
        for i, row in zip(owner, csv.DictReader(file)):
            key = (row["found"] != "1", float(row["length_m"] or 0.0))
            if best[i] is None or key < best[i][0]:
                best[i] = (key, row)
    return [row for _, row in best]


def lane_lines(roadbed, source, scratch):
    """Of each lane its length, first and last point."""
    listed = scratch / "lines.csv"
    run(roadbed, "export", source, "-o", listed, "--force", check=True)
    lines = {}
    with open(listed, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["line"] == "centre":
                names = [row[key] for key in ("road", "section", "lane") if row[key] != ""]
                name = "/".join(names) if row["road"] else row["lane"]
                lines.setdefault(name, []).append((float(row["x_m"]), float(row["y_m"]), float(row["s_m"])))
    return lines


def cut_lanes(net_file, lines):
    """Lanes of whole edges whose ends are more than a metre from the map's, and how many there are."""
    cut = count = 0
    for edge in ElementTree.parse(net_file).getroot().iter("edge"):
        for lane in edge.iter("lane"):
            words = {param.get("key"): param.get("value") for param in lane.iter("param")}
            line = lines.get(words.get("origId"))
            if line is None or ".cut" in edge.get("from") + edge.get("to") or "against" in words:
                continue
            shape = [tuple(map(float, point.split(",")))[:2] for point in lane.get("shape").split()]
            off_m = max(math.dist(shape[0], line[0][:2]), math.dist(shape[-1], line[-1][:2]))
            count, cut = count + 1, cut + (off_m > 1.0)
    return cut, count


def judge(net, a_way, row):
    """What becomes of a pair: same, tie, none, by_lane or BAD."""
    found = row["found"] == "1"
    if a_way is None or not found:
        if a_way is None and not found:
            return "none"
        return "by_lane" if any(word in row["reason"] for word in BY_LANE) else "BAD"
    if net.groups_of_edges(a_way) == net.groups_of_lanes(row["lanes"].split()):
        return "same"
    length_m = float(row["length_m"])
    return "tie" if abs(net.length_m(a_way) - length_m) < 3.0 + 0.01 * length_m else "BAD"


def check(roadbed, source, count, scratch):
    environment = dict(os.environ, SUMO_HOME=sumo.SUMO_HOME)
    net_file = scratch / "map.net.xml"
    done = run(roadbed, "export", source, "-o", net_file, "--force", "--json", env=environment)
    if done.returncode:
        print(f"BAD {Path(source).name}: {done.stderr.strip()}")
        return False
    notes = [note for note in json.loads(done.stdout)["notes"] if note.startswith("netconvert: ")]
    warnings = [note for note in notes if not any(word in note for word in KNOWN)]
    net = Net(net_file)
    lines = lane_lines(roadbed, source, scratch)
    lengths = {name: line[-1][2] for name, line in lines.items()}
    draw = random.Random(20261126)
    usable = [edge for edge in net.plain if all(lane in lengths for lane in net.lanes[edge])]
    pairs = [tuple(draw.sample(usable, 2)) for _ in range(count)] if len(usable) > 1 else []
    theirs = duarouter_ways(net_file, pairs, scratch)
    ours = roadbed_ways(roadbed, source, net, pairs, scratch, lengths)
    kinds = [judge(net, a_way, row) for a_way, row in zip(theirs, ours)]
    cut, lanes = cut_lanes(net_file, lines)
    fine = not warnings and "BAD" not in kinds and pairs
    print(f"{'ok ' if fine else 'BAD'} {Path(source).name}: {len(net.lanes)} edges for cars; {len(kinds)} pairs: "
          f"{kinds.count('same')} the same way, {kinds.count('tie')} as long, {kinds.count('none')} no way, "
          f"{kinds.count('by_lane')} by the lane's rules, {kinds.count('BAD')} differ; "
          f"{len(warnings)} warnings; {cut} of {lanes} lanes cut by more than 1 m", flush=True)
    for note in warnings[:5]:
        print("    " + note)
    differ = [one for one in zip(pairs, theirs, ours, kinds) if one[3] == "BAD"]
    for pair, a_way, row, _ in differ[:3]:
        print(f"    {pair[0]} to {pair[1]}: duarouter {a_way}; roadbed {row['lanes'] or row['reason']} "
              f"{row['length_m']} m")
    return bool(fine)


def main():
    options = argparse.ArgumentParser()
    options.add_argument("roadbed")
    options.add_argument("--pairs", type=int, default=100)
    options.add_argument("maps", nargs="+")
    options = options.parse_args()
    fine = []
    for source in options.maps:
        with tempfile.TemporaryDirectory() as scratch:
            fine.append(check(options.roadbed, source, options.pairs, Path(scratch)))
    return 0 if all(fine) else 1


if __name__ == "__main__":
    sys.exit(main())
