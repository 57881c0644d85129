#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "roadbed/map/occupancy/laz/arithmetic_decoder.h"
#include "roadbed/map/occupancy/laz/point_steps.h"

namespace roadbed::map::inline occupancy::inline laz {

/// The coordinates of a chunk's points in formats 6 to 10, whose parts are streams of their own:
/// one with the returns, x and y, one with z. The others are not looked at.
class LayeredPoints {
 public:
  /// @param first     the bytes of the chunk's first point, at least 30.
  /// @param returns_and_xy, z  the layers; z is empty where it never changes.
  LayeredPoints(std::string_view first, std::string_view returns_and_xy, std::string_view z);
  ~LayeredPoints();

  /// The next point.
  PointSteps next();

  bool is_past_end() const { return xy_.is_past_end() || (has_z_ && z_.is_past_end()); }

 private:
  struct Channel;

  void switch_channel();
  void take_returns(std::uint32_t changed);

  ArithmeticDecoder xy_, z_;
  bool has_z_;
  std::array<std::unique_ptr<Channel>, 4> channels_;
  std::size_t channel_;
};

}  // namespace roadbed::map::occupancy::laz
