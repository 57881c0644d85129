#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/laz/arithmetic_decoder.h"
#include "roadbed/map/occupancy/laz/point_steps.h"

namespace roadbed::map::inline occupancy::inline laz {

/// What the points of formats 0 to 5 are made of, decoded one after the other from one stream: who
/// wants the coordinates has to decode all the rest. A chunk begins with a point as it is.
class PackedItem {
 public:
  virtual ~PackedItem() = default;

  /// Takes the next point's part; `point` is written by who has it.
  virtual void next(ArithmeticDecoder& from, LazPoint& point) = 0;
};

/// A model for each value of a byte, made when needed.
class ByteModels {
 public:
  explicit ByteModels(std::uint32_t symbols = 256) : symbols_(symbols), models_(256) {}
  SymbolModel& operator[](std::uint8_t value) {
    if (!models_[value]) models_[value].emplace(symbols_);
    return *models_[value];
  }

 private:
  std::uint32_t symbols_;
  std::vector<std::optional<SymbolModel>> models_;
};

/// Coordinates, intensity, returns, class, scan angle, user data, source (20 bytes).
/// @param first    the bytes of the chunk's first point, also in what follows.
/// @param version  1 or 2, also in what follows.
std::unique_ptr<PackedItem> make_point10(std::string_view first, unsigned version);

/// The first point of a chunk, as it is.
LazPoint first_of_point10(std::string_view first);

/// GPS time (8 bytes).
std::unique_ptr<PackedItem> make_gps_time(unsigned version);

/// Red, green, blue (6 bytes).
std::unique_ptr<PackedItem> make_rgb(unsigned version);

/// Reference to a wave form (29 bytes); there is one version only.
std::unique_ptr<PackedItem> make_wave_packet();

/// Bytes of somebody's own.
std::unique_ptr<PackedItem> make_extra_bytes(std::size_t count, unsigned version);

}  // namespace roadbed::map::occupancy::laz
