#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "roadbed/map/occupancy/laz/arithmetic_decoder.h"
#include "roadbed/map/occupancy/laz/chunk.h"
#include "roadbed/map/occupancy/laz/steps.h"

namespace roadbed::map::inline occupancy::inline laz {

/// Layers of a chunk; each but the first is empty where it never changes, or is not looked at.
struct PointLayers {
  std::string_view returns_and_xy, z, classification, intensity;
};

/// The points of a chunk in formats 6 to 10, whose parts are streams of their own. The others are
/// not looked at.
class LayeredPoints : public Chunk {
 public:
  /// @param first  the bytes of the chunk's first point, at least 30.
  /// @param bytes  of all layers and what says how long they are.
  LayeredPoints(std::string_view first, const PointLayers& layers, std::size_t bytes);
  ~LayeredPoints() override;

  LazPoint next() override;
  std::array<LazPoint, 2> next_with(Chunk& chunk) override;
  std::size_t used() const override { return bytes_; }

  bool is_past_end() const override {
    return xy_.is_past_end() || is_past_end(z_) || is_past_end(classification_) ||
           is_past_end(intensity_);
  }

  /// The first point, as it is.
  static LazPoint first_point(std::string_view first);

 private:
  struct Channel;
  using Layer = std::optional<ArithmeticDecoder>;

  static bool is_past_end(const Layer& layer) { return layer && layer->is_past_end(); }

  template <typename Part>
  void take_layer(Layer LayeredPoints::*layer);
  template <typename Part>
  void take_layer_with(LayeredPoints& other, Layer LayeredPoints::*layer);

  void changes(ArithmeticDecoder& from);
  void switch_channel(ArithmeticDecoder& from);
  void take_returns(ArithmeticDecoder& from, std::uint32_t changed);
  void x_interval(ArithmeticDecoder& from);
  void x(ArithmeticDecoder& from);
  void y_interval(ArithmeticDecoder& from);
  void y(ArithmeticDecoder& from);
  void z_interval(ArithmeticDecoder& from);
  void z(ArithmeticDecoder& from);
  void classification(ArithmeticDecoder& from);
  void intensity_interval(ArithmeticDecoder& from);
  void intensity(ArithmeticDecoder& from);

  using ReturnsAndXy = Steps<&LayeredPoints::changes, &LayeredPoints::x_interval, &LayeredPoints::x,
                             &LayeredPoints::y_interval, &LayeredPoints::y>;
  using Z = Steps<&LayeredPoints::z_interval, &LayeredPoints::z>;
  using Classification = Steps<&LayeredPoints::classification>;
  using Intensity = Steps<&LayeredPoints::intensity_interval, &LayeredPoints::intensity>;

  std::size_t bytes_;
  ArithmeticDecoder xy_;
  Layer z_, classification_, intensity_;
  std::array<std::unique_ptr<Channel>, 4> channels_;
  Channel* channel_;  // the one of the last point
};

}  // namespace roadbed::map::occupancy::laz
