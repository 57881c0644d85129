"""A Parquet table per kind of job, GeoParquet 1.1.0 where the kind has geometry.

The bytes depend on `results.jsonl`, the files it names and the version of pyarrow alone: rows in
the order of the jobs, the same columns always, row groups cut by counting. Memory is bounded by a
row group per kind.
"""

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
from pyproj import CRS
from pyproj.exceptions import CRSError

from roadbed_cluster.columns import COLUMNS, COMMON, cast
from roadbed_cluster.errors import UnusableResults
from roadbed_cluster.geometry import GEOMETRIES

#: A row group ends with the row that reaches one of these.
_GROUP_ROWS = 10_000
_GROUP_BYTES = 8_000_000


def write_tables(output: Path) -> list[Path]:
    """Write `output/tables/KIND.parquet` from `output/results.jsonl`; return the paths, sorted.

    Tables of kinds that are not among the results are removed.

    Raises:
        UnusableResults: if the results cannot be read, or the tables cannot be written.
    """
    folder = output / "tables"
    tables: dict[str, _Table] = {}
    try:
        _read_into(tables, output, folder)
        written = [table.finish() for table in tables.values()]
        for kind in sorted(COLUMNS.keys() - tables.keys()):
            _path(folder, kind).unlink(missing_ok=True)
    except OSError as error:
        raise UnusableResults(f"{error.filename or folder}: {error.strerror or error}") from error
    finally:
        for table in tables.values():
            table.abandon()
    return sorted(written)


def _path(folder: Path, kind: str) -> Path:
    return folder / f"{kind}.parquet"


def _read_into(tables: "dict[str, _Table]", output: Path, folder: Path) -> None:
    path = output / "results.jsonl"
    with path.open(encoding="utf-8") as lines:
        folder.mkdir(exist_ok=True)
        for number, line in enumerate(lines, 1):
            try:
                result = json.loads(line)
                kind = result["job"]
                if kind not in COLUMNS:
                    continue  # a line that was no job
                if kind not in tables:
                    tables[kind] = _Table(kind, folder)
                tables[kind].add(result, output, len(line))
            except (ValueError, KeyError, TypeError, AttributeError) as error:
                raise UnusableResults(f"{path}:{number}: no result of a job: {error}") from error


@dataclass
class _Bounds:
    """Bounds of all geometry, and what it is made of, for the metadata."""

    box: list[float] | None = None
    types: set[str] = field(default_factory=set)
    systems: set[str | None] = field(default_factory=set)

    def add(self, type_: str, crs: str | None, box: tuple[float, float, float, float]) -> None:
        self.types.add(type_)
        self.systems.add(crs)
        old = self.box or list(box)
        self.box = [min(old[0], box[0]), min(old[1], box[1]),
                    max(old[2], box[2]), max(old[3], box[3])]  # fmt: skip

    def metadata(self) -> str:
        """Return the text of the key `geo`; the CRS is unknown (null) unless all rows share one."""
        column: dict[str, Any] = {"encoding": "WKB", "geometry_types": sorted(self.types)}
        column["crs"] = _projjson(next(iter(self.systems))) if len(self.systems) == 1 else None
        if self.box is not None:
            column["bbox"] = self.box
        geo = {"version": "1.1.0", "primary_column": "geometry", "columns": {"geometry": column}}
        return json.dumps(geo, sort_keys=True)


def _projjson(crs: str | None) -> dict[str, Any] | None:
    try:
        return CRS.from_user_input(crs).to_json_dict() if crs else None
    except CRSError:
        return None


class _Table:
    """One kind's table, written beside its place and moved there when it is whole."""

    def __init__(self, kind: str, folder: Path) -> None:
        self._columns = COLUMNS[kind]
        self._geometry = GEOMETRIES.get(kind)
        fields = [*COMMON, *((column.name, column.type) for column in self._columns)]
        fields.append(("result", pa.string()))
        if self._geometry is not None:
            fields += [("geometry_crs", pa.string()), ("geometry", pa.binary())]
        self._schema = pa.schema(fields)
        self._path = _path(folder, kind)
        self._unfinished = folder / f".{kind}.parquet.part"
        self._writer: pq.ParquetWriter | None = pq.ParquetWriter(
            self._unfinished, self._schema, compression="zstd", version="2.6"
        )
        self._rows: list[dict[str, Any]] = []
        self._bytes = 0
        self._bounds = _Bounds()

    def add(self, result: dict[str, Any], output: Path, size: int) -> None:
        """Add the row of a result that took `size` bytes as JSON."""
        row = {name: cast(result.get(name), type_) for name, type_ in COMMON}
        row["options"] = _text(result["options"])
        document = result["result"] if isinstance(result["result"], dict) else {}
        for column in self._columns:
            row[column.name] = cast(column.find(document), column.type)
        row["result"] = _text(result["result"]) if document else None
        if self._geometry is not None:
            shape = self._geometry(result, output) if document else None
            row["geometry"] = None
            row["geometry_crs"] = None
            if shape is not None:
                row["geometry"] = shape.wkb()
                row["geometry_crs"] = shape.crs
                self._bounds.add(shape.type, shape.crs, shape.bounds())
                size += len(row["geometry"])
        self._rows.append(row)
        self._bytes += size
        if len(self._rows) >= _GROUP_ROWS or self._bytes >= _GROUP_BYTES:
            self._end_group()

    def finish(self) -> Path:
        """Write what is left, and move the table to its place."""
        assert self._writer is not None
        self._end_group()
        if self._geometry is not None:
            self._writer.add_key_value_metadata({"geo": self._bounds.metadata()})
        self._writer.close()
        self._writer = None
        self._unfinished.rename(self._path)
        return self._path

    def abandon(self) -> None:
        """Remove a table that is not finished."""
        if self._writer is not None:
            self._writer.close()
            self._writer = None
            self._unfinished.unlink(missing_ok=True)

    def _end_group(self) -> None:
        assert self._writer is not None
        if self._rows:
            batch = pa.RecordBatch.from_pylist(self._rows, schema=self._schema)
            self._writer.write_batch(batch, row_group_size=len(self._rows))
        self._rows = []
        self._bytes = 0


def _text(value: Any) -> str:  # noqa: ANN401
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"))
