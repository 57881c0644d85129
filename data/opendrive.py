"""A small writer of OpenDRIVE 1.6: roads with lane sections, junctions, signals."""

from dataclasses import dataclass, field
from xml.etree import ElementTree

from plan_view import Clothoid, Path


def text(value):
    """A number as text that reads back to the same double."""
    return str(value) if isinstance(value, (int, str)) else repr(float(value))


@dataclass
class Poly3:
    """a + b s + c s^2 + d s^3 from station s on."""

    s: float
    a: float
    b: float = 0.0
    c: float = 0.0
    d: float = 0.0

    def attributes(self, station="s"):
        return {station: self.s, "a": self.a, "b": self.b, "c": self.c, "d": self.d}


def smooth(s, start, end, length):
    """A cubic from one value to another that begins and ends flat."""
    return Poly3(s, start, 0.0, 3 * (end - start) / length**2, -2 * (end - start) / length**3)


def ramp(stations, values):
    """Cubics through values at stations, flat at each of them."""
    cubics = []
    for (s, value), (s_next, next_value) in zip(
        zip(stations, values), zip(stations[1:], values[1:])
    ):
        cubics.append(smooth(s, value, next_value, s_next - s))
    return cubics + [Poly3(stations[-1], values[-1])]


@dataclass
class Mark:
    """A line on the road. `change`: OpenDRIVE's both, increase, decrease or none."""

    type: str = "solid"
    change: str = "none"
    colour: str = "white"
    width: float = 0.12


SOLID, DOUBLE, EDGE = Mark(), Mark("solid solid", width=0.3), Mark("none", width=0.0)
BROKEN = Mark("broken", "both")


@dataclass
class Lane:
    """A lane of a section. Lanes with the same key are linked from section to section."""

    key: str
    type: str = "driving"
    width: object = 3.5  # a number, or a list of Poly3 by section station
    mark: Mark = field(default_factory=lambda: EDGE)
    speed_kmh: object = None


@dataclass
class Section:
    """Lanes from station s on, each side from the centre outwards."""

    s: float
    left: list
    right: list
    mark: Mark = field(default_factory=lambda: BROKEN)

    def id_of(self, key):
        for side, sign in ((self.left, 1), (self.right, -1)):
            for number, lane in enumerate(side, start=1):
                if lane.key == key:
                    return sign * number
        return None


@dataclass
class Signal:
    id: int
    s: float
    t: float
    orientation: str
    type: str
    name: str
    subtype: str = "-1"
    dynamic: bool = False
    value: object = None
    lanes: object = None  # first and last lane id that it speaks to


@dataclass
class Road:
    id: int
    name: str
    path: Path
    sections: list
    speed_kmh: float = 50
    kind: str = "town"
    types: list = field(default_factory=list)  # (s, kind, speed) where it changes on the way
    junction: int = -1
    offset: list = field(default_factory=list)
    elevation: list = field(default_factory=list)
    superelevation: list = field(default_factory=list)
    signals: list = field(default_factory=list)
    # ("road" or "junction", id, "start" or "end" or None)
    predecessor: object = None
    successor: object = None
    # Connecting roads: lane ids of the neighbours by lane key.
    predecessor_lanes: dict = field(default_factory=dict)
    successor_lanes: dict = field(default_factory=dict)


@dataclass
class Junction:
    id: int
    name: str
    connections: list = field(default_factory=list)  # (incoming, connecting, [(from, to)])
    controllers: list = field(default_factory=list)


def child(parent, tag, **attributes):
    named = {key.rstrip("_"): text(value) for key, value in attributes.items()}
    return ElementTree.SubElement(parent, tag, named)


def write_link(element, road):
    link = child(element, "link")
    for tag, neighbour in (("predecessor", road.predecessor), ("successor", road.successor)):
        if neighbour is None:
            continue
        kind, number, contact = neighbour
        node = child(link, tag, elementType=kind, elementId=number)
        if contact is not None:
            node.set("contactPoint", contact)


def write_types(element, road):
    for s, kind, speed in [(0.0, road.kind, road.speed_kmh)] + road.types:
        child(child(element, "type", s=s, type=kind), "speed", max=speed, unit="km/h")


def write_piece(plan_view, s, pose, piece):
    node = child(
        plan_view, "geometry", s=s, x=pose.x, y=pose.y, hdg=pose.heading, length=piece.length
    )
    if not isinstance(piece, Clothoid):
        (a_u, b_u, c_u, d_u), (a_v, b_v, c_v, d_v) = piece.u, piece.v
        child(
            node, "paramPoly3", aU=a_u, bU=b_u, cU=c_u, dU=d_u, aV=a_v, bV=b_v, cV=c_v, dV=d_v,
            pRange="normalized",
        )
    elif piece.start_curvature != piece.end_curvature:
        child(node, "spiral", curvStart=piece.start_curvature, curvEnd=piece.end_curvature)
    elif piece.start_curvature != 0:
        child(node, "arc", curvature=piece.start_curvature)
    else:
        child(node, "line")


def write_plan_view(element, road):
    plan_view = child(element, "planView")
    s = 0.0
    for pose, piece in road.path.pieces:
        write_piece(plan_view, s, pose, piece)
        s += piece.length


def write_cubics(element, tag, cubics, station="s"):
    for cubic in cubics:
        child(element, tag, **cubic.attributes(station))


def write_mark(node, mark):
    child(
        node, "roadMark", sOffset=0.0, type=mark.type, weight="standard", color=mark.colour,
        width=mark.width, laneChange=mark.change,
    )


def neighbour_lanes(road, index, lane):
    """Lane ids before and after a lane: of the next sections, or of the next roads."""

    def beyond(step, at_end):
        neighbour = index + step
        if 0 <= neighbour < len(road.sections):
            return road.sections[neighbour].id_of(lane.key)
        return at_end.get(lane.key)

    return beyond(-1, road.predecessor_lanes), beyond(1, road.successor_lanes)


def write_lane(side, number, lane, before, after):
    node = child(side, "lane", id=number, type=lane.type, level="false")
    link = child(node, "link")
    if before is not None:
        child(link, "predecessor", id=before)
    if after is not None:
        child(link, "successor", id=after)
    widths = lane.width if isinstance(lane.width, list) else [Poly3(0.0, lane.width)]
    write_cubics(node, "width", widths, "sOffset")
    write_mark(node, lane.mark)
    if lane.speed_kmh is not None:
        child(node, "speed", sOffset=0.0, max=lane.speed_kmh, unit="km/h")


def write_section(lanes, road, index):
    section = road.sections[index]
    node = child(lanes, "laneSection", s=section.s)
    if section.left:
        side = child(node, "left")
        for number in range(len(section.left), 0, -1):
            lane = section.left[number - 1]
            write_lane(side, number, lane, *neighbour_lanes(road, index, lane))
    centre = child(child(node, "center"), "lane", id=0, type="none", level="false")
    write_mark(centre, section.mark)
    if section.right:
        side = child(node, "right")
        for number, lane in enumerate(section.right, start=1):
            write_lane(side, -number, lane, *neighbour_lanes(road, index, lane))


def write_signal(parent, signal):
    node = child(
        parent, "signal", s=signal.s, t=signal.t, id=signal.id, name=signal.name,
        dynamic="yes" if signal.dynamic else "no", orientation=signal.orientation, zOffset=2.5,
        country="OpenDRIVE" if signal.dynamic else "DE", type=signal.type,
        subtype=signal.subtype, height=0.9, width=0.6,
    )
    if signal.value is not None:
        node.set("value", text(signal.value))
        node.set("unit", "km/h")
    if signal.lanes is not None:
        child(node, "validity", fromLane=signal.lanes[0], toLane=signal.lanes[1])


def write_road(root, road):
    element = child(
        root, "road", name=road.name, length=road.path.length, id=road.id,
        junction=road.junction, rule="RHT",
    )
    write_link(element, road)
    write_types(element, road)
    write_plan_view(element, road)
    write_cubics(child(element, "elevationProfile"), "elevation", road.elevation)
    write_cubics(child(element, "lateralProfile"), "superelevation", road.superelevation)
    lanes = child(element, "lanes")
    write_cubics(lanes, "laneOffset", road.offset)
    for index in range(len(road.sections)):
        write_section(lanes, road, index)
    if road.signals:
        signals = child(element, "signals")
        for signal in road.signals:
            write_signal(signals, signal)


def write_junction(root, junction):
    node = child(root, "junction", name=junction.name, id=junction.id, type="default")
    for number, (incoming, connecting, links) in enumerate(junction.connections):
        connection = child(
            node, "connection", id=number, incomingRoad=incoming, connectingRoad=connecting,
            contactPoint="start",
        )
        for from_lane, to_lane in links:
            child(connection, "laneLink", from_=from_lane, to=to_lane)
    for number, controller in enumerate(junction.controllers):
        child(node, "controller", id=controller, type="0", sequence=number)


def write_map(file, name, crs, roads, junctions, controllers):
    """`controllers`: (id, name, [signal id])."""
    root = ElementTree.Element("OpenDRIVE")
    header = child(root, "header", revMajor=1, revMinor=6, name=name, version="1.00")
    child(header, "geoReference").text = crs
    for road in roads:
        write_road(root, road)
    for number, controller, signals in controllers:
        node = child(root, "controller", name=controller, id=number, sequence=0)
        for signal in signals:
            child(node, "control", signalId=signal, type="0")
    for junction in junctions:
        write_junction(root, junction)
    ElementTree.indent(root, " ")
    with open(file, "wb") as out:
        ElementTree.ElementTree(root).write(out, encoding="UTF-8", xml_declaration=True)
        out.write(b"\n")
