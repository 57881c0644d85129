#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "roadbed/map/files/json_text.h"
#include "roadbed/tools/python/bindings.h"

namespace roadbed::tools::inline python {

Rows rows_of(nb::handle array_like, const std::string& what, std::size_t least, std::size_t most) {
  nb::module_ numpy = nb::module_::import_("numpy");
  nb::object array = numpy.attr("ascontiguousarray")(array_like, "float64");
  if (nb::cast<int>(array.attr("ndim")) == 1) {
    const auto size = nb::cast<std::size_t>(array.attr("size"));
    // Nothing is no row of any width.
    array = array.attr("reshape")(size == 0 ? 0 : 1, size == 0 ? least : size);
  }
  const std::string columns =
      least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
  const auto refuse = [&](const std::string& found) {
    throw std::invalid_argument(
        fmt::format("{}: {}, needs numbers of shape (N, {})", what, found, columns));
  };
  const auto dimensions = nb::cast<int>(array.attr("ndim"));
  if (dimensions != 2) refuse(fmt::format("has {} dimensions", dimensions));
  const auto rows = nb::cast<Rows>(array);
  if (rows.shape(1) < least || rows.shape(1) > most) {
    refuse(fmt::format("shape ({}, {})", rows.shape(0), rows.shape(1)));
  }
  return rows;
}

Array2 points_array(std::span<const Eigen::Vector2d> points,
                    const Eigen::Vector2d& origin_in_source) {
  std::vector<double> values;
  values.reserve(2 * points.size());
  for (const Eigen::Vector2d& point : points) {
    values.push_back(point.x() + origin_in_source.x());
    values.push_back(point.y() + origin_in_source.y());
  }
  return owned<double, 2>(std::move(values), {points.size(), 2});
}

nb::list polygons_list(const std::vector<geometry::Polygon>& polygons,
                       const Eigen::Vector2d& origin_in_source) {
  nb::list list;
  for (const geometry::Polygon& polygon : polygons) {
    nb::list rings;
    rings.append(points_array(polygon.outer, origin_in_source));
    for (const geometry::Ring& hole : polygon.holes) {
      rings.append(points_array(hole, origin_in_source));
    }
    list.append(rings);
  }
  return list;
}

nb::object object_of(const nlohmann::ordered_json& json) {
  return nb::module_::import_("json").attr("loads")(map::json_text(json));
}

}  // namespace roadbed::tools::python
