"""Road reference lines made of lines, arcs, clothoids and cubics, joined without a gap."""

from dataclasses import dataclass
from math import cos, hypot, pi, sin, sqrt

# Gauss-Legendre nodes and weights on [-1, 1], five points: exact for polynomials of degree 9.
_NODES = [
    (0.0, 128 / 225),
    (sqrt(5 - 2 * sqrt(10 / 7)) / 3, (322 + 13 * sqrt(70)) / 900),
    (-sqrt(5 - 2 * sqrt(10 / 7)) / 3, (322 + 13 * sqrt(70)) / 900),
    (sqrt(5 + 2 * sqrt(10 / 7)) / 3, (322 - 13 * sqrt(70)) / 900),
    (-sqrt(5 + 2 * sqrt(10 / 7)) / 3, (322 - 13 * sqrt(70)) / 900),
]


def integral(function, end, pieces=64):
    """Integral of the function from 0 to `end`; for the smooth ones here exact to rounding."""
    half = end / pieces / 2
    return sum(
        weight * half * function(half * (2 * i + 1 + node))
        for i in range(pieces)
        for node, weight in _NODES
    )


@dataclass(frozen=True)
class Pose:
    """A place and a direction; `*` places what the right one says in the frame of the left one."""

    x: float
    y: float
    heading: float

    def __mul__(self, other):
        c, s = cos(self.heading), sin(self.heading)
        return Pose(
            self.x + c * other.x - s * other.y,
            self.y + s * other.x + c * other.y,
            self.heading + other.heading,
        )

    def beside(self, t):
        """The pose `t` metres to the left, in the same direction."""
        return self * Pose(0, t, 0)

    def reverse(self):
        return Pose(self.x, self.y, self.heading + pi)

    def in_frame_of(self, frame):
        dx, dy = self.x - frame.x, self.y - frame.y
        c, s = cos(frame.heading), sin(frame.heading)
        turn = (self.heading - frame.heading + pi) % (2 * pi) - pi
        return Pose(c * dx + s * dy, c * dy - s * dx, turn)


@dataclass(frozen=True)
class Clothoid:
    """Curvature linear in length: a line, an arc or a spiral."""

    length: float
    start_curvature: float = 0.0
    end_curvature: float = 0.0

    def heading_at(self, s):
        rate = (self.end_curvature - self.start_curvature) / self.length
        return self.start_curvature * s + 0.5 * rate * s * s

    def end(self):
        return Pose(
            integral(lambda s: cos(self.heading_at(s)), self.length),
            integral(lambda s: sin(self.heading_at(s)), self.length),
            self.heading_at(self.length),
        )

    def scaled(self, factor):
        return Clothoid(
            self.length * factor, self.start_curvature / factor, self.end_curvature / factor
        )


class Cubic:
    """A cubic u(p), v(p), p from 0 to 1, from the origin along x to a pose; speed at both ends
    is the distance between them, times `pull`."""

    def __init__(self, target, pull=1.0):
        reach = pull * hypot(target.x, target.y)
        self.target = target
        du, dv = reach * cos(target.heading), reach * sin(target.heading)
        self.u = (0.0, reach, 3 * target.x - 2 * reach - du, -2 * target.x + reach + du)
        self.v = (0.0, 0.0, 3 * target.y - dv, -2 * target.y + dv)
        self.length = integral(self._speed, 1.0)

    def _speed(self, p):
        slope = lambda c: c[1] + p * (2 * c[2] + p * 3 * c[3])
        return hypot(slope(self.u), slope(self.v))

    def end(self):
        return self.target


class Path:
    """Pieces one after the other, each starting where the last one ends."""

    def __init__(self, start):
        self.start = self.end = start
        self.pieces = []  # (start pose, Clothoid or Cubic)

    @property
    def length(self):
        return sum(piece.length for _, piece in self.pieces)

    def add(self, piece):
        self.pieces.append((self.end, piece))
        self.end = self.end * piece.end()
        return self

    def line(self, length):
        return self.add(Clothoid(length))

    def arc(self, angle, radius):
        """Left for positive angles."""
        curvature = (1 if angle > 0 else -1) / radius
        return self.add(Clothoid(abs(angle) * radius, curvature, curvature))

    def bend(self, angle, radius, easing):
        """Spiral, arc, spiral; each spiral takes the share `easing` of the angle."""
        for piece in bend_pieces(angle, easing):
            self.add(piece.scaled(radius))
        return self

    def turn_to(self, target, easing=0.25, least_line=1.0):
        """Line, bend, line to a pose whose tangent crosses ours ahead: the widest such bend."""
        to = target.in_frame_of(self.end)
        behind = to.y / sin(to.heading)  # from the crossing of the tangents to the target
        ahead = to.x - behind * cos(to.heading)
        unit = Path(Pose(0, 0, 0)).bend(to.heading, 1.0, easing).end
        unit_tangent = unit.y / sin(to.heading)
        tangent = min(ahead, behind) - least_line
        if tangent <= 0:
            raise ValueError(f"no single bend leads from {self.end} to {target}")
        self.line(ahead - tangent)
        self.bend(to.heading, tangent / unit_tangent, easing)
        return self.line(behind - tangent)

    def cubic_to(self, target, pull=1.0):
        return self.add(Cubic(target.in_frame_of(self.end), pull))

    def line_to(self, target):
        return self.line(target.in_frame_of(self.end).x)


def bend_pieces(angle, easing):
    """Spiral, arc (none if easing is 1/2) and spiral of radius 1 that turn by `angle`."""
    curvature = 1 if angle > 0 else -1
    spiral = 2 * easing * abs(angle)
    arc = (1 - 2 * easing) * abs(angle)
    middle = [Clothoid(arc, curvature, curvature)] if arc > 0 else []
    return [Clothoid(spiral, 0.0, curvature), *middle, Clothoid(spiral, curvature, 0.0)]
