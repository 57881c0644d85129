#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::map::inline logs {

/// A box that somebody has drawn around an object at one time.
struct AnnotatedBox {
  std::int64_t stamp_ns;
  std::string track, category;  ///< the same track at all times; "REGULAR_VEHICLE", …
  Eigen::Vector3d size_m;       ///< length, width, height
  Eigen::Isometry3d pose;       ///< of its middle in the frame of the ego's rear axle, x forward
};

/// The boxes of annotations.feather of Argoverse 2, in the order of the file.
/// @throws InputError if it is damaged, has other columns, a quaternion is no rotation to 1 %, or a
///         size is not positive.
std::vector<AnnotatedBox> read_annotations(std::string_view bytes, const std::string& name);

}  // namespace roadbed::map::logs
