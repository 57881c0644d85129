#!/usr/bin/env python3
"""Looks for what Autoware asks of a map's tags and members without roadbed, and compares.

Usage: check_autoware_rules.py ROADBED MAP.osm...

Of each rule below the elements that `roadbed validate --profile autoware` finds an error at are those
that are found here, in the text alone. Other rules need geometry. Prints a row per map; exit status 1
if one differs.
"""
import json
import subprocess
import sys
import xml.etree.ElementTree as xml
from collections import defaultdict
from dataclasses import dataclass

LEAST_KMH, MOST_KMH = 10.0, 50.0  # that the validator allows unless told otherwise


@dataclass
class Element:
    tags: dict
    nodes: list
    members: list  # (kind, id, role)

    def of_role(self, wanted):
        return [ref for _, ref, role in self.members if role == wanted]


def read(file):
    """Ways and relations by id."""
    found = {"way": {}, "relation": {}}
    for element in xml.parse(file).getroot():
        if element.tag in found:
            found[element.tag][element.get("id")] = Element(
                {tag.get("k"): tag.get("v") for tag in element.iter("tag")},
                [node.get("ref") for node in element.iter("nd")],
                [(member.get("type"), member.get("ref"), member.get("role"))
                 for member in element.iter("member")])
    return found["way"], found["relation"]


def is_usual_speed(text):
    """No limit is one."""
    if text is None:
        return True
    try:
        return LEAST_KMH <= float(text) <= MOST_KMH
    except ValueError:
        return False


def of_rules(ways, relations):
    """Ids of the elements at fault, by rule."""
    lanelets = {i: one for i, one in relations.items() if one.tags.get("type") == "lanelet"}
    roads = [one for one in lanelets.values() if one.tags.get("subtype") == "road"]
    rules = [one for one in relations.values() if one.tags.get("type") == "regulatory_element"]
    between = ({way for one in roads for way in one.of_role("left")}
               & {way for one in roads for way in one.of_role("right")})
    in_use = {ref for one in rules for kind, ref, _ in one.members if kind == "way"}
    crossed = {ref for one in rules if one.tags.get("subtype") == "crosswalk"
               for _, ref, _ in one.members}

    def shares_points(one):
        left, right = (set(ways[one.of_role(side)[0]].nodes) for side in ("left", "right"))
        return left & right

    def lacks_lights(one):
        named = [ways[way].tags.get("traffic_light_id", "") for way in one.of_role("light_bulbs")]
        lights = one.of_role("refers")
        return len(named) == len(lights) and sorted(named) != sorted(lights)

    return {
        "autoware.lane.lane-change":
            {way for way in between if ways[way].tags.get("lane_change") not in ("yes", "no")},
        "autoware.lane.speed-limit":
            {i for i, one in lanelets.items() if one.tags.get("subtype") == "road"
             and not is_usual_speed(one.tags.get("speed_limit"))},
        "autoware.lane.shared-points": {i for i, one in lanelets.items() if shares_points(one)},
        "autoware.intersection.area-tag":
            {i for i, one in lanelets.items()
             if one.tags.get("turn_direction") and not one.tags.get("intersection_area")},
        "autoware.crosswalk.missing-regulation":
            {i for i, one in lanelets.items()
             if one.tags.get("subtype") == "crosswalk" and i not in crossed},
        "autoware.stop-line.missing-regulation":
            {i for i, one in ways.items()
             if one.tags.get("type") == "stop_line" and i not in in_use},
        "autoware.traffic-light.regulation-details":
            {i for i, one in relations.items()
             if one.tags.get("subtype") == "traffic_light" and lacks_lights(one)},
    }  # fmt: skip


#: Which of a rule's findings are about tags and members; all where it is not named.
ABOUT = {
    "autoware.intersection.area-tag": "has turn_direction=",
    "autoware.traffic-light.regulation-details": "do not name its lights one by one",
}


def found_by(roadbed, file):
    done = subprocess.run([roadbed, "validate", file, "--profile", "autoware", "--json"],
                          capture_output=True, text=True, check=False)
    found = defaultdict(set)
    for finding in json.loads(done.stdout)["findings"]:
        rule = finding["rule"]
        if finding["severity"] == "error" and ABOUT.get(rule, "") in finding["message"]:
            found[rule].add(finding["element"].split()[-1])
    return found


def main():
    roadbed, *files = sys.argv[1:]
    status = 0
    for file in files:
        mine, theirs = of_rules(*read(file)), found_by(roadbed, file)
        differ = {rule: sorted(ids ^ theirs[rule]) for rule, ids in mine.items()
                  if ids != theirs[rule]}  # fmt: skip
        name = file.rsplit("/", 1)[-1]
        print(f"{name}: {sum(map(len, mine.values()))} elements by {len(mine)} rules, "
              + (f"BAD: {differ}" if differ else "the same"))
        status = 1 if differ else status
    return status


if __name__ == "__main__":
    sys.exit(main())
