#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "roadbed/map/occupancy/laz/arithmetic_decoder.h"
#include "roadbed/map/occupancy/laz/point_steps.h"

namespace roadbed::map::inline occupancy::inline laz {

/// Layers of a chunk; each but the first is empty where it never changes, or is not looked at.
struct PointLayers {
  std::string_view returns_and_xy, z, classification, intensity;
};

/// The points of a chunk in formats 6 to 10, whose parts are streams of their own. The others are
/// not looked at.
class LayeredPoints {
 public:
  /// @param first  the bytes of the chunk's first point, at least 30.
  LayeredPoints(std::string_view first, const PointLayers& layers);
  ~LayeredPoints();

  /// The next point.
  LazPoint next();

  bool is_past_end() const {
    return xy_.is_past_end() || is_past_end(z_) || is_past_end(classification_) ||
           is_past_end(intensity_);
  }

  /// The first point, as it is.
  static LazPoint first_point(std::string_view first);

 private:
  struct Channel;
  using Layer = std::optional<ArithmeticDecoder>;

  static bool is_past_end(const Layer& layer) { return layer && layer->is_past_end(); }

  void switch_channel();
  void take_returns(std::uint32_t changed);
  void take_attributes(Channel& channel);

  ArithmeticDecoder xy_;
  Layer z_, classification_, intensity_;
  std::array<std::unique_ptr<Channel>, 4> channels_;
  std::size_t channel_;
};

}  // namespace roadbed::map::occupancy::laz
