"""Digital road maps become exact lanes, routes, smooth reference lines, plans and drives.

    import roadbed

    town = roadbed.open("town.xodr")                   # OpenDRIVE, Lanelet2, CommonRoad, .rbm
    found = town.locate([(150, 198), (270, 203)])      # arrays: found.lane, found.s_m, found.d_m
    way = town.route((150, 198), "lane:7/0/1@35")      # a Route, or why there is none
    line = way.reference_line()                        # line.sample(): x_m, y_m, heading_rad, …
    plan = line.plan((150, 198.25, 0), speed_mps=8)    # plan.trajectory, plan.candidates
    street = roadbed.Occupancy.open("town.bt")
    audit = street.audit(plan.trajectory)              # proof, or where it is not clear
    drive = roadbed.simulate("drive.json", planner)    # with one of yours in the loop

Positions are (N, 2) arrays of x and y, poses (N, 3) with the heading, all in the coordinates of
the file [m, rad]; the pose of a vehicle is that of its rear axle. Names carry their units. What
takes time runs without the interpreter's lock. "No" is a value with a reason; an input that cannot
be used raises InputError with the line that the program `roadbed` prints for it, which is installed
as well.
"""

from roadbed._roadbed import (
    Audit,
    CertificateCheck,
    CruiseControl,
    Drive,
    Error,
    InputError,
    Lane,
    Lanes,
    Located,
    Map,
    Observation,
    Obstacle,
    Occupancy,
    OutputError,
    Plan,
    Reach,
    ReferenceLine,
    Route,
    SeenObstacle,
    Trajectory,
    Validation,
    Vehicle,
    __version__,
    actuate,
    check,
    default_weights,
    layers,
    open,
    read_obstacles,
    simulate,
    single_track_step,
    stanley_gain,
    stanley_look_forward,
    stanley_steering,
    tracking_error,
    validate,
)

__all__ = [
    "Audit",
    "CertificateCheck",
    "CruiseControl",
    "Drive",
    "Error",
    "InputError",
    "Lane",
    "Lanes",
    "Located",
    "Map",
    "Observation",
    "Obstacle",
    "Occupancy",
    "OutputError",
    "Plan",
    "Reach",
    "ReferenceLine",
    "Route",
    "SeenObstacle",
    "Trajectory",
    "Validation",
    "Vehicle",
    "__version__",
    "actuate",
    "check",
    "default_weights",
    "layers",
    "open",
    "read_obstacles",
    "simulate",
    "single_track_step",
    "stanley_gain",
    "stanley_look_forward",
    "stanley_steering",
    "tracking_error",
    "validate",
]
