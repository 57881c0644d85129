#!/usr/bin/env python3
"""Makes junction.xml, a small CommonRoad 2020a scenario. Usage: data/make_junction.py

A road of two lanes eastwards (1 right, 2 left) and one westwards (3) meets a side road from the
south: after it the road goes on (11, 12; 13), lane 1 also turns into the side road (4, then 5).
"""

from math import cos, pi, sin
from pathlib import Path as File

WIDTH = 3.5  # m, of every lane
STEP_S = 0.1


def line(from_x, to_x, y, count=6, bend=0.0):
    """Points along x at y, on a parabola of height `bend` m."""
    points = []
    for i in range(count):
        share = i / (count - 1)
        x = from_x + share * (to_x - from_x)
        points.append((x, y + 4 * bend * share * (1 - share)))
    return points


def arc(centre, radius, start, end, count=9):
    """Points on a circle, by angle."""
    steps = [start + (end - start) * i / (count - 1) for i in range(count)]
    return [(centre[0] + radius * cos(a), centre[1] + radius * sin(a)) for a in steps]


def number(value):
    return f"{value:.6f}".rstrip("0").rstrip(".")


def point(at):
    return f"<point><x>{number(at[0] + 0.0)}</x><y>{number(at[1] + 0.0)}</y></point>"


def bound(name, points, marking):
    rows = "".join(f"   {point(at)}\n" for at in points)
    return f"  <{name}>\n{rows}   <lineMarking>{marking}</lineMarking>\n  </{name}>\n"


def lanelet(number_, left, right, rest, kind="urban", users="vehicle"):
    return (f' <lanelet id="{number_}">\n' + bound("leftBound", *left)
            + bound("rightBound", *right) + "".join(f"  {row}\n" for row in rest[0])
            + f"  <laneletType>{kind}</laneletType>\n  <userOneWay>{users}</userOneWay>\n"
            + "".join(f"  {row}\n" for row in rest[1]) + " </lanelet>\n")


def lanelets():
    text = ""
    for prefix, x0, x1 in (("", 0, 50), ("1", 62, 112)):
        east, west = sorted((x0, x1)), sorted((x0, x1), reverse=True)
        before = prefix == ""
        right_links = (['<successor ref="21"/>', '<successor ref="4"/>'] if before
                       else ['<predecessor ref="21"/>'])
        left_links = ['<successor ref="22"/>'] if before else ['<predecessor ref="22"/>']
        west_links = ['<predecessor ref="23"/>'] if before else ['<successor ref="23"/>']
        stop = ('<stopLine>' + point((50, 0)) + point((50, -WIDTH))
                + '<lineMarking>solid</lineMarking><trafficLightRef ref="51"/></stopLine>')
        text += lanelet(
            prefix + "1", (line(*east, 0), "dashed"), (line(*east, -WIDTH), "solid"),
            (right_links + [f'<adjacentLeft ref="{prefix}2" drivingDir="same"/>']
             + ([stop] if before else []),
             ['<trafficSignRef ref="41"/>']
             + (['<trafficLightRef ref="51"/>'] if before else [])))
        text += lanelet(
            prefix + "2", (line(*east, WIDTH), "solid_solid"), (line(*east, 0), "dashed"),
            (left_links + [f'<adjacentLeft ref="{prefix}3" drivingDir="opposite"/>',
                           f'<adjacentRight ref="{prefix}1" drivingDir="same"/>'],
             ['<trafficSignRef ref="41"/>']))
        text += lanelet(
            prefix + "3", (line(*west, WIDTH), "solid_solid"), (line(*west, 2 * WIDTH), "curb"),
            (west_links + [f'<adjacentLeft ref="{prefix}2" drivingDir="opposite"/>'], []))
    for number_, y, next_, side in (("21", 0, "11", "Left"), ("22", WIDTH, "12", "Right")):
        other = "22" if side == "Left" else "21"
        text += lanelet(
            number_, (line(50, 62, y), "no_marking"), (line(50, 62, y - WIDTH), "no_marking"),
            ([f'<predecessor ref="{number_[1]}"/>', f'<successor ref="{next_}"/>',
              f'<adjacent{side} ref="{other}" drivingDir="same"/>'], []), kind="intersection")
    text += lanelet(
        "23", (line(62, 50, WIDTH), "no_marking"), (line(62, 50, 2 * WIDTH), "no_marking"),
        (['<predecessor ref="13"/>', '<successor ref="3"/>'], []), kind="intersection")
    corner = (50, -WIDTH - 5)
    text += lanelet(
        "4", (arc(corner, 5 + WIDTH, pi / 2, 0), "no_marking"),
        (arc(corner, 5, pi / 2, 0), "curb"),
        (['<predecessor ref="1"/>', '<successor ref="5"/>'], []), kind="intersection")
    south = [(50 + 5 + WIDTH, -8.5 - 8.0 * i) for i in range(6)]
    text += lanelet(
        "5", (south, "unknown"), ([(55, y) for _, y in south], "curb"),
        (['<predecessor ref="4"/>'], []), users="car")
    text += lanelet(
        "6", (line(0, 50, -WIDTH), "solid"), (line(0, 50, -WIDTH - 1.5, bend=-0.2), "curb"),
        ([], []), kind="bicycleLane", users="bicycle")
    return text


def rules():
    cycle = "".join(f"<cycleElement><duration>{d}</duration><color>{c}</color></cycleElement>"
                    for d, c in ((60, "red"), (10, "redYellow"), (60, "green"), (10, "yellow")))
    return (
        ' <trafficSign id="41"><trafficSignElement><trafficSignID>274</trafficSignID>'
        "<additionalValue>13.9</additionalValue></trafficSignElement><position>"
        + point((0, -4)) + "</position><virtual>false</virtual></trafficSign>\n"
        f' <trafficLight id="51"><cycle>{cycle}<timeOffset>20</timeOffset></cycle><position>'
        + point((51, -4)) + "</position><direction>all</direction><active>true</active>"
        "</trafficLight>\n"
        ' <intersection id="60">\n'
        '  <incoming id="61"><incomingLanelet ref="1"/><incomingLanelet ref="2"/>'
        '<successorsRight ref="4"/><successorsStraight ref="21"/><successorsStraight ref="22"/>'
        '<isLeftOf ref="62"/></incoming>\n'
        '  <incoming id="62"><incomingLanelet ref="13"/><successorsStraight ref="23"/>'
        "</incoming>\n </intersection>\n")


def exact(name, value):
    return f"<{name}><exact>{number(value)}</exact></{name}>"


def interval(name, least, most):
    return (f"<{name}><intervalStart>{number(least)}</intervalStart>"
            f"<intervalEnd>{number(most)}</intervalEnd></{name}>")


def state(name, step, x, y, heading, speed, more=""):
    return (f"<{name}><position>{point((x, y))}</position>{exact('orientation', heading)}"
            f"{exact('time', step)}{exact('velocity', speed)}{more}</{name}>")


def box(length, width):
    return f"<rectangle><length>{length}</length><width>{width}</width></rectangle>"


def obstacles():
    speed, acceleration = 8.0, 0.5
    states = ""
    for step in range(1, 31):
        t = step * STEP_S
        states += "   " + state("state", step, 20 + speed * t + 0.5 * acceleration * t * t,
                                -WIDTH / 2, 0, speed + acceleration * t,
                                exact("acceleration", acceleration)) + "\n"
    corners = "".join(point(p) for p in ((-0.3, -0.3), (0.3, -0.3), (0.3, 0.3), (-0.3, 0.3)))
    occupancies = "".join(
        f"   <occupancy><shape><circle><radius>{number(1 + 0.1 * step)}</radius>"
        f"<center><x>80</x><y>{number(2 * WIDTH + 3)}</y></center></circle></shape>"
        f"{exact('time', step)}</occupancy>\n" for step in range(1, 6))
    return (
        f' <staticObstacle id="71"><type>parkedVehicle</type><shape>{box(4.5, 1.8)}</shape>'
        + state("initialState", 0, 40, 2 * WIDTH - 1, pi, 0) + "</staticObstacle>\n"
        f' <dynamicObstacle id="72"><type>car</type><shape>{box(4.6, 1.9)}</shape>'
        + state("initialState", 0, 20, -WIDTH / 2, 0, speed, exact("acceleration", acceleration))
        + f"\n  <trajectory>\n{states}  </trajectory></dynamicObstacle>\n"
        f' <dynamicObstacle id="73"><type>pedestrian</type><shape><polygon>{corners}</polygon>'
        "</shape>" + state("initialState", 0, 80, 2 * WIDTH + 3, -pi / 2, 1)
        + f"\n  <occupancySet>\n{occupancies}  </occupancySet></dynamicObstacle>\n")


def problem():
    start = state("initialState", 0, 5, WIDTH / 2, 0, 10,
                  exact("yawRate", 0) + exact("slipAngle", 0))
    return (
        f' <planningProblem id="80">{start}\n'
        '  <goalState><position><lanelet ref="12"/><lanelet ref="11"/></position>'
        + interval("orientation", -0.2, 0.2) + interval("time", 60, 120)
        + interval("velocity", 5, 14) + "</goalState>\n"
        "  <goalState><position><rectangle><length>10</length><width>3</width>"
        f"<orientation>{number(-pi / 2)}</orientation><center><x>56.75</x><y>-30</y></center>"
        "</rectangle></position>" + interval("time", 60, 150) + "</goalState>\n"
        " </planningProblem>\n")


def main():
    text = (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<commonRoad timeStepSize="{STEP_S}" commonRoadVersion="2020a" author="roadbed" '
        'affiliation="" source="data/make_junction.py" benchmarkID="DEU_Junction-1_1_T-1" '
        'date="2026-11-21">\n'
        " <location><geoNameId>-999</geoNameId><gpsLatitude>999</gpsLatitude>"
        "<gpsLongitude>999</gpsLongitude></location>\n"
        " <scenarioTags><urban/><intersection/></scenarioTags>\n"
        + lanelets() + rules() + obstacles() + problem() + "</commonRoad>\n")
    (File(__file__).parent / "junction.xml").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
