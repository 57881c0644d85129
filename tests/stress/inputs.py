"""Inputs that grow along one dimension: functions from a folder and a number to a file in it."""

import gzip
import json
import math
import random
import struct
from pathlib import Path


def written(path: Path, text: str | bytes) -> Path:
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


# OpenDRIVE

LANE = '<lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane>'


def lanes_section(lanes: str = LANE, s: float = 0.0) -> str:
    return (
        f'<laneSection s="{s:g}"><center><lane id="0" type="none"/></center>'
        f"<right>{lanes}</right></laneSection>"
    )


def line_piece(s: float, x: float, y: float, length: float, heading: float = 0.0) -> str:
    return (
        f'<geometry s="{s:g}" x="{x:.6f}" y="{y:.6f}" hdg="{heading:.6f}" length="{length:g}">'
        "<line/></geometry>"
    )


def road(
    name,
    x: float = 0.0,
    y: float = 0.0,
    length: float = 100.0,
    heading: float = 0.0,
    junction: str = "-1",
    link: str = "",
    pieces: str = "",
    sections: str = "",
    extra: str = "",
) -> str:
    return (
        f'<road id="{name}" length="{length:g}" junction="{junction}">{link}<planView>'
        f"{pieces or line_piece(0, x, y, length, heading)}</planView>"
        f"<lanes>{sections or lanes_section()}</lanes>{extra}</road>"
    )


def open_drive(folder: Path, content: str) -> Path:
    header = '<?xml version="1.0"?><OpenDRIVE><header revMajor="1" revMinor="6"/>'
    return written(folder / "in.xodr", f"{header}{content}</OpenDRIVE>")


def roads_apart(folder: Path, n: int) -> Path:
    columns = math.isqrt(n) + 1
    return open_drive(
        folder, "".join(road(i, i % columns * 120, i // columns * 20) for i in range(n))
    )


def roads_in_a_row(folder: Path, n: int) -> Path:
    def link(i: int) -> str:
        before = f'<predecessor elementType="road" elementId="{i - 1}" contactPoint="end"/>'
        after = f'<successor elementType="road" elementId="{i + 1}" contactPoint="start"/>'
        return f"<link>{before if i else ''}{after if i + 1 < n else ''}</link>"

    lane = LANE.replace("<width", '<link><predecessor id="-1"/><successor id="-1"/></link><width')
    return open_drive(
        folder,
        "".join(
            road(i, i * 50, length=50, link=link(i), sections=lanes_section(lane)) for i in range(n)
        ),
    )


def same_roads(folder: Path, n: int) -> Path:
    return open_drive(folder, "".join(road(i) for i in range(n)))


def shifted_roads(folder: Path, n: int) -> Path:
    return open_drive(folder, "".join(road(i, i * 0.5, i * 0.003) for i in range(n)))


def crossing_roads(folder: Path, n: int) -> Path:
    """A star: all pass one place."""
    headings = [math.pi * i / n for i in range(n)]
    return open_drive(
        folder,
        "".join(
            road(i, -50 * math.cos(h), -50 * math.sin(h), heading=h) for i, h in enumerate(headings)
        ),
    )


def woven_roads(folder: Path, n: int) -> Path:
    """Half of them across the other half."""
    length = 10.0 * n
    return open_drive(
        folder,
        "".join(
            road(i, 0, i * 5, length)
            if i % 2
            else road(i, i * 5, 0, length, heading=math.pi / 2)
            for i in range(n)
        ),
    )


def winding_roads(folder: Path, n: int) -> Path:
    """Roads of three turns and more at each of twenty places."""
    pieces = "".join(
        f'<geometry s="{100 * k}" x="{100 * k}" y="0" hdg="0" length="100">'
        '<arc curvature="0.2"/></geometry>'
        for k in range(20)
    )
    roads = (road(i, length=2000, pieces=pieces) for i in range(n))
    return open_drive(folder, "\n".join(roads))


def widening_roads(folder: Path, n: int) -> Path:
    """Lanes that are metres wide at one end and a thousand kilometres at the other."""
    lane = LANE.replace('d="0"', 'd="1"')
    roads = (road(i, y=3 * i, length=110, sections=lanes_section(lane)) for i in range(n))
    return open_drive(folder, "\n".join(roads))


def connecting_roads(folder: Path, n: int) -> Path:
    into = '<link><successor elementType="junction" elementId="9"/></link>'
    link = '<link><predecessor elementType="road" elementId="a" contactPoint="end"/></link>'
    connections = "".join(
        f'<connection id="{i}" incomingRoad="a" connectingRoad="c{i}" contactPoint="start">'
        '<laneLink from="-1" to="-1"/></connection>'
        for i in range(n)
    )
    return open_drive(
        folder,
        road("a", -100, link=into)
        + "".join(road(f"c{i}", junction="9", length=10, link=link) for i in range(n))
        + f'<junction id="9" name="j">{connections}</junction>',
    )


def lanes_in_a_section(folder: Path, n: int) -> Path:
    lanes = "".join(LANE.replace('"-1"', f'"-{i + 1}"').replace("3.5", "3") for i in range(n))
    return open_drive(folder, road(1, sections=lanes_section(lanes)))


def narrow_lanes(folder: Path, n: int) -> Path:
    lanes = "".join(LANE.replace('"-1"', f'"-{i + 1}"').replace("3.5", "0.01") for i in range(n))
    return open_drive(folder, road(1, sections=lanes_section(lanes)))


def sections_of_a_road(folder: Path, n: int) -> Path:
    lane = LANE.replace("<width", '<link><predecessor id="-1"/><successor id="-1"/></link><width')
    return open_drive(
        folder, road(1, length=n, sections="".join(lanes_section(lane, i) for i in range(n)))
    )


def pieces_of_a_road(folder: Path, n: int) -> Path:
    return open_drive(
        folder, road(1, length=n, pieces="".join(line_piece(i, i, 0, 1) for i in range(n)))
    )


def widths_of_a_lane(folder: Path, n: int) -> Path:
    widths = "".join(
        f'<width sOffset="{100 * i / n:g}" a="3.5" b="0" c="0" d="0"/>' for i in range(n)
    )
    lane = f'<lane id="-1" type="driving">{widths}</lane>'
    return open_drive(folder, road(1, sections=lanes_section(lane)))


def marks_of_a_lane(folder: Path, n: int) -> Path:
    marks = "".join(
        f'<roadMark sOffset="{100 * i / n:g}" type="{"solid" if i % 2 else "broken"}" width="0.1" '
        f'color="white" laneChange="{"none" if i % 2 else "both"}"/>'
        for i in range(n)
    )
    lanes = LANE.replace("</lane>", marks + "</lane>") + LANE.replace('"-1"', '"-2"')
    return open_drive(folder, road(1, sections=lanes_section(lanes)))


def strips_of_a_road(folder: Path, n: int) -> Path:
    records = "".join(f'<coefficients s="{i}" b="0.001"/>' for i in range(n))
    surface = (
        '<lateralProfile><crossSectionSurface><surfaceStrips><strip id="-1"><linear>'
        f"{records}</linear></strip></surfaceStrips></crossSectionSurface></lateralProfile>"
    )
    sections = "".join(lanes_section(s=i) for i in range(n))
    return open_drive(folder, road(1, length=n, sections=sections, extra=surface))


def profile_of_a_road(folder: Path, n: int, profile: str, record: str) -> Path:
    """A road of 100 m whose records of one kind go up and down n times."""
    records = "".join(
        f'<{record} s="{100 * i / n:g}" a="{0.05 * (i % 2):g}" b="{0.001 * (-1) ** i:g}" c="0" d="0"/>'
        for i in range(n)
    )
    return open_drive(folder, road(1, extra=f"<{profile}>{records}</{profile}>"))


def elevations_of_a_road(folder: Path, n: int) -> Path:
    return profile_of_a_road(folder, n, "elevationProfile", "elevation")


def tilts_of_a_road(folder: Path, n: int) -> Path:
    return profile_of_a_road(folder, n, "lateralProfile", "superelevation")


def offsets_of_lanes(folder: Path, n: int) -> Path:
    offsets = "".join(
        f'<laneOffset s="{100 * i / n:g}" a="{0.05 * (i % 2):g}" b="0" c="0" d="0"/>'
        for i in range(n)
    )
    return open_drive(folder, road(1, sections=offsets + lanes_section()))


def borders_of_a_lane(folder: Path, n: int) -> Path:
    borders = "".join(
        f'<border sOffset="{100 * i / n:g}" a="{-3.5 - 0.05 * (i % 2):g}" b="0" c="0" d="0"/>'
        for i in range(n)
    )
    return open_drive(
        folder, road(1, sections=lanes_section(f'<lane id="-1" type="driving">{borders}</lane>'))
    )


def heights_of_a_lane(folder: Path, n: int) -> Path:
    heights = "".join(
        f'<height sOffset="{100 * i / n:g}" inner="{0.1 * (i % 2):g}" outer="0.1"/>'
        for i in range(n)
    )
    return open_drive(
        folder, road(1, sections=lanes_section(LANE.replace("</lane>", heights + "</lane>")))
    )


def arms_of_a_junction(folder: Path, n: int) -> Path:
    """Around a place as wide as they need; each leads to the next one."""
    radius = 10.0 * n
    arms, across, connections = [], [], []
    for i in range(n):
        turn, after = 2 * math.pi * i / n, 2 * math.pi * (i + 1) / n
        x, y = radius * math.cos(turn), radius * math.sin(turn)
        away = math.atan2(math.sin(after) - math.sin(turn), math.cos(after) - math.cos(turn))
        chord = 2 * radius * math.sin(math.pi / n)
        into = '<link><predecessor elementType="junction" elementId="9"/></link>'
        arms.append(road(f"a{i}", x, y, heading=turn, link=into))
        link = f'<link><predecessor elementType="road" elementId="a{i}" contactPoint="start"/></link>'
        across.append(road(f"c{i}", x, y, chord, away, junction="9", link=link))
        connections.append(
            f'<connection id="{i}" incomingRoad="a{i}" connectingRoad="c{i}" contactPoint="start">'
            '<laneLink from="-1" to="-1"/></connection>'
        )
    junction = f'<junction id="9" name="j">{"".join(connections)}</junction>'
    return open_drive(folder, "".join(arms + across) + junction)


def signals_of_a_road(folder: Path, n: int) -> Path:
    signals = "".join(
        f'<signal id="{i}" s="{100 * i / n:g}" t="-5" type="1000001" subtype="-1" dynamic="yes" '
        'orientation="+" zOffset="0" country="DE" value="-1"/>'
        for i in range(n)
    )
    return open_drive(folder, road(1, extra=f"<signals>{signals}</signals>"))


def signals_of_all_lanes(folder: Path, n: int) -> Path:
    lanes = "".join(LANE.replace('"-1"', f'"-{i + 1}"').replace("3.5", "0.5") for i in range(n))
    signals = "".join(
        f'<signal id="{i}" s="50" t="-5" type="274" subtype="50" dynamic="no" orientation="+" '
        'zOffset="0" country="DE" value="50"/>'
        for i in range(n)
    )
    extra = f"<signals>{signals}</signals>"
    return open_drive(folder, road(1, sections=lanes_section(lanes), extra=extra))


def lights_and_stop_lines(folder: Path, n: int) -> Path:
    """Stop lines of one lane, each for all of its lights, and as many lights that have none."""
    light = (
        '<signal id="{}" s="50" t="-5" type="1000001" subtype="-1" dynamic="yes" orientation="+" '
        'zOffset="0" country="DE" value="-1"/>'
    )
    lines = "".join(
        f'<object id="{i}" type="roadMark" subtype="signalLines" name="StopLine" s="50" t="-2" '
        'zOffset="0" hdg="1.57" length="0.3" width="3.5" height="0" orientation="+"/>'
        for i in range(n)
    )
    lights = [
        "<signals>" + "".join(light.format(f"{of}{i}") for i in range(n)) + "</signals>"
        for of in "ab"
    ]
    one = road(1, extra=f"<objects>{lines}</objects>{lights[0]}")
    return open_drive(folder, one + road(2, 0, 100, extra=lights[1]))


def crooked_road(folder: Path, n: int) -> Path:
    """A road whose pieces each begin to turn anew, so that its borders turn back."""
    pieces = "".join(
        f'<geometry s="{i}" x="{i}" y="0" hdg="0" length="1"><spiral curvStart="0" '
        f'curvEnd="0.{i % 9}"/></geometry>'
        for i in range(n)
    )
    return open_drive(folder, road(1, length=n, pieces=pieces))


def repeated_objects(folder: Path, n: int) -> Path:
    objects = "".join(
        f'<object id="{i}" s="50" t="-5" type="barrier" zOffset="0" length="1" width="1" '
        'height="1"><repeat s="0" length="100" distance="0.01" tStart="0" tEnd="0" widthStart="1" '
        'widthEnd="1" heightStart="1" heightEnd="1" zOffsetStart="0" zOffsetEnd="0"/></object>'
        for i in range(n)
    )
    return open_drive(folder, road(1, extra=f"<objects>{objects}</objects>"))


def repeated_outlines(folder: Path, n: int) -> Path:
    turns = [2 * math.pi * i / n for i in range(n)]
    corners = "".join(
        f'<cornerLocal u="{3 * math.cos(turn):.3f}" v="{3 * math.sin(turn):.3f}" z="0" height="1"/>'
        for turn in turns
    )
    objects = "".join(
        f'<object id="{i}" s="50" t="-5" type="barrier" zOffset="0" length="1" width="1" '
        'height="1"><repeat s="0" length="90" distance="0.02" tStart="0" tEnd="0" heightStart="1" '
        'heightEnd="1" zOffsetStart="0" zOffsetEnd="0"/>'
        f'<outlines><outline id="0" closed="true">{corners}</outline></outlines></object>'
        for i in range(50)
    )
    return open_drive(folder, road(1, extra=f"<objects>{objects}</objects>"))


def roads_of_one_name(folder: Path, n: int) -> Path:
    return open_drive(folder, "".join(road("same", 200 * i) for i in range(n)))


def unknown_elements(folder: Path, n: int) -> Path:
    return open_drive(folder, "".join(f'<u{i} a="x">y</u{i}>' for i in range(n)) + road(1))


def attributes_of_a_road(folder: Path, n: int) -> Path:
    attributes = " ".join(f'a{i}="1"' for i in range(n))
    return open_drive(folder, road(1).replace("<road ", f"<road {attributes} "))


def nested_elements(folder: Path, n: int) -> Path:
    return open_drive(folder, "<userData>" * n + "</userData>" * n + road(1))


def long_name(folder: Path, n: int) -> Path:
    return open_drive(folder, road("n" * n, sections=lanes_section(LANE)))


# Lanelet2


def osm_node(name: int, x: float, y: float) -> str:
    return (
        f'<node id="{name}" lat="48.7" lon="7.6"><tag k="local_x" v="{x:g}"/>'
        f'<tag k="local_y" v="{y:g}"/><tag k="ele" v="1"/></node>'
    )


def osm_way(name: int, nodes, tags: str = "") -> str:
    refs = "".join(f'<nd ref="{node}"/>' for node in nodes)
    return f'<way id="{name}">{refs}<tag k="type" v="line_thin"/>{tags}</way>'


def lanelet(name: int, left: int, right: int, members: str = "") -> str:
    return (
        f'<relation id="{name}"><member type="way" ref="{left}" role="left"/>'
        f'<member type="way" ref="{right}" role="right"/>{members}<tag k="type" v="lanelet"/>'
        '<tag k="subtype" v="road"/><tag k="location" v="urban"/><tag k="one_way" v="yes"/>'
        "</relation>"
    )


def osm(folder: Path, content: str) -> Path:
    return written(folder / "in.osm", f'<?xml version="1.0"?><osm version="0.6">{content}</osm>')


CORNERS = osm_node(1, 0, 3) + osm_node(2, 0, 0) + osm_node(3, 100, 3) + osm_node(4, 100, 0)
SIDES = osm_way(11, [1, 3]) + osm_way(12, [2, 4])


def lanelets_in_a_row(folder: Path, n: int) -> Path:
    nodes = "".join(
        osm_node(2 * i + 1, 20 * i, 3) + osm_node(2 * i + 2, 20 * i, 0) for i in range(n + 1)
    )
    ways = "".join(
        osm_way(10_000_000 + 2 * i, [2 * i + 1, 2 * i + 3])
        + osm_way(10_000_001 + 2 * i, [2 * i + 2, 2 * i + 4])
        for i in range(n)
    )
    return osm(
        folder,
        nodes
        + ways
        + "".join(
            lanelet(30_000_000 + i, 10_000_000 + 2 * i, 10_000_001 + 2 * i) for i in range(n)
        ),
    )


def same_lanelets(folder: Path, n: int) -> Path:
    return osm(folder, CORNERS + SIDES + "".join(lanelet(100 + i, 11, 12) for i in range(n)))


def fan_of_lanelets(folder: Path, n: int) -> Path:
    """Lanelets that lead from a circle to one place, and as many from there on."""
    nodes, ways, lanelets = osm_node(1, 0, 0) + osm_node(2, 0, 3), "", ""
    for i in range(2 * n):
        name, comes = 10 + 4 * i, i < n
        angle = math.pi * ((i % n + 0.5) / n + (0.5 if comes else -0.5))
        x, y = 50 * math.cos(angle), 50 * math.sin(angle)
        nodes += osm_node(name, x, y) + osm_node(name + 1, x, y + 3)
        ways += osm_way(name + 2, [name + 1, 2] if comes else [2, name + 1])
        ways += osm_way(name + 3, [name, 1] if comes else [1, name])
        lanelets += lanelet(10_000_000 + i, name + 2, name + 3)
    return osm(folder, nodes + ways + lanelets)


def same_turns(folder: Path, n: int) -> Path:
    """Lanelets on each other that turn in one crossing."""
    tag = '<tag k="turn_direction" v="left"/></relation>'
    turns = (lanelet(100 + i, 11, 12).replace("</relation>", tag) for i in range(n))
    return osm(folder, CORNERS + SIDES + "".join(turns))


def winding_lanelets(folder: Path, n: int) -> Path:
    """Lanelets that all have the same two borders, which wind."""
    turns = [(5 * math.cos(0.1 * i) + 0.01 * i, 5 * math.sin(0.1 * i)) for i in range(300)]
    nodes = [osm_node(1 + i, *at) for i, at in enumerate(turns)]
    nodes += [osm_node(1001 + i, 1.4 * x, 1.4 * y) for i, (x, y) in enumerate(turns)]
    ways = [osm_way(2001 + k, range(1 + 1000 * k, 301 + 1000 * k)) for k in range(2)]
    lanes = (lanelet(3001 + i, 2001, 2002) for i in range(n))
    return osm(folder, "".join([*nodes, *ways, *lanes]))


def zigzag_border(folder: Path, n: int) -> Path:
    nodes = "".join(osm_node(i, i * 100 / n, 3 + 0.5 * (i % 2)) for i in range(n))
    return osm(
        folder,
        nodes
        + osm_node(n + 1, 0, 0)
        + osm_node(n + 2, 100, 0)
        + osm_way(n + 11, range(n))
        + osm_way(n + 12, [n + 1, n + 2])
        + lanelet(n + 21, n + 11, n + 12),
    )


def border_back_and_forth(folder: Path, n: int) -> Path:
    return osm(
        folder,
        CORNERS + osm_way(11, [1, 3] * (n // 2)) + osm_way(12, [2, 4]) + lanelet(21, 11, 12),
    )


def tags_of_a_way(folder: Path, n: int) -> Path:
    tags = "".join(f'<tag k="k{i}" v="1"/>' for i in range(n))
    ways = osm_way(11, [1, 3], tags) + osm_way(12, [2, 4])
    return osm(folder, CORNERS + ways + lanelet(21, 11, 12))


def regulations(folder: Path, n: int) -> Path:
    elements = "".join(
        f'<relation id="{1000 + i}"><member type="way" ref="12" role="refers"/>'
        '<member type="way" ref="11" role="ref_line"/><tag k="type" v="regulatory_element"/>'
        '<tag k="subtype" v="traffic_light"/></relation>'
        for i in range(n)
    )
    members = "".join(
        f'<member type="relation" ref="{1000 + i}" role="regulatory_element"/>' for i in range(n)
    )
    return osm(folder, CORNERS + SIDES + elements + lanelet(21, 11, 12, members))


def crossing_lanelets(folder: Path, n: int) -> Path:
    """All lie on each other, share no border, and have the right of way by one element."""
    content = ""
    for i in range(n):
        a, y = 10 * i + 1, i / n
        content += osm_node(a, 0, 3 + y) + osm_node(a + 1, 100, 3 + y) + osm_node(a + 2, 0, y)
        content += osm_node(a + 3, 100, y)
        content += osm_way(a + 4, [a, a + 1]) + osm_way(a + 5, [a + 2, a + 3])
    member = '<member type="relation" ref="5" role="regulatory_element"/>'
    lanelets = "".join(lanelet(10 * i + 7, 10 * i + 5, 10 * i + 6, member) for i in range(n))
    members = "".join(
        f'<member type="relation" ref="{10 * i + 7}" role="{role}"/>'
        for i in range(n)
        for role in ("right_of_way", "yield")
    )
    turning = lanelets.replace("</relation>", '<tag k="turn_direction" v="left"/></relation>')
    element = (
        f'<relation id="5">{members}<tag k="type" v="regulatory_element"/>'
        '<tag k="subtype" v="right_of_way"/></relation>'
    )
    return osm(folder, content + turning + element)


# CommonRoad


def common_road(folder: Path, content: str) -> Path:
    return written(
        folder / "in.xml",
        '<?xml version="1.0"?><commonRoad commonRoadVersion="2020a" benchmarkID="A_B-1_1_T-1" '
        'timeStepSize="0.1" author="" affiliation="" source="" date="2020-01-01"><location>'
        "<geoNameId>-999</geoNameId><gpsLatitude>999</gpsLatitude><gpsLongitude>999</gpsLongitude>"
        f"</location><scenarioTags><urban/></scenarioTags>{content}</commonRoad>",
    )


def bound(side: str, points) -> str:
    inside = "".join(f"<point><x>{x:g}</x><y>{y:g}</y></point>" for x, y in points)
    return f"<{side}>{inside}</{side}>"


def cr_lanelet(name: int, x: float, length: float, links: str = "") -> str:
    left, right = [(x, 3), (x + length, 3)], [(x, 0), (x + length, 0)]
    return (
        f'<lanelet id="{name}">{bound("leftBound", left)}{bound("rightBound", right)}{links}'
        "<laneletType>urban</laneletType></lanelet>"
    )


def cr_lanelets_in_a_row(folder: Path, n: int) -> Path:
    def links(i: int) -> str:
        before = f'<predecessor ref="{i}"/>' if i else ""
        return before + (f'<successor ref="{i + 2}"/>' if i + 1 < n else "")

    return common_road(folder, "".join(cr_lanelet(i + 1, 20 * i, 20, links(i)) for i in range(n)))


def cr_same_lanelets(folder: Path, n: int) -> Path:
    return common_road(folder, "".join(cr_lanelet(i + 1, 0, 100) for i in range(n)))


def cr_obstacles(folder: Path, n: int) -> Path:
    obstacles = "".join(
        f'<staticObstacle id="{i + 10}"><type>parkedVehicle</type><shape><rectangle><length>4'
        "</length><width>2</width></rectangle></shape><initialState><position><point>"
        f"<x>{i % 100}</x><y>{20 + i // 100}</y></point></position><orientation><exact>0</exact>"
        "</orientation><time><exact>0</exact></time></initialState></staticObstacle>"
        for i in range(n)
    )
    return common_road(folder, cr_lanelet(1, 0, 100) + obstacles)


# A table of lanes


def lane_table(folder: Path, lanes) -> Path:
    """Lanes by name, successors and the points of their centre lines."""
    lanes = list(lanes)
    columns = {"drawing": "centreline", "lane": "id", "width_m": "width"}
    if any(following for _, following, _ in lanes):
        columns["successors"] = "next"
    written(folder / "columns.json", json.dumps(columns))
    return geojson(
        folder,
        (
            {
                "type": "Feature",
                "properties": {"id": name, "width": 3.5, "next": following},
                "geometry": {"type": "LineString", "coordinates": line},
            }
            for name, following, line in lanes
        ),
    )


def table_lanes_in_a_row(folder: Path, n: int) -> Path:
    return lane_table(
        folder, ((str(i), str(i + 1), [[100 * i, 0], [100 * i + 100, 0]]) for i in range(n))
    )


def table_same_lanes(folder: Path, n: int) -> Path:
    return lane_table(folder, ((str(i), "", [[0, 0], [100, 0]]) for i in range(n)))


def table_slanting_lanes(folder: Path, n: int) -> Path:
    """Lanes of one way, a centimetre apart."""
    return lane_table(
        folder, ((str(i), "", [[0.01 * (i % 7), 0], [100, 50]]) for i in range(n))
    )


def table_points_of_a_lane(folder: Path, n: int) -> Path:
    return lane_table(folder, [("0", "", [[i, i % 2 / 10] for i in range(n)])])


def table_successors_of_a_lane(folder: Path, n: int) -> Path:
    following = ",".join(str(i + 1) for i in range(n))
    ahead = [(str(i + 1), "", [[100, 0], [200, i / 10]]) for i in range(n)]
    return lane_table(folder, [("0", following, [[0, 0], [100, 0]]), *ahead])


# GeoJSON


def geojson(folder: Path, features) -> Path:
    return written(
        folder / "in.geojson",
        json.dumps(
            {
                "type": "FeatureCollection",
                "crs": {"type": "name", "properties": {"name": "EPSG:25832"}},
                "features": list(features),
            }
        ),
    )


def polygon(rings, properties=None):
    return {
        "type": "Feature",
        "properties": properties or {"a": 1},
        "geometry": {"type": "Polygon", "coordinates": rings},
    }


def square(x: float, y: float, side: float = 10.0):
    ring = [[x, y], [x + side, y], [x + side, y + side], [x, y + side]]
    return ring + ring[:1]


def circle(folder: Path, n: int) -> Path:
    ring = [
        [100 * math.cos(2 * math.pi * i / n), 100 * math.sin(2 * math.pi * i / n)] for i in range(n)
    ]
    return geojson(folder, [polygon([ring + ring[:1]])])


def roundabout(folder: Path, n: int) -> Path:
    """A ring road: two circles."""

    def ring(radius: float, count: int):
        points = [
            [radius * math.cos(2 * math.pi * i / count), radius * math.sin(2 * math.pi * i / count)]
            for i in range(count)
        ]
        return points + points[:1]

    return geojson(folder, [polygon([ring(20, n // 2), ring(14, n // 2)[::-1]])])


def random_ring(folder: Path, n: int) -> Path:
    """Crosses itself n² times."""
    chance = random.Random(1)
    ring = [[chance.uniform(0, 100), chance.uniform(0, 100)] for _ in range(n)]
    return geojson(folder, [polygon([ring + ring[:1]])])


def comb(folder: Path, n: int) -> Path:
    teeth = [[[i, 0], [i + 0.2, 50 + i % 7], [i + 0.4, 0]] for i in range(n // 3)]
    ring = [point for tooth in teeth for point in tooth] + [[n // 3, -5], [0, -5]]
    return geojson(folder, [polygon([ring + ring[:1]])])


def same_squares(folder: Path, n: int) -> Path:
    return geojson(folder, [polygon([square(0, 0)])] * n)


def squares_apart(folder: Path, n: int) -> Path:
    columns = math.isqrt(n) + 1
    places = ((i % columns * 20, i // columns * 20) for i in range(n))
    return geojson(folder, (polygon([square(x, y)]) for x, y in places))


def shifted_squares(folder: Path, n: int) -> Path:
    return geojson(folder, (polygon([square(i * 0.013, i * 0.007)]) for i in range(n)))


def holes(folder: Path, n: int) -> Path:
    columns = math.isqrt(n) + 1
    inner = [square(i % columns * 9 + 1, i // columns * 9 + 1, 4)[::-1] for i in range(n)]
    return geojson(folder, [polygon([square(0, 0, columns * 9 + 2)] + inner)])


def properties_of_a_feature(folder: Path, n: int) -> Path:
    return geojson(folder, [polygon([square(0, 0)], {f"k{i}": 1 for i in range(n)})])


# Argoverse 2


def argoverse(folder: Path, segments, **more) -> Path:
    lists = {"lane_segments": {str(s["id"]): s for s in segments}, **more}
    return written(folder / "in.json", json.dumps(lists))


def segment(i: int, left, right, **more):
    def line(points):
        return [{"x": x, "y": y, "z": 0.0} for x, y in points]

    return {
        "id": i,
        "is_intersection": False,
        "lane_type": "VEHICLE",
        "left_lane_boundary": line(left),
        "right_lane_boundary": line(right),
        "left_lane_mark_type": "DASHED_WHITE",
        "right_lane_mark_type": "SOLID_WHITE",
        "successors": [],
        "predecessors": [],
        "left_neighbor_id": None,
        "right_neighbor_id": None,
        **more,
    }


def straight_segment(i: int, x: float, to: float, y: float = 0.0, **more):
    return segment(i, [(x, y + 3), (to, y + 3)], [(x, y), (to, y)], **more)


def av_segments_in_a_row(folder: Path, n: int) -> Path:
    return argoverse(
        folder,
        (
            straight_segment(i, i * 100, i * 100 + 100, successors=[i + 1], predecessors=[i - 1])
            for i in range(n)
        ),
    )


def av_same_segments(folder: Path, n: int) -> Path:
    """All inside one intersection, and all neighbours of the first."""
    return argoverse(
        folder,
        (
            straight_segment(i, 0, 100, is_intersection=True, left_neighbor_id=0)
            for i in range(n)
        ),
    )


def av_points_of_a_border(folder: Path, n: int) -> Path:
    line = [(i * 0.1, 0.01 * (i % 3)) for i in range(n)]
    return argoverse(folder, [segment(1, [(x, y + 3) for x, y in line], line)])


def av_successors_of_a_segment(folder: Path, n: int) -> Path:
    first = straight_segment(0, 0, 100, successors=list(range(1, n)))
    return argoverse(folder, [first] + [straight_segment(i, 100, 200, y=i * 4) for i in range(1, n)])


def av_long_intersections(folder: Path, n: int) -> Path:
    """Kilometres of intersection in a few bytes."""
    return argoverse(
        folder, (straight_segment(i, 0, 1e6, y=i * 4, is_intersection=True) for i in range(n))
    )


# JSON


def scenario(folder: Path, text: str) -> Path:
    return written(folder / "in.json", text)


def objects_in_a_list(folder: Path, n: int) -> Path:
    objects = ",".join(f'{{"id":"a{i}"}}' for i in range(n))
    head = '"roadbed_scenario":1,"name":"a","map":"m"'
    return scenario(folder, f'{{{head},"obstacles":[{objects}]}}')


def empty_objects(folder: Path, n: int) -> Path:
    return scenario(folder, f'{{"roadbed_scenario":1,"obstacles":[{",".join(["{}"] * n)}]}}')


def traffic_of_a_scenario(folder: Path, n: int) -> Path:
    """Cars in a row ahead of the vehicle on a road as long as they need."""
    open_drive(folder, road(1, length=400 + 12 * n))
    cars = ",".join(
        f'{{"id":"a{i}","traffic":{{"start":"lane:1/0/-1@{100 + 12 * i}","speed_mps":10}}}}'
        for i in range(n)
    )
    head = (
        '"roadbed_scenario":1,"name":"a row","map":"in.xodr","duration_s":5,'
        '"ego":{"start":"lane:1/0/-1@50","speed_mps":10},"goal":"lane:1/0/-1@350"'
    )
    return scenario(folder, f'{{{head},"obstacles":[{cars}]}}')


def keys_of_an_object(folder: Path, n: int) -> Path:
    return scenario(folder, "{" + ",".join(f'"k{i}":1' for i in range(n)) + "}")


def nested_objects(folder: Path, n: int) -> Path:
    return scenario(folder, '{"a":' * n + "1" + "}" * n)


def numbers_in_a_list(folder: Path, n: int) -> Path:
    return scenario(folder, "[" + "1," * n + "1]")


# Drives


def drive(folder: Path, rows) -> Path:
    text = "".join(f"{t:g},{x:.9g},{y:.9g},{heading:g}\n" for t, x, y, heading in rows)
    return written(folder / "in.csv", "t_s,x_m,y_m,heading_rad\n" + text)


def rows_of_a_drive(folder: Path, n: int) -> Path:
    return drive(folder, ((i * 0.001, 100 + i * 50 / n, 198.2, 0) for i in range(n)))


def rows_apart(folder: Path, n: int) -> Path:
    return drive(folder, ((i, 100 + 2 * i, 198.2, 0) for i in range(n)))


def outlier(folder: Path, n: int) -> Path:
    """One row n metres away, and time enough to drive there and back."""
    rows = [(i * 1e5, 150 + i, 198.2, 0) for i in range(9)]
    rows[4] = (4e5, 150 + n, 198.2 + n, 0)
    return drive(folder, rows)


def rows_far_apart(folder: Path, n: int) -> Path:
    """Rows that are each n metres from the one before, and time enough to drive there."""
    return drive(folder, ((i * 1e5, 150 + i * n, 198.2, 0) for i in range(20)))


def areas_of_a_drive(folder: Path, n: int) -> Path:
    """Polygons of which each overlaps most others, around the drive."""
    drive(folder, ((i, 5 + i, 5, 0) for i in range(21)))
    chance = random.Random(1)
    corners = ((chance.uniform(-30, 30), chance.uniform(-30, 30)) for _ in range(n))
    return geojson(folder, (polygon([square(x, y, 30)]) for x, y in corners))


def movers(folder: Path, n: int) -> Path:
    rows = "".join(
        f"0,o{i},{200 + i % 100},{300 + i // 100},0,1,1\n"
        f"90,o{i},{210 + i % 100},{300 + i // 100},0,1,1\n"
        for i in range(n)
    )
    drive(folder, ((i, 100 + i, 198.2, 0) for i in range(50)))
    return written(
        folder / "movers.csv", "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n" + rows
    )


def movers_that_jump(folder: Path, n: int) -> Path:
    """A box that is 500 m away in every other row."""
    drive(folder, ((i, 100 + i, 198.2, 0) for i in range(50)))
    rows = "".join(f"{50 * i / n:.6f},a,{200 + i % 2 * 500},300,0,4,2\n" for i in range(n))
    return written(
        folder / "movers.csv", "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n" + rows
    )


# Clouds


def xyz(folder: Path, n: int) -> Path:
    chance = random.Random(1)
    return written(
        folder / "in.xyz",
        "".join(
            f"{chance.uniform(0, 50):.3f} {chance.uniform(0, 50):.3f} {chance.uniform(0, 3):.3f}\n"
            for _ in range(n)
        ),
    )


def pcd_header(points: int, data: str) -> bytes:
    return (
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
        f"WIDTH {points}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {points}\nDATA {data}\n"
    ).encode()


def pcd_binary(folder: Path, n: int) -> Path:
    chance = random.Random(1)
    points = b"".join(
        struct.pack("<fff", chance.uniform(0, 50), chance.uniform(0, 50), chance.uniform(0, 3))
        for _ in range(n)
    )
    return written(folder / "in.pcd", pcd_header(n, "binary") + points)


def empty_parts_of_an_index(folder: Path, n: int) -> Path:
    (folder / "in.tiles").mkdir(exist_ok=True)
    return written(
        folder / "in.tiles/index.json",
        '{"format":"roadbed occupancy tiles 2","x":[' + ",".join(["{}"] * n) + "]}",
    )


def points_far_apart(folder: Path, n: int) -> Path:
    """Twenty points over so many metres."""
    rows = (f"{i * n / 20:.3f} {i * 7 % 20 * n / 20:.3f} {0.3 * (i % 7):.1f}\n" for i in range(20))
    return written(folder / "in.xyz", "".join(rows))


def pcd_one_place(folder: Path, n: int) -> Path:
    return written(folder / "in.pcd", pcd_header(n, "binary") + bytes(12 * n))


def pcd_column(folder: Path, n: int) -> Path:
    """A post of so many points on a floor."""
    floor = [(0.5 * x, 0.5 * y, 0.0) for x in range(40) for y in range(40)]
    points = [(5.0, 5.0, 10.0 * i / n) for i in range(n)] + floor
    return written(
        folder / "in.pcd",
        pcd_header(len(points), "binary") + b"".join(struct.pack("<fff", *at) for at in points),
    )


def lzf_of_zeros(size: int) -> bytes:
    """References of 264 bytes each to the zero before them."""
    whole, rest = divmod(size - 1, 264)
    packed = b"\x00\x00" + bytes([7 << 5, 255, 0]) * whole
    return packed + (bytes([rest - 1]) + bytes(rest) if 0 < rest <= 32 else b"")


def pcd_bomb(folder: Path, n: int) -> Path:
    """n packed bytes, 88 n in memory."""
    points = n * 88 // 264 * 22
    plain = 12 * points
    while (plain - 1) % 264 > 32:
        points += 1
        plain = 12 * points
    packed = lzf_of_zeros(plain)
    sizes = struct.pack("<II", len(packed), plain)
    return written(folder / "in.pcd", pcd_header(points, "binary_compressed") + sizes + packed)


def log_bomb(folder: Path, n: int) -> Path:
    """MCAP packed as a file, n bytes unpacked, a thousandth packed."""
    record = b"\x89MCAP0\r\n" + b"\x01" + struct.pack("<Q", n) + bytes(n)
    return written(folder / "in.mcap", gzip.compress(record, 9, mtime=0))


def zstandard(before: bytes, zeros: int, after: bytes) -> bytes:
    """A frame of Zstandard (RFC 8878): bytes as they are, and many zeros, four bytes for 128 KiB."""
    def block(kind: int, size: int, content: bytes, is_last: bool = False) -> bytes:
        return struct.pack("<I", is_last | kind << 1 | size << 3)[:3] + content

    most = 1 << 17
    full, rest = divmod(zeros, most)
    blocks = block(0, len(before), before) + full * block(1, most, b"\x00") + block(1, rest, b"\x00")
    size = struct.pack("<I", len(before) + zeros + len(after))
    return b"\x28\xb5\x2f\xfd\xa0" + size + blocks + block(0, len(after), after, True)


def log_of_zeros(folder: Path, n: int) -> Path:
    """MCAP with a packed chunk that holds a cloud of n bytes, all of its points in one place."""
    def text(word: str) -> bytes:
        return struct.pack("<I", len(word)) + word.encode()

    def record(kind: int, content: bytes) -> bytes:
        return bytes([kind]) + struct.pack("<Q", len(content)) + content

    def cdr(word: str, size: int) -> bytes:
        return struct.pack("<I", len(word) + 1) + word.encode().ljust(size, b"\x00")

    points = n // 12
    head = b"\x00\x01\x00\x00" + struct.pack("<iI", 1, 0) + cdr("map", 4)
    head += struct.pack("<III", 1, points, 3)
    for i, axis in enumerate("xyz"):
        head += cdr(axis, 4) + struct.pack("<IB3xI", 4 * i, 7, 1)
    head += struct.pack("<B3xIII", 0, 12, 12 * points, 12 * points)
    size = 22 + len(head) + 12 * points + 1
    schema = text("sensor_msgs/msg/PointCloud2") + text("ros2msg") + text("")
    channel = text("/points") + text("cdr") + text("")
    topic = record(3, struct.pack("<H", 1) + schema) + record(4, struct.pack("<HH", 1, 1) + channel)
    message = b"\x05" + struct.pack("<QHIQQ", size, 1, 0, 10**9, 10**9) + head
    packed = zstandard(topic + message, 12 * points, b"\x01")
    unpacked = len(topic) + len(message) + 12 * points + 1
    chunk = struct.pack("<QQQI", 0, 0, unpacked, 0) + text("zstd")
    chunk += struct.pack("<Q", len(packed)) + packed
    magic = b"\x89MCAP0\r\n"
    records = record(6, chunk) + record(15, bytes(4)) + record(2, bytes(20))
    return written(folder / "in.mcap", magic + records + magic)


def log_chunks(folder: Path, n: int) -> Path:
    """MCAP with n chunks that hold nothing and claim a terabyte each."""
    chunk = struct.pack("<QQQI", 0, 0, 1 << 40, 0) + struct.pack("<I4sQ", 4, b"zstd", 0)
    return written(folder / "in.mcap", b"\x89MCAP0\r\n" + n * (b"\x06" + struct.pack("<Q", len(chunk)) + chunk))


def ply(folder: Path, n: int) -> Path:
    chance = random.Random(1)
    points = (chance.uniform(0, 50) for _ in range(3 * n))
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {n}\nproperty float x\n"
        "property float y\nproperty float z\nend_header\n"
    )
    return written(folder / "in.ply", header.encode() + struct.pack(f"<{3 * n}f", *points))


def las(folder: Path, n: int) -> Path:
    """Version 1.2, point format 0, millimetres."""
    chance = random.Random(1)
    header = b"LASF" + bytes(20) + struct.pack("<BB", 1, 2) + bytes(68)
    header += struct.pack("<HIIBHI5I", 227, 227, 0, 0, 20, n, n, 0, 0, 0, 0)
    header += struct.pack("<12d", *[0.001] * 3, *[0.0] * 3, 50, 0, 50, 0, 3, 0)
    points = (
        struct.pack("<3iHBBbBH", *(chance.randrange(50_000) for _ in range(2)),
                    chance.randrange(3000), 0, 9, 0, 0, 0, 0)
        for _ in range(n)
    )  # fmt: skip
    return written(folder / "in.las", header + b"".join(points))


def poses(folder: Path, n: int) -> Path:
    """A line for the one cloud there is, and others."""
    pcd_binary(folder, 100).rename(folder / "cloud.pcd")
    return written(folder / "in.txt", "".join(f"{i} {i} 0 0 0 0 0 1\n" for i in range(n)))


def ot_chain(folder: Path, n: int) -> Path:
    """Leaves that are occupied and free in turns, under inner nodes of eight."""
    def leaf(value: float) -> bytes:
        return struct.pack("<fB", value, 0)

    data, nodes, levels = (leaf(1.0) + leaf(-1.0)) * 4, 8, 0
    while len(data) * 8 <= 20 * n and levels < 15:
        data, nodes, levels = (struct.pack("<fB", 1.0, 255) + data) * 8, 8 * nodes + 8, levels + 1
    data, nodes = struct.pack("<fB", 1.0, 255) + data, nodes + 1
    header = f"# Octomap OcTree file\nid OcTree\nsize {nodes}\nres 0.1\ndata\n"
    drive(folder, ((i, 2000 + i, 2000, 0) for i in range(5)))
    return written(folder / "in.ot", header.encode() + data)


def bt_checked(folder: Path, n: int) -> Path:
    """Full to the leaves, which are occupied and free in turns: two bytes are eight nodes."""
    leaves, levels = b"\x66\x66", 0
    data = leaves
    while len(data) * 8 <= n:
        data = b"\xff\xff" + data * 8
        levels += 1
    nodes = 8
    for _ in range(levels):
        nodes = 8 + nodes * 8
    header = f"# Octomap OcTree binary file\nid OcTree\nsize {nodes + 1}\nres 0.1\ndata\n"
    drive(folder, ((i, 2000 + i, 2000, 0) for i in range(5)))
    return written(folder / "in.bt", header.encode() + data)


# Tables


def table(folder: Path, columns: str, rows) -> Path:
    return written(folder / "in.csv", columns + "\n" + "".join(f"{row}\n" for row in rows))


def places(folder: Path, n: int) -> Path:
    return table(folder, "x_m,y_m", (f"{200 + i % 100},{200 + i / n:.6f}" for i in range(n)))


def pairs(folder: Path, n: int) -> Path:
    here, there = "lane:1/0/-1@", "lane:7/0/1@"
    rows = (f"{here}{10 + i % 20},{there}{30 + i % 20}" for i in range(n))
    return table(folder, "from,to", rows)


def way_points(folder: Path, n: int) -> Path:
    rows = (f"{5 * i},{20 * math.sin(0.05 * i):.6f}" for i in range(n))
    return table(folder, "x_m,y_m", rows)


def way_points_apart(folder: Path, n: int) -> Path:
    """Three way-points, the last one so many metres away."""
    return table(folder, "x_m,y_m", (f"{x},0" for x in (0, 50, 50 + n)))


def region(folder: Path, rings) -> Path:
    """Polygons of coordinates of the map."""
    text = json.dumps(
        {
            "type": "FeatureCollection",
            "crs": None,
            "features": [
                {
                    "type": "Feature",
                    "properties": {},
                    "geometry": {"type": "Polygon", "coordinates": [ring]},
                }
                for ring in rings
            ],
        }
    )
    return written(folder / "in.geojson", text)


def region_of_many_vertices(folder: Path, n: int) -> Path:
    """A jagged ring over parts of the town and of the crossing."""
    ring = [
        [
            620 + (110 + 0.5 * (i % 2)) * math.cos(2 * math.pi * i / n),
            300 + (110 + 0.5 * (i % 2)) * math.sin(2 * math.pi * i / n),
        ]
        for i in range(n)
    ]
    return region(folder, [ring + ring[:1]])


def star_region(folder: Path, n: int) -> Path:
    """Spikes of 100 m, whose boxes lie on each other, over parts of the town and of the crossing."""
    ring = [
        [
            620 + (110 if i % 2 else 10) * math.cos(2 * math.pi * i / n),
            300 + (110 if i % 2 else 10) * math.sin(2 * math.pi * i / n),
        ]
        for i in range(n)
    ]
    return region(folder, [ring + ring[:1]])


def many_regions(folder: Path, n: int) -> Path:
    side = math.isqrt(n) + 1
    step = 300.0 / side

    def square(i: int) -> list[list[float]]:
        x, y, half = 500 + step * (i % side), 150 + step * (i // side), step / 3
        return [[x, y], [x + half, y], [x + half, y + half], [x, y + half], [x, y]]

    return region(folder, [square(i) for i in range(n)])


def pairs_to_align(folder: Path, n: int) -> Path:
    rows = (f"{i},{i % 7},{i + 10},{i % 7 + 20}" for i in range(n))
    return table(folder, "from_x_m,from_y_m,to_x_m,to_y_m", rows)


def ground(folder: Path, n: int) -> Path:
    """Points over parts of the town and of the crossing, 1 to 100 to a square metre."""
    side = math.isqrt(n) + 1
    step = 200.0 / side
    rows = (
        f"{520 + step * (i % side):.3f} {200 + step * (i // side):.3f} {0.01 * (i % side):.3f}\n"
        for i in range(n)
    )
    return written(folder / "in.xyz", "".join(rows))


def job_lines(folder: Path, n: int) -> Path:
    """Jobs that are one, and as many lines that are refused."""
    roads_apart(folder, 1)
    job = json.dumps({"job": "validate", "inputs": ["in.xodr"]})
    return written(
        folder / "in.jsonl",
        "".join(f'{job}\n{{"job": "locate", "inputs": [{i}]}}\n' for i in range(n)),
    )
