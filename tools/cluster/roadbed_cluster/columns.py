"""The columns of each kind's table: fixed, whatever the results hold."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pyarrow as pa

#: A member of a result as JSON gives it, or None.
Value = Any


@dataclass(frozen=True)
class Column:
    """A column, and how its value is found in a result's document."""

    name: str
    type: pa.DataType
    find: Callable[[dict[str, Value]], Value]


def _member(path: str) -> Callable[[dict[str, Value]], Value]:
    """Return a function that follows `a.b` into a document; None where there is no such member."""
    names = path.split(".")

    def find(document: dict[str, Value]) -> Value:
        found: Value = document
        for name in names:
            if not isinstance(found, dict):
                return None
            found = found.get(name)
        return found

    return find


def _columns(type_: pa.DataType, *paths: str) -> list[Column]:
    """Return a column for each path, named after it: `comfort.most_jerk_mps3` has a `_` for `.`."""
    return [Column(path.replace(".", "_"), type_, _member(path)) for path in paths]


def _structs(name: str, fields: dict[str, pa.DataType]) -> Column:
    """Return a column of lists of structs; a field `at_x_m` is also found at `at.x_m`."""
    type_ = pa.list_(pa.struct(list(fields.items())))

    def value(element: dict[str, Value], field: str) -> Value:
        head, _, tail = field.partition("_")
        inner = element.get(head)
        return inner.get(tail) if isinstance(inner, dict) else element.get(field)

    def find(document: dict[str, Value]) -> Value:
        elements = document.get(name)
        if not isinstance(elements, list):
            return None
        return [{field: cast(value(e, field), fields[field]) for field in fields} for e in elements]

    return Column(name, type_, find)


def _findings_of(severity: str) -> Callable[[dict[str, Value]], Value]:
    def find(document: dict[str, Value]) -> Value:
        findings = document.get("findings")
        if not isinstance(findings, list):
            return None
        return sum(finding.get("severity") == severity for finding in findings)

    return find


def cast(value: Value, type_: pa.DataType) -> Value:
    """Return `value` if it is of that type (a whole number is also a float), else None."""
    if pa.types.is_floating(type_):
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return float(value) if is_number else None
    if pa.types.is_integer(type_):
        return value if isinstance(value, int) and not isinstance(value, bool) else None
    if pa.types.is_boolean(type_):
        return value if isinstance(value, bool) else None
    if pa.types.is_string(type_):
        return value if isinstance(value, str) else None
    return value


_TEXT, _WHOLE, _NUMBER, _FLAG = pa.string(), pa.int64(), pa.float64(), pa.bool_()

#: What every table begins with; `line` is the job's in the file of jobs, from 1.
COMMON = [
    ("line", _WHOLE),
    ("hash", _TEXT),
    ("status", _TEXT),
    ("exit", _WHOLE),
    ("reason", _TEXT),
    ("cause", _TEXT),
    ("inputs", pa.list_(_TEXT)),
    ("options", _TEXT),
    ("files", pa.list_(_TEXT)),
]

#: The columns of each kind between those and `result`, the whole document as JSON.
COLUMNS: dict[str, list[Column]] = {
    "import": [
        *_columns(_TEXT, "format", "crs"),
        *_columns(_WHOLE, "roads", "lanes", "junctions", "signals", "faults"),
    ],
    "validate": [
        Column("errors", _WHOLE, _findings_of("error")),
        Column("warnings", _WHOLE, _findings_of("warning")),
        Column("infos", _WHOLE, _findings_of("info")),
        _structs(
            "findings",
            {
                "rule": _TEXT,
                "asam_rule": _TEXT,
                "autoware_issue": _TEXT,
                "severity": _TEXT,
                "element": _TEXT,
                "line": _WHOLE,
                "x_m": _NUMBER,
                "y_m": _NUMBER,
                "message": _TEXT,
            },
        ),
    ],
    "route": [
        *_columns(_FLAG, "found"),
        *_columns(_NUMBER, "cost_s", "cost_m", "length_m"),
        *_columns(_WHOLE, "lane_changes", "legs_of_unknown_speed"),
        *_columns(_NUMBER, "gap_m"),
        _structs(
            "lanes",
            {
                "lane": _TEXT,
                "from_s_m": _NUMBER,
                "to_s_m": _NUMBER,
                "length_m": _NUMBER,
                "cost_s": _NUMBER,
                "turn": _TEXT,
                "exit": _TEXT,
            },
        ),
    ],
    "simulate": [
        *_columns(_TEXT, "scenario"),
        *_columns(_WHOLE, "seed"),
        *_columns(_TEXT, "outcome", "text"),
        *_columns(_FLAG, "goal_reached", "collision"),
        *_columns(
            _NUMBER,
            "duration_s",
            "driven_m",
            "to_goal_m",
            "least_clearance_m",
            "least_clearance_at_s",
            "least_time_to_collision_s",
            "least_time_to_collision_at_s",
            "least_headway_s",
            "least_headway_at_s",
            "wrong_way_m",
            "progress_m",
            "largest_speed_mps",
            "largest_over_speed_mps",
            "over_speed_m",
            "largest_acceleration_mps2",
            "largest_deceleration_mps2",
            "largest_lateral_acceleration_mps2",
            "comfort.least_longitudinal_mps2",
            "comfort.most_longitudinal_mps2",
            "comfort.most_lateral_mps2",
            "comfort.most_yaw_acceleration_radps2",
            "comfort.most_yaw_rate_radps",
            "comfort.most_longitudinal_jerk_mps3",
            "comfort.most_jerk_mps3",
        ),
        *_columns(_FLAG, "comfort.is_comfortable"),
        *_columns(
            _NUMBER,
            "largest_cross_track_m",
            "cross_track_rms_m",
            "largest_heading_error_rad",
            "largest_off_road_m",
            "saturated_share",
            "behaviour.cruise_s",
            "behaviour.pass_s",
            "behaviour.follow_s",
            "behaviour.stop_s",
            "behaviour.emergency_s",
        ),
        *_columns(_WHOLE, "cycles", "cycles_without_candidate", "cycles_from_measurement"),
    ],
    "audit": [
        *_columns(_TEXT, "verdict"),
        *_columns(_NUMBER, "least_clearance_m", "proven_clearance_m", "least_clearance_at_s"),
        *_columns(_FLAG, "beyond_horizon"),
        *_columns(_TEXT, "obstacle", "part"),
        *_columns(_NUMBER, "unknown_share"),
        _structs(
            "conflicts",
            {
                "from_s": _NUMBER,
                "to_s": _NUMBER,
                "least_clearance_m": _NUMBER,
                "part": _TEXT,
                "obstacle": _TEXT,
                "at_t_s": _NUMBER,
                "at_x_m": _NUMBER,
                "at_y_m": _NUMBER,
                "at_heading_rad": _NUMBER,
            },
        ),
    ],
}
