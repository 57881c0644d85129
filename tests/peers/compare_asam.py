#!/usr/bin/env python3
"""Judges OpenDRIVE files with roadbed and with ASAM's own checker bundle, and compares.

usage: compare_asam.py ROADBED MAP.xodr...      needs the PyPI package asam-qc-opendrive

Every rule of theirs has to be in `roadbed validate --rules`. Then, for every file and each of their
rules that they ran on it: did both find something, or neither? Rules that they skip (all of them,
where the file does not fit the schema) are not compared. What differs for a known reason is listed
with it; anything else is a disagreement, which a last line counts: exit status 1 if there is any."""
import collections
import importlib
import json
import logging
import pkgutil
import re
import subprocess
import sys
import tempfile
from pathlib import Path

logging.disable(logging.CRITICAL)

from qc_baselib import Configuration, Result  # noqa: E402
from qc_opendrive import constants  # noqa: E402
from qc_opendrive import main as checker  # noqa: E402

# (rule, who alone finds something) → why that is right or harmless.
RANGE = "theirs names the range of every curve of wrong length, ours where the other range has it"
REASONS = {
    ("road.geometry.parampoly3.normalized_range", "theirs"): RANGE,
    ("road.geometry.parampoly3.arclength_range", "theirs"): RANGE,
    ("road.geometry.parampoly3.length_match", "ours"):
        "theirs measures curves of range normalized only, the standard asks both",
    ("performance.avoid_redundant_info", "ours"):
        "theirs compares polynomials carried back to s = 0, where rounding grows with s³; ours what "
        "they say where they hold",
    ("performance.avoid_redundant_info", "theirs"):
        "a record at the very end of its road holds nowhere: many programs write one, which ours "
        "does not count",
    ("lane_smoothness.contact_point_no_horizontal_gaps", "theirs"):
        "theirs has the gaps between a road's own curves in it, for which the standard has a name "
        "of their own, road.geometry.refline_no_gaps; ours says that",
}


# Slips in the faultless file of the tests, of revision 1.8: (rule, from, to). Each of their rules
# has to find its slip, and so have ours; the only one for revision 1.7 alone is not here.
SLIPS = (
    ("xml.valid_xml_document", "</OpenDRIVE>", ""),
    ("xml.root_tag_is_opendrive", "OpenDRIVE>", "OpenDrive>"),
    ("xml.fileheader_is_present", r"(?s)<header.*?</header>", ""),
    ("xml.version_is_defined", 'revMinor="8"', 'revMinor="eight"'),
    ("xml.valid_schema", ' hdg="0" length="40"', ' length="40"'),
    ("xml.valid_schema", 'version="1.00"', 'version="1.00" north="far"'),
    ("xml.valid_schema", ' junction="-1"', ""),
    ("xml.valid_schema", '<type s="0" type="town"', '<type s="0" type="Town"'),
    ("xml.valid_schema", ' rule="allow"', ' rule="Allow"'),
    ("xml.valid_schema", '<width sOffset="0"', '<width sOffset="-1"'),
    ("road.lane.level_true_one_side", '<lane id="-1" type="driving" level="false">\n      <border',
     '<lane id="-1" type="driving" level="true">\n      <border'),
    ("road.lane.access.no_mix_of_deny_or_allow", "<access ",
     '<access sOffset="0.0000001" rule="deny" restriction="bus"/><access '),
    ("road.lane.link.lanes_across_lane_sections", '<predecessor id="-2"/><successor id="-2"/>',
     '<successor id="-2"/>'),
    ("road.linkage.is_junction_needed",
     '<link><predecessor elementType="junction" elementId="10"/></link>',
     '<link><predecessor elementType="road" elementId="1" contactPoint="end"/></link>'),
    ("road.lane.link.zero_width_at_start", '<width sOffset="0" a="1.50" b="0"',
     '<width sOffset="0" a="0" b="0.0375"'),
    ("road.lane.link.zero_width_at_end", '<width sOffset="0" a="1.5" b="0"',
     '<width sOffset="0" a="1.5" b="-0.025"'),
    ("road.lane.link.new_lane_appear", '<width sOffset="0" a="1.50" b="0"',
     '<width sOffset="0" a="0" b="0.0375"'),
    ("junctions.connection.connect_road_no_incoming_road", 'incomingRoad="2"', 'incomingRoad="3"'),
    ("junctions.connection.one_link_to_incoming", "</connection>",
     '</connection><connection id="1" incomingRoad="2" connectingRoad="3" contactPoint="start">'
     '<laneLink from="-1" to="-1"/></connection>'),
    ("junctions.connection.one_link_to_incoming", '<laneLink from="-1" to="-1"/>',
     '<laneLink from="1" to="-1"/>'),
    ("junctions.connection.start_along_linkage", 'incomingRoad="2"', 'incomingRoad="4"'),
    ("junctions.connection.end_opposite_linkage", 'connectingRoad="3" contactPoint="start"',
     'connectingRoad="3" contactPoint="end"'),
    ("road.geometry.parampoly3.length_match", 'bU="10"', 'bU="10.002"'),
    ("road.geometry.parampoly3.normalized_range", 'bU="10"', 'bU="1"'),
    ("road.geometry.parampoly3.arclength_range", 'bU="1" ', 'bU="10" '),
    ("road.lane.border.overlap_with_inner_lanes", '<border sOffset="0" a="-5" b="0"',
     '<border sOffset="0" a="-5" b="0.05"'),
    ("performance.avoid_redundant_info", '<width sOffset="0" a="1.50"',
     '<width sOffset="0" a="1.50" b="0" c="0" d="0"/><width sOffset="30" a="1.50"'),
    ("lane_smoothness.contact_point_no_horizontal_gaps", 'a="3.5" b="0" c="0.0000002"',
     'a="3.7" b="0" c="0.0000002"'),
)


def their_modules():
    for group in ("basic", "schema", "semantic", "geometry", "performance", "smoothness"):
        package = importlib.import_module(f"qc_opendrive.checks.{group}")
        for entry in pkgutil.iter_modules(package.__path__):
            module = importlib.import_module(f"{package.__name__}.{entry.name}")
            if hasattr(module, "RULE_UID"):
                yield module


def their_findings(file):
    """Number of issues by rule, of the rules that were run to their end."""
    configuration, result = Configuration(), Result()
    configuration.set_config_param("InputFile", str(file))
    result.register_checker_bundle(name=constants.BUNDLE_NAME, description="", summary="",
                                   version=constants.BUNDLE_VERSION)
    result.set_result_version(version=constants.BUNDLE_VERSION)
    checker.run_checks(configuration, result)
    found = {}
    for module in their_modules():
        status = result.get_checker_status(module.CHECKER_ID)
        if status is not None and status.value == "completed":
            found[module.RULE_UID] = len(result.get_issues_by_rule_uid(module.RULE_UID))
    return found


def our_findings(roadbed, file):
    run = subprocess.run([roadbed, "validate", file, "--quiet", "--json"], stdout=subprocess.PIPE,
                         text=True)
    return collections.Counter(finding["asam_rule"]
                               for finding in json.loads(run.stdout)["findings"])


def missing_rules(roadbed):
    run = subprocess.run([roadbed, "validate", "--rules"], stdout=subprocess.PIPE, text=True,
                         check=True)
    return [m.RULE_UID for m in their_modules()
            if m.RULE_UID.removeprefix("asam.net:xodr:") not in run.stdout]


def missed_slips(roadbed):
    """Prints which of the slips theirs or ours do not find; how many."""
    file = Path(__file__).parent / "../map/opendrive/rules/clean.xodr"
    faultless = file.read_text().replace('revMinor="7"', 'revMinor="8"')
    uids = {module.RULE_UID.split(":", 3)[3]: module.RULE_UID for module in their_modules()}
    missed = 0
    with tempfile.TemporaryDirectory() as folder:
        slipped = Path(folder) / "slip.xodr"
        for rule, found, replacement in (("", "", ""), *SLIPS):
            pattern = found if found.startswith("(?s)") else re.escape(found)
            slipped.write_text(re.sub(pattern, lambda _: replacement, faultless,
                                      count=2 if "root" in rule else 1))
            theirs, ours = their_findings(slipped), our_findings(roadbed, slipped)
            if not rule:
                expected = not any(theirs.values()) and not any(ours[uid] for uid in uids.values())
            else:
                expected = theirs.get(uids[rule]) and ours[uids[rule]]
            if not expected:
                missed += 1
                print(f"slip {rule or 'none'}: theirs find {theirs.get(uids.get(rule))}, "
                      f"ours {ours[uids.get(rule)]}")
    print(f"{len(SLIPS)} slips of all rules but one, {missed} not found by both")
    return missed


def main():
    roadbed, files = sys.argv[1], sys.argv[2:]
    missing = missing_rules(roadbed)
    rules = [module.RULE_UID for module in their_modules()]
    print(f"{len(rules)} rules of theirs, missing in ours: {', '.join(missing) or 'none'}")
    missed = missed_slips(roadbed)
    counts = collections.Counter()
    for file in files:
        theirs, ours = their_findings(file), our_findings(roadbed, file)
        for rule, number in sorted(theirs.items()):
            if bool(number) == bool(ours[rule]):
                counts["both find something" if number else "both find nothing"] += 1
                continue
            who = "ours" if ours[rule] else "theirs"
            reason = REASONS.get((rule.split(":", 3)[3], who))
            counts["known" if reason else "disagreements"] += 1
            print(f"{Path(file).name}: {rule}: {who} only, {max(number, ours[rule])}: "
                  f"{reason or 'NOT KNOWN'}")
    print(f"{len(files)} files: " + ", ".join(f"{number} {what}" for what, number in
                                              sorted(counts.items())))
    sys.exit(bool(missing or missed or counts["disagreements"]))


if __name__ == "__main__":
    main()
