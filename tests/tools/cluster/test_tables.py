"""Tables hold what the results hold, in their order, and other programs read them."""

import json
import math
from pathlib import Path
from typing import Any

import geopandas
import pyarrow.parquet as pq
import pytest
import shapely

from roadbed_cluster import tables
from roadbed_cluster.columns import COLUMNS
from roadbed_cluster.errors import UnusableResults

KINDS = list(COLUMNS)
CRS = "+proj=tmerc +lat_0=48.5 +lon_0=9 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs"


def result(kind: str | None, number: int, document: object, **changes: object) -> dict[str, Any]:
    """Return a result as `roadbed batch` writes it."""
    return {
        "line": number, "hash": f"{number:064x}", "job": kind,
        "status": "done", "exit": 0, "reason": "",
        "cause": None, "inputs": ["a.xodr"], "options": {"inflate": 0.2}, "outputs": [],
        "result": document, "files": [], **changes,
    }  # fmt: skip


def write_results(folder: Path, results: list[dict[str, Any]]) -> Path:
    """Write a folder of results."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = "".join(f"{json.dumps(each)}\n" for each in results)
    (folder / "results.jsonl").write_text(lines, encoding="utf-8")
    return folder


def audit(x_m: float, y_m: float) -> dict[str, Any]:
    """Return an audit's document with one conflict."""
    at = {"t_s": 2.5, "x_m": x_m, "y_m": y_m, "heading_rad": 0.25}
    conflict = {"from_s": 2.0, "to_s": 3, "from": at, "least_clearance_m": 0.0, "at": at,
                "part": "front left", "obstacle": None, "witness": {}}  # fmt: skip
    return {"verdict": "conflict", "least_clearance_m": 0, "beyond_horizon": False,
            "unknown_share": 0.125, "conflicts": [conflict]}  # fmt: skip


def mixed(folder: Path) -> Path:
    """Write results of every kind."""
    (folder / "files/00/route").mkdir(parents=True)
    drive = "t_s,x_m,y_m,heading_rad\n0,1,2,0\n1,4,6,0\n"
    (folder / "files/00/trajectory.csv").write_text(drive)
    way = {"type": "LineString", "coordinates": [[7.0, 8.0], [9.5, 8.0]]}
    collection = {"crs": {"properties": {"name": CRS}}, "features": [{"geometry": way}]}
    (folder / "files/00/way.geojson").write_text(json.dumps(collection))
    finding = {"rule": "geometry.gap", "severity": "error", "x_m": 3.0, "y_m": 4.0, "line": 7}
    nowhere = {"rule": "id", "severity": "warning", "x_m": None, "y_m": None, "line": None}
    return write_results(folder, [
        result("audit", 0, audit(10.0, 20.0), status="no", exit=1, reason="conflict"),
        result("import", 1, {"format": "OpenDRIVE", "crs": None, "roads": 3, "lanes": 14}),
        result("audit", 2, None, status="failed", exit=None, reason="crashed", cause="crash"),
        result("validate", 3, {"findings": [finding, nowhere]}),
        result(None, 4, None, status="failed", cause="line"),
        result("simulate", 5, {"seed": 4, "comfort": {"most_jerk_mps3": 1.5}},
               files=["files/00/trajectory.csv"]),
        result("route", 6, {"found": True, "cost_s": 45}, files=["files/00/way.geojson"]),
        result("audit", 7, audit(-5.0, 30.0)),
    ])  # fmt: skip


def test_every_result_is_a_row_of_its_kinds_table_in_order(tmp_path: Path) -> None:
    written = tables.write_tables(mixed(tmp_path))
    assert [path.stem for path in written] == sorted(KINDS)
    rows = pq.read_table(tmp_path / "tables/audit.parquet").to_pylist()
    assert [row["line"] for row in rows] == [0, 2, 7]
    assert [row["status"] for row in rows] == ["no", "failed", "done"]
    assert rows[0]["least_clearance_m"] == 0.0
    assert rows[0]["conflicts"][0]["at_heading_rad"] == 0.25
    assert rows[0]["conflicts"][0]["to_s"] == 3.0
    assert json.loads(rows[0]["result"]) == audit(10.0, 20.0)
    assert rows[1]["verdict"] is None and rows[1]["geometry"] is None
    (drive,) = pq.read_table(tmp_path / "tables/simulate.parquet").to_pylist()
    assert (drive["seed"], drive["comfort_most_jerk_mps3"]) == (4, 1.5)
    (findings,) = pq.read_table(tmp_path / "tables/validate.parquet").to_pylist()
    assert (findings["errors"], findings["warnings"], findings["infos"]) == (1, 1, 0)


@pytest.mark.parametrize(
    ("kind", "shapes"),
    [
        ("audit", ["MULTIPOINT ((10 20))", None, "MULTIPOINT ((-5 30))"]),
        ("validate", ["MULTIPOINT ((3 4))"]),
        ("simulate", ["LINESTRING (1 2, 4 6)"]),
        ("route", ["LINESTRING (7 8, 9.5 8)"]),
    ],
)
def test_geopandas_reads_the_geometry(tmp_path: Path, kind: str, shapes: list[str | None]) -> None:
    tables.write_tables(mixed(tmp_path))
    path = tmp_path / f"tables/{kind}.parquet"
    frame = geopandas.read_parquet(path)
    found = [
        None if shape is None else shapely.to_wkt(shape, trim=True) for shape in frame.geometry
    ]
    assert found == shapes
    geo = json.loads(pq.read_metadata(path).metadata[b"geo"])
    assert geo["version"] == "1.1.0"
    assert geo["columns"]["geometry"]["bbox"] == list(frame.total_bounds)
    assert (frame.crs is not None) == (kind == "route")
    if frame.crs is not None:
        assert math.isclose(frame.crs.to_dict()["lat_0"], 48.5)


def test_tables_are_the_same_bytes_each_time(tmp_path: Path) -> None:
    folders = [mixed(tmp_path / "a"), mixed(tmp_path / "b")]
    for folder in folders:
        tables.write_tables(folder)
    for kind in KINDS:
        first, second = (folder / f"tables/{kind}.parquet" for folder in folders)
        assert first.read_bytes() == second.read_bytes()


def test_columns_do_not_depend_on_what_the_results_hold(tmp_path: Path) -> None:
    full = tables.write_tables(mixed(tmp_path / "full"))
    empty = write_results(tmp_path / "empty", [result(kind, 0, None) for kind in KINDS])
    for path, bare in zip(full, tables.write_tables(empty), strict=True):
        assert pq.read_schema(path).equals(pq.read_schema(bare))


def test_a_table_without_results_any_more_is_removed(tmp_path: Path) -> None:
    tables.write_tables(mixed(tmp_path))
    write_results(tmp_path, [result("import", 0, None)])
    assert tables.write_tables(tmp_path) == [tmp_path / "tables/import.parquet"]
    assert list((tmp_path / "tables").iterdir()) == [tmp_path / "tables/import.parquet"]


def test_row_groups_end_by_size_and_keep_every_row(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tables, "_GROUP_ROWS", 7)
    folder = write_results(tmp_path, [result("audit", i, audit(i, i)) for i in range(50)])
    (path,) = tables.write_tables(folder)
    assert pq.read_metadata(path).num_row_groups == 8
    assert [row["line"] for row in pq.read_table(path).to_pylist()] == list(range(50))


@pytest.mark.parametrize("bad", ["not json", '{"job":"audit"}', "[]", '{"job":"audit","options":1'])
def test_unusable_results_are_told_by_line_and_leave_no_table(tmp_path: Path, bad: str) -> None:
    write_results(tmp_path, [result("audit", 0, audit(1, 2))])
    with (tmp_path / "results.jsonl").open("a") as file:
        file.write(f"{bad}\n")
    with pytest.raises(UnusableResults, match=r"results.jsonl:2: no result of a job"):
        tables.write_tables(tmp_path)
    assert list((tmp_path / "tables").iterdir()) == []


def test_a_folder_without_results_is_told(tmp_path: Path) -> None:
    with pytest.raises(UnusableResults, match=r"results.jsonl: No such file"):
        tables.write_tables(tmp_path)
