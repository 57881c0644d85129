#pragma once

// Private to tools/python: what its files share. Arrays come in as anything that numpy makes an
// array of, and go out as arrays that look at memory of the object that they belong to, or own it.

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/tools/cli/place.h"

namespace roadbed::tools::inline python {

namespace nb = nanobind;

/// Rows of numbers, in C order: of an argument, whose memory it may be.
using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

/// An argument as rows of `least` to `most` numbers; one row may be given without its brackets.
/// @param what  names the argument in messages.
/// @throws std::invalid_argument if it has another shape.
Rows rows_of(nb::handle array_like, const std::string& what, std::size_t least, std::size_t most);
inline Rows rows_of(nb::handle array_like, const std::string& what, std::size_t columns) {
  return rows_of(array_like, what, columns, columns);
}

using Array1 = nb::ndarray<nb::numpy, const double, nb::ndim<1>>;
using Array2 = nb::ndarray<nb::numpy, const double, nb::ndim<2>>;
using Indices = nb::ndarray<nb::numpy, const std::int32_t, nb::ndim<1>>;

/// An array that owns its numbers.
/// @param shape  its product is the number of values.
template <typename T, std::size_t kDimensions>
nb::ndarray<nb::numpy, const T, nb::ndim<kDimensions>> owned(
    std::vector<T> values, const std::array<std::size_t, kDimensions>& shape) {
  auto* kept = new std::vector<T>(std::move(values));
  nb::capsule owner(kept, [](void* data) noexcept { delete static_cast<std::vector<T>*>(data); });
  return {kept->data(), kDimensions, shape.data(), owner};
}
template <typename T>
nb::ndarray<nb::numpy, const T, nb::ndim<1>> owned(std::vector<T> values) {
  const std::size_t size = values.size();
  return owned<T, 1>(std::move(values), {size});
}

/// Points as N×2; as a map has them they are moved to the source's coordinates.
Array2 points_array(std::span<const Eigen::Vector2d> points,
                    const Eigen::Vector2d& origin_in_source = {0, 0});

/// Each polygon's rings as N×2 arrays, the outer one first.
nb::list polygons_list(const std::vector<geometry::Polygon>& polygons,
                       const Eigen::Vector2d& origin_in_source = {0, 0});

/// A document as Python's dicts and lists.
nb::object object_of(const nlohmann::ordered_json& json);

using RoadMapPointer = std::shared_ptr<const map::RoadMap>;

/// All lanes of a map.
struct Lanes {
  RoadMapPointer road_map;
};

/// A map, what it was read from, and what was made of it for many questions.
struct Map {
  Map(RoadMapPointer made, std::filesystem::path from);
  ~Map();
  Map(const Map&) = delete;
  Map& operator=(const Map&) = delete;

  RoadMapPointer road_map;
  std::filesystem::path file;  ///< empty: of bytes
  struct Routers;
  std::unique_ptr<Routers> routers;
};

/// Of a text or anything with `__fspath__`.
std::filesystem::path path_of(nb::handle path);

/// A place on a map, told from outside.
struct AskedPlace {
  std::variant<std::string, PointPlace> told;

  /// @throws InputError as find_place() does.
  Place on(const map::RoadMap& road_map, map::Participant participant) const;
};

/// Text is as on the command line, a lane is its start, numbers are X, Y and the heading.
AskedPlace place_of(nb::handle place);

/// Many, of an array (N, 2) or (N, 3) or whatever gives one after the other.
std::vector<AskedPlace> places_of(nb::handle places);

void bind_errors(nb::module_& module);
void bind_maps(nb::module_& module);
void bind_lanes(nb::module_& module);
void bind_motion(nb::module_& module);
void bind_obstacles(nb::module_& module);
void bind_occupancy(nb::module_& module);
void bind_audits(nb::module_& module);
void bind_controllers(nb::module_& module);
void bind_drives(nb::module_& module);
void bind_plans(nb::module_& module);
void bind_reference_lines(nb::module_& module);
void bind_routes(nb::module_& module);

}  // namespace roadbed::tools::python
