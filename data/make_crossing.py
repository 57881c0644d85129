#!/usr/bin/env python3
"""Makes crossing.osm, a small invented crossroads as a Lanelet2 map. Usage: data/make_crossing.py

The README beside it says what is there.
"""

from math import atan, atan2, atanh, cos, cosh, degrees, hypot, radians, sin, sinh, sqrt
from pathlib import Path

ZONE, SQUARE_EAST, SQUARE_NORTH = 32, 400_000.0, 5_400_000.0  # of local_x, local_y
CENTRE = (700.0, 300.0)
LANE, ARM_START, ARM_END = 3.5, 18.0, 78.0  # m


def geographic(east, north):
    """Latitude and longitude [degrees] of a place in UTM: Krüger's series to the fourth order."""
    f = 1 / 298.257223563
    n = f / (2 - f)
    radius = 0.9996 * 6378137 / (1 + n) * (1 + n**2 / 4 + n**4 / 64)
    beta = (n / 2 - 2 / 3 * n**2 + 37 / 96 * n**3 - n**4 / 360,
            n**2 / 48 + n**3 / 15 - 437 / 1440 * n**4,
            17 / 480 * n**3 - 37 / 840 * n**4,
            4397 / 161280 * n**4)
    xi, eta = north / radius, (east - 500_000) / radius
    xi_s = xi - sum(b * sin(2 * j * xi) * cosh(2 * j * eta) for j, b in enumerate(beta, 1))
    eta_s = eta - sum(b * cos(2 * j * xi) * sinh(2 * j * eta) for j, b in enumerate(beta, 1))
    conformal = sin(xi_s) / hypot(sinh(eta_s), cos(xi_s))
    e = sqrt(f * (2 - f))
    tau = conformal
    for _ in range(6):  # Newton's method from the conformal to the geographic latitude
        sigma = sinh(e * atanh(e * tau / hypot(1, tau)))
        at = tau * hypot(1, sigma) - sigma * hypot(1, tau)
        tau += ((conformal - at) / hypot(1, at) * (1 + (1 - e * e) * tau * tau)
                / ((1 - e * e) * hypot(1, tau)))
    return degrees(atan(tau)), 6 * ZONE - 183 + degrees(atan2(sinh(eta_s), cos(xi_s)))


class Osm:
    """Elements as they are added; equal places are one node, equal lines one way."""

    def __init__(self):
        self.texts, self.nodes, self.ways, self.count = [[], [], []], {}, {}, 0

    def next(self):
        self.count += 1
        return self.count

    @staticmethod
    def tags(tags):
        return "".join(f'    <tag k="{k}" v="{v}"/>\n' for k, v in tags.items())

    def node(self, point):
        x, y = round(point[0], 4), round(point[1], 4)
        if (x, y) not in self.nodes:
            self.nodes[x, y] = number = self.next()
            lat, lon = geographic(SQUARE_EAST + x, SQUARE_NORTH + y)
            z = 110 + 0.01 * (x - CENTRE[0])  # the ground rises eastwards
            self.texts[0].append(
                f'  <node id="{number}" lat="{lat:.11f}" lon="{lon:.11f}">\n'
                + self.tags({"local_x": f"{x:.4f}", "local_y": f"{y:.4f}", "ele": f"{z:.4f}"})
                + "  </node>\n")
        return self.nodes[x, y]

    def way(self, points, **tags):
        nodes = tuple(self.node(p) for p in points)
        for known in (nodes, nodes[::-1]):
            if known in self.ways:
                return self.ways[known]
        self.ways[nodes] = number = self.next()
        refs = "".join(f'    <nd ref="{n}"/>\n' for n in nodes)
        self.texts[1].append(f'  <way id="{number}">\n{refs}{self.tags(tags)}  </way>\n')
        return number

    def relation(self, members, **tags):
        number = self.next()
        lines = "".join(f'    <member type="{kind}" ref="{ref}" role="{role}"/>\n'
                        for kind, ref, role in members)
        tags = {k.replace("__", ":"): v for k, v in tags.items()}
        self.texts[2].append(f'  <relation id="{number}">\n{lines}{self.tags(tags)}  </relation>\n')
        return number

    def lanelet(self, left, right, rules=(), **tags):
        members = [("way", left, "left"), ("way", right, "right")]
        members += [("relation", rule, "regulatory_element") for rule in rules]
        return self.relation(members, type="lanelet", location="urban", **tags)

    def text(self):
        body = "".join("".join(part) for part in self.texts)
        return f'<?xml version="1.0" encoding="UTF-8"?>\n<osm version="0.6">\n{body}</osm>\n'


class Arm:
    """One of the four roads: places by distance from the crossing's centre and offset to the left
    of the direction away from it. Traffic keeps right: out at negative offsets, in at positive."""

    def __init__(self, angle_deg, lanes):
        self.u = round(cos(radians(angle_deg))), round(sin(radians(angle_deg)))
        self.lanes = lanes

    def at(self, along, offset):
        (ux, uy), (cx, cy) = self.u, CENTRE
        return cx + along * ux - offset * uy, cy + along * uy + offset * ux

    def line(self, offset):
        return [self.at(ARM_START + (ARM_END - ARM_START) * k / 4, offset) for k in range(5)]

    def mouth(self, lane, inwards):
        """Ends of a lane's left and right border at the crossing, and the direction of driving."""
        near, far = lane * LANE, (lane + 1) * LANE
        sign = 1 if inwards else -1
        direction = tuple(-sign * c for c in self.u)
        return self.at(ARM_START, sign * near), self.at(ARM_START, sign * far), direction


def curve(start, start_direction, end, end_direction):
    """A cubic that leaves and arrives in the given directions."""
    reach = 0.55 * hypot(end[0] - start[0], end[1] - start[1])
    a = [s + reach * d for s, d in zip(start, start_direction)]
    b = [e - reach * d for e, d in zip(end, end_direction)]
    points = []
    for k in range(9):
        t = k / 8
        w = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3)
        points.append(tuple(sum(c * p[i] for c, p in zip(w, (start, a, b, end))) for i in (0, 1)))
    return points


ARMS = {"east": Arm(0, 2), "north": Arm(90, 1), "west": Arm(180, 1), "south": Arm(270, 1)}
ORDER = list(ARMS)
LIMITS = {"east": "60", "west": "50", "north": None, "south": "30 mph"}
THIN = {"type": "line_thin"}


def add_lights(osm, arm):
    stop = osm.way([arm.at(ARM_START + 1, LANE * arm.lanes), arm.at(ARM_START + 1, 0)],
                   type="stop_line", subtype="solid")
    light = osm.way([arm.at(-ARM_START, 0.3), arm.at(-ARM_START, 0.0)],
                    type="traffic_light", subtype="red_yellow_green")
    return osm.relation([("way", light, "refers"), ("way", stop, "ref_line")],
                        type="regulatory_element", subtype="traffic_light")


def add_arm(osm, name):
    arm = ARMS[name]
    middle = osm.way(arm.line(0), subtype="solid", **THIN)
    rules = [add_lights(osm, arm)]
    limit = {"speed_limit": LIMITS[name]} if LIMITS[name] else {}
    more = []
    if name == "north":
        sign = osm.way([arm.at(30, -8), arm.at(30, -7.4)], type="traffic_sign", subtype="de274-30")
        more = [osm.relation([("way", sign, "refers")],
                             type="regulatory_element", subtype="speed_limit")]
    for inwards in (True, False):
        sign, inner = (1 if inwards else -1), middle
        for lane in range(1, arm.lanes + 1):
            edge = {"type": "curbstone", "subtype": "high"}
            if name == "north" and not inwards:
                edge = {"subtype": "solid", **THIN}  # beyond it is the bicycle lane
            mark = edge if lane == arm.lanes else {"subtype": "dashed", **THIN}
            outer = osm.way(arm.line(sign * lane * LANE), **mark)
            osm.lanelet(inner, outer, (rules if inwards else []) + more, subtype="road",
                        one_way="yes", **limit)
            inner = outer
        if name == "north" and not inwards:
            kerb = osm.way(arm.line(-LANE - 1.5), type="curbstone", subtype="low")
            osm.lanelet(inner, kerb, subtype="bicycle_lane", one_way="yes")


def add_movement(osm, start, from_lane, end, to_lane, turn):
    left, right, direction = ARMS[start].mouth(from_lane, True)
    to_left, to_right, to_direction = ARMS[end].mouth(to_lane, False)
    osm.lanelet(osm.way(curve(left, direction, to_left, to_direction), type="virtual"),
                osm.way(curve(right, direction, to_right, to_direction), type="virtual"),
                subtype="road", one_way="yes", turn_direction=turn, speed_limit="30")


def add_movements(osm):
    for i, start in enumerate(ORDER):
        for quarter, turn in ((1, "left"), (2, "straight"), (3, "right")):
            end = ORDER[(i - quarter) % 4]  # from the east, the left turn leads to the south
            from_lane = 0 if turn == "left" else ARMS[start].lanes - 1
            to_lane = 0 if turn == "left" else ARMS[end].lanes - 1
            add_movement(osm, start, from_lane, end, to_lane, turn)


def add_surroundings(osm):
    west, south = ARMS["west"], ARMS["south"]
    a = [west.at(14, LANE + 1), west.at(14, 0), west.at(14, -LANE - 1)]
    b = [west.at(17, LANE + 1), west.at(17, 0), west.at(17, -LANE - 1)]
    osm.lanelet(osm.way(a, type="pedestrian_marking"), osm.way(b, type="pedestrian_marking"),
                subtype="crosswalk", one_way="no")
    corners = [south.at(d, o) for d, o in ((30, 5), (60, 5), (60, 25), (30, 25))]
    island = [south.at(d, o) for d, o in ((40, 12), (50, 12), (50, 18), (40, 18))]
    outer = [osm.way(corners[:3], type="curbstone", subtype="low"),
             osm.way([corners[2], corners[3], corners[0]], type="curbstone", subtype="low")]
    inner = osm.way(island + island[:1], type="curbstone", subtype="high")
    osm.relation([("way", w, "outer") for w in outer] + [("way", inner, "inner")],
                 type="multipolygon", subtype="parking", location="urban",
                 participant__vehicle="yes")
    osm.way([west.at(d, -10) for d in (20, 40, 60)], type="fence")


def main():
    osm = Osm()
    for name in ARMS:
        add_arm(osm, name)
    add_movements(osm)
    add_surroundings(osm)
    Path(__file__).with_name("crossing.osm").write_text(osm.text(), encoding="utf-8")


if __name__ == "__main__":
    main()
