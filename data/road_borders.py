"""Reads the roads of an OpenDRIVE file: where the borders of its lanes are."""

from math import atan2, cos, sin
from xml.etree import ElementTree


def number(node, name):
    return float(node.get(name))


def in_piece(node, ds):
    """Pose after ds metres of a <geometry>."""
    x, y, heading, length = (number(node, name) for name in ("x", "y", "hdg", "length"))
    shape = node[0]
    if shape.tag == "paramPoly3":
        p = ds / length
        a, b, c, d = (number(shape, k + "U") for k in "abcd")
        u, du = a + p * (b + p * (c + p * d)), b + p * (2 * c + 3 * p * d)
        a, b, c, d = (number(shape, k + "V") for k in "abcd")
        v, dv = a + p * (b + p * (c + p * d)), b + p * (2 * c + 3 * p * d)
        turn = atan2(dv, du)
    elif shape.tag == "arc":
        k = number(shape, "curvature")
        u, v, turn = sin(k * ds) / k, (1 - cos(k * ds)) / k, k * ds
    elif shape.tag == "spiral":
        k0, k1 = number(shape, "curvStart"), number(shape, "curvEnd")
        angle = lambda s: k0 * s + (k1 - k0) / length * s * s / 2
        steps = 2000  # Simpson's rule
        weights = [1] + [4, 2] * (steps // 2 - 1) + [4, 1]
        grid = [angle(ds * i / steps) for i in range(steps + 1)]
        u = ds / steps / 3 * sum(w * cos(a) for w, a in zip(weights, grid))
        v = ds / steps / 3 * sum(w * sin(a) for w, a in zip(weights, grid))
        turn = angle(ds)
    else:
        u, v, turn = ds, 0.0, 0.0
    c, s = cos(heading), sin(heading)
    return x + c * u - s * v, y + s * u + c * v, heading + turn


def value(nodes, s, station="s", base=0.0):
    """The cubic that holds at s, 0 where there is none."""
    held = [node for node in nodes if number(node, station) + base <= s + 1e-9]
    if not held:
        return 0.0
    ds = s - base - number(held[-1], station)
    a, b, c, d = (number(held[-1], k) for k in "abcd")
    return a + ds * (b + ds * (c + ds * d))


class Road:
    def __init__(self, node):
        self.node, self.id, self.length = node, node.get("id"), number(node, "length")
        self.pieces = node.findall("planView/geometry")
        self.sections = node.findall("lanes/laneSection")
        starts = [number(section, "s") for section in self.sections]
        self.ranges = list(zip(starts, starts[1:] + [self.length]))
        self.in_junction = node.get("junction") != "-1"

    def lanes(self, section):
        return {int(lane.get("id")): lane
                for side in ("left", "right") for lane in section.findall(side + "/lane")}

    def borders(self, index, lane, s):
        """Inner and outer border of a lane at road station s."""
        section, base = self.sections[index], self.ranges[index][0]
        lanes, sign = self.lanes(section), 1 if lane > 0 else -1
        widths = [value(lanes[sign * k].findall("width"), s, "sOffset", base)
                  for k in range(1, abs(lane) + 1)]
        offset = value(self.node.findall("lanes/laneOffset"), s)
        piece = [p for p in self.pieces if number(p, "s") <= s + 1e-9][-1]
        x, y, heading = in_piece(piece, s - number(piece, "s"))
        flat = cos(value(self.node.findall("lateralProfile/superelevation"), s))
        z = value(self.node.findall("elevationProfile/elevation"), s)
        at = lambda t: (x - sin(heading) * t * flat, y + cos(heading) * t * flat, z)
        return at(offset + sign * sum(widths[:-1])), at(offset + sign * sum(widths))

    def middle(self, index, lane, s):
        """Pose (x, y, heading) in the middle of a lane, in its driving direction."""
        at = lambda s: [(a + b) / 2 for a, b in zip(*self.borders(index, lane, s))]
        (x, y, _), step = at(s), 1e-3 if s < self.length / 2 else -1e-3
        x_on, y_on, _ = at(s + step)
        towards = step if lane < 0 else -step
        return x, y, atan2((y_on - y) * towards, (x_on - x) * towards)


def read_roads(root):
    """Roads by id. `root`: the document's element."""
    return {node.get("id"): Road(node) for node in root.findall("road")}
