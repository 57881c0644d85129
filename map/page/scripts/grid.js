// A grid of square cells over boxes, to find those that meet a box.

function cellSize(boxes, count, extent) {
  const area = Math.max(1, (extent[2] - extent[0]) * (extent[3] - extent[1]));
  return Math.max(20, Math.sqrt(area / Math.max(count, 1)), Math.sqrt(area) / 500);
}

function extentOf(boxes, count) {
  const extent = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i < count; ++i) {
    extent[0] = Math.min(extent[0], boxes[4 * i]);
    extent[1] = Math.min(extent[1], boxes[4 * i + 1]);
    extent[2] = Math.max(extent[2], boxes[4 * i + 2]);
    extent[3] = Math.max(extent[3], boxes[4 * i + 3]);
  }
  return extent[0] <= extent[2] ? extent : [0, 0, 0, 0];
}

/** Columns and rows that a box reaches into, within the grid. */
function cellsOf(grid, x0, y0, x1, y1) {
  const column = (x) => Math.min(grid.columns - 1, Math.max(0, Math.floor((x - grid.extent[0]) / grid.size)));
  const row = (y) => Math.min(grid.rows - 1, Math.max(0, Math.floor((y - grid.extent[1]) / grid.size)));
  return [column(x0), row(y0), column(x1), row(y1)];
}

/** @param boxes x0, y0, x1, y1 of each thing, one after the other */
function makeGrid(boxes, count) {
  const extent = extentOf(boxes, count), size = cellSize(boxes, count, extent);
  const columns = Math.floor((extent[2] - extent[0]) / size) + 1, rows = Math.floor((extent[3] - extent[1]) / size) + 1;
  const grid = {boxes, count, extent, size, columns, rows, seen: new Uint32Array(count), round: 0};
  const counts = new Uint32Array(columns * rows);
  const eachCell = (visit) => {
    for (let i = 0; i < count; ++i) {
      const [c0, r0, c1, r1] = cellsOf(grid, boxes[4 * i], boxes[4 * i + 1], boxes[4 * i + 2], boxes[4 * i + 3]);
      for (let r = r0; r <= r1; ++r) for (let c = c0; c <= c1; ++c) visit(r * columns + c, i);
    }
  };
  eachCell((cell) => ++counts[cell]);
  grid.starts = startsOf(counts);
  grid.items = new Uint32Array(grid.starts[columns * rows]);
  const next = grid.starts.slice();
  eachCell((cell, i) => (grid.items[next[cell]++] = i));
  return grid;
}

/** Those whose boxes meet this one, in their order. */
function inBox(grid, [x0, y0, x1, y1]) {
  const found = [], {boxes, seen} = grid, round = ++grid.round;
  if (grid.count === 0) return found;
  const [c0, r0, c1, r1] = cellsOf(grid, x0, y0, x1, y1);
  for (let r = r0; r <= r1; ++r) {
    for (let c = c0; c <= c1; ++c) {
      const cell = r * grid.columns + c;
      for (let k = grid.starts[cell]; k < grid.starts[cell + 1]; ++k) {
        const i = grid.items[k];
        if (seen[i] === round) continue;
        seen[i] = round;
        if (boxes[4 * i] <= x1 && boxes[4 * i + 2] >= x0 && boxes[4 * i + 1] <= y1 && boxes[4 * i + 3] >= y0) found.push(i);
      }
    }
  }
  return found.sort((a, b) => a - b);
}
