#include "roadbed/map/occupancy/outputs/cell_boxes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline occupancy::inline outputs {
namespace {

constexpr std::size_t kMostRows = 100'000'000;

// A leaf as rows of cells along x.
void append_rows(const CellBox& leaf, std::vector<CellBox>& rows) {
  for (std::int64_t z = leaf.from[2]; z < leaf.to[2]; ++z) {
    for (std::int64_t y = leaf.from[1]; y < leaf.to[1]; ++y) {
      rows.push_back({{leaf.from[0], y, z}, {leaf.to[0], y + 1, z + 1}});
    }
  }
}

std::size_t count_rows(const CellBox& leaf) {
  return static_cast<std::size_t>((leaf.to[1] - leaf.from[1]) * (leaf.to[2] - leaf.from[2]));
}

// Boxes that are alike across an axis stand together, along it.
auto order_along(std::size_t axis) {
  return [axis](const CellBox& box) {
    const std::size_t a = axis == 2 ? 1 : 2, b = axis == 0 ? 1 : 0;
    return std::array{box.from[a], box.to[a], box.from[b], box.to[b], box.from[axis]};
  };
}

bool continues(const CellBox& box, const CellBox& next, std::size_t axis) {
  for (std::size_t other = 0; other < 3; ++other) {
    if (other == axis) continue;
    if (box.from[other] != next.from[other] || box.to[other] != next.to[other]) return false;
  }
  return box.to[axis] == next.from[axis];
}

void join_along(std::size_t axis, std::vector<CellBox>& boxes) {
  std::ranges::sort(boxes, {}, order_along(axis));
  std::size_t kept = 0;
  for (std::size_t i = 1; i < boxes.size(); ++i) {
    if (continues(boxes[kept], boxes[i], axis)) {
      boxes[kept].to[axis] = boxes[i].to[axis];
    } else {
      boxes[++kept] = boxes[i];
    }
  }
  if (!boxes.empty()) boxes.resize(kept + 1);
}

}  // namespace

std::vector<CellBox> occupied_boxes(const OccupancySource& occupancy, const GridHeights& heights,
                                    const std::string& name) {
  std::vector<CellBox> boxes;
  std::size_t count = 0;
  for_each_part(occupancy, heights, [&](const CellBox& cells, CellState state) {
    if (state != CellState::occupied) return;
    count += count_rows(cells);
    if (count > kMostRows) {
      throw InputError({.file = name,
                        .found = fmt::format("more than {} rows of occupied cells", kMostRows),
                        .needed = "fewer",
                        .remedy = "take a part with roadbed occupancy crop"});
    }
    append_rows(cells, boxes);
  });
  for (std::size_t axis = 0; axis < 3; ++axis) join_along(axis, boxes);
  std::ranges::sort(boxes, {}, [](const CellBox& box) {
    return std::array{box.from[2], box.from[1], box.from[0]};
  });
  return boxes;
}

Layer layer_of_boxes(const OccupancySource& occupancy, const std::vector<CellBox>& boxes) {
  const CellGrid grid(occupancy);
  Layer layer{.name = "occupied",
              .kind = "occupied",
              .shape = ShapeKind::polygon,
              .columns = {{"from_z_m", ColumnKind::number}, {"to_z_m", ColumnKind::number}},
              .features = {}};
  for (const CellBox& box : boxes) {
    const auto [a, b] = grid.box_in_source(box);
    const Points ring{
        {a.x(), a.y(), 0.0}, {b.x(), a.y(), 0.0}, {b.x(), b.y(), 0.0}, {a.x(), b.y(), 0.0}};
    layer.features.push_back({{{ring}}, {a.z(), b.z()}});
  }
  return layer;
}

}  // namespace roadbed::map::occupancy::outputs
