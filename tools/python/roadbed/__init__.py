"""Digital road maps become exact lanes, routes, smooth reference lines, plans and drives.

    import roadbed

    town = roadbed.open("town.xodr")                   # OpenDRIVE, Lanelet2, CommonRoad, .rbm
    found = town.locate([(150, 198), (270, 203)])      # arrays: found.lane, found.s_m, found.d_m
    way = town.route((150, 198), "lane:7/0/1@35")      # a Route, or why there is none
    line = way.reference_line().sample(step_m=0.5)     # columns: x_m, y_m, curvature_per_m, …

Positions are (N, 2) arrays of x and y, poses (N, 3) with the heading, all in the coordinates of the
file [m, rad]; the pose of a vehicle is that of its rear axle. Names carry their units. What takes
time runs without the interpreter's lock. "No" is a value with a reason; an input that cannot be used
raises InputError with the line that the program `roadbed` prints for it, which is installed as well.
"""

from roadbed._roadbed import (
    Audit,
    CertificateCheck,
    Error,
    InputError,
    Lane,
    Lanes,
    Located,
    Map,
    Obstacle,
    Occupancy,
    OutputError,
    Reach,
    ReferenceLine,
    Route,
    Trajectory,
    Validation,
    Vehicle,
    __version__,
    check,
    layers,
    open,  # noqa: A004
    read_obstacles,
    validate,
)

__all__ = [
    "Audit",
    "CertificateCheck",
    "Error",
    "InputError",
    "Lane",
    "Lanes",
    "Located",
    "Map",
    "Obstacle",
    "Occupancy",
    "OutputError",
    "Reach",
    "ReferenceLine",
    "Route",
    "Trajectory",
    "Validation",
    "Vehicle",
    "__version__",
    "check",
    "layers",
    "open",
    "read_obstacles",
    "validate",
]
