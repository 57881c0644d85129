#!/usr/bin/env python3
"""Draws the town's crossing as it is written for OpenDRIVE, for Autoware and for SUMO.

Usage: make_written_maps.py ROADBED PICTURE.svg

Each panel is drawn from the written file alone: lanes of the OpenDRIVE as they are read again;
lanelets, intersection area, stop lines and lights of the vector map; edges, nodes and connections
of the net.
"""
import csv
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

HERE = pathlib.Path(__file__).resolve().parent
X, Y, HALF, PANEL, GAP = 300.0, 200.0, 36.0, 360.0, 18.0
COLOURS = {"driving": "#9aa5b1", "road": "#9aa5b1", "sidewalk": "#e4d9c6", "shoulder": "#c9d1d9",
           "road_shoulder": "#c9d1d9", "pedestrian_lane": "#e4d9c6", "parking": "#b8c4d6"}


def in_view(points):
    return any(abs(x - X) < HALF and abs(y - Y) < HALF for x, y in points)


def path(points, **style):
    if not in_view(points):
        return ""
    scale = PANEL / (2 * HALF)
    text = " ".join(f"{(x - X + HALF) * scale:.2f},{(Y + HALF - y) * scale:.2f}" for x, y in points)
    look = " ".join(f'{key.replace("_", "-")}="{value}"' for key, value in style.items())
    return f'<poly{"gon" if style.get("fill", "none") != "none" else "line"} points="{text}" {look}/>'


def open_drive(roadbed, town, scratch):
    run(roadbed, town, scratch / "town.xodr")
    run(roadbed, scratch / "town.xodr", scratch / "lines.csv")
    lanes = {}
    with open(scratch / "lines.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            lane = lanes.setdefault((row["road"], row["section"], row["lane"], row["type"]), {})
            lane.setdefault(row["line"], []).append((float(row["x_m"]), float(row["y_m"])))
    for (*_, kind), lane in lanes.items():
        yield path(lane["left"] + lane["right"][::-1], fill=COLOURS.get(kind, "#dfe3e8"),
                   fill_opacity=0.75, stroke="#ffffff", stroke_width=0.8)
    for (*_, kind), lane in lanes.items():
        if kind == "driving":
            yield path(lane["centre"], fill="none", stroke="#3b6fb6", stroke_width=1.2)


def autoware(roadbed, town, scratch):
    run(roadbed, town, scratch / "lanelet2_map.osm", "--profile", "autoware", "--crs", "unknown")
    root = xml.parse(scratch / "lanelet2_map.osm").getroot()
    tags = {one: {tag.get("k"): tag.get("v") for tag in one.iter("tag")} for one in root}
    nodes = {one.get("id"): (float(tags[one]["local_x"]), float(tags[one]["local_y"]))
             for one in root.iter("node")}
    ways = {one.get("id"): [nodes[node.get("ref")] for node in one.iter("nd")]
            for one in root.iter("way")}
    for relation in root.iter("relation"):
        if tags[relation].get("type") != "lanelet":
            continue
        left, right = (next(ways[member.get("ref")] for member in relation.iter("member")
                            if member.get("role") == side) for side in ("left", "right"))
        forth = sum(abs(a - b) for a, b in zip(left[0], right[0]))
        back = sum(abs(a - b) for a, b in zip(left[0], right[-1]))
        yield path(left + (right[::-1] if forth < back else right),
                   fill=COLOURS.get(tags[relation].get("subtype"), "#dfe3e8"), fill_opacity=0.6,
                   stroke="#ffffff", stroke_width=0.8)
    looks = {"intersection_area": {"fill": "#f2b134", "fill_opacity": 0.25, "stroke": "#d98e04"},
             "stop_line": {"fill": "none", "stroke": "#1c1c1c", "stroke_width": 3},
             "traffic_light": {"fill": "none", "stroke": "#c0392b", "stroke_width": 6}}
    for way in root.iter("way"):
        look = looks.get(tags[way].get("type"))
        if look:
            yield path(ways[way.get("id")], **look)


def shape(text):
    return [tuple(float(value) for value in point.split(",")[:2]) for point in text.split()]


def sumo(roadbed, town, scratch):
    run(roadbed, town, scratch / "town.nod.xml")
    for node in xml.parse(scratch / "town.nod.xml").getroot().iter("node"):
        if node.get("shape"):
            yield path(shape(node.get("shape")), fill="#f0dede", stroke="#b5533c")
    for lane in xml.parse(scratch / "town.edg.xml").getroot().iter("lane"):
        walked = (lane.get("allow") or "").startswith("pedestrian")
        yield path(shape(lane.get("shape")), fill="none",
                   stroke=COLOURS["sidewalk" if walked else "driving"], stroke_opacity=0.85,
                   stroke_width=f'{float(lane.get("width")) * PANEL / (2 * HALF) * 0.94:.2f}')
    for link in xml.parse(scratch / "town.con.xml").getroot().iter("connection"):
        if link.get("shape"):
            yield path(shape(link.get("shape")), fill="none", stroke="#2e7d4f", stroke_width=1.2)


def run(roadbed, source, out, *options):
    subprocess.run([roadbed, "export", source, "-o", out, "--force", "--quiet", *options], check=True)


def main():
    roadbed, picture = sys.argv[1:]
    panels = [("OpenDRIVE: roads, lanes, centrelines", open_drive),
              ("Autoware: lanelets, area, stop lines, lights", autoware),
              ("SUMO: edges, nodes, connections", sumo)]
    width = len(panels) * PANEL + (len(panels) - 1) * GAP
    text = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {PANEL + 30:g}" '
            'font-family="sans-serif" font-size="15">',
            f'<clipPath id="panel"><rect width="{PANEL:g}" height="{PANEL:g}"/></clipPath>']
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        subprocess.run([roadbed, "import", HERE / "town.xodr", "-o", scratch / "town.rbm", "--quiet"],
                       check=True)
        for i, (title, draw) in enumerate(panels):
            text.append(f'<g transform="translate({i * (PANEL + GAP):g},0)">'
                        f'<rect width="{PANEL:g}" height="{PANEL:g}" fill="#fbfbfa"/>'
                        '<g clip-path="url(#panel)">')
            text += [line for line in draw(roadbed, scratch / "town.rbm", scratch) if line]
            text.append(f'</g><text x="4" y="{PANEL + 20:g}" fill="#444">{title}</text></g>')
    text.append("</svg>\n")
    pathlib.Path(picture).write_text("\n".join(text), encoding="utf-8")


if __name__ == "__main__":
    main()
