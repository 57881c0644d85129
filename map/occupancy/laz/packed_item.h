#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>

#include "roadbed/map/occupancy/laz/point_steps.h"
#include "roadbed/map/occupancy/laz/steps.h"

namespace roadbed::map::inline occupancy::inline laz {

/// What the points of formats 0 to 5 are made of, decoded one after the other from one stream: who
/// wants the coordinates has to decode all the rest. A chunk begins with a point as it is.
class PackedItem {
 public:
  virtual ~PackedItem() = default;

  /// Takes the next point's part.
  virtual void next(ArithmeticDecoder& from) = 0;

  /// The same of two chunks. @pre both items were made for the same.
  virtual void next_with(ArithmeticDecoder& from, PackedItem& other,
                         ArithmeticDecoder& from_other) = 0;
};

/// An item whose steps for a point are `Item::Point`.
template <typename Item, typename Base = PackedItem>
class SteppedItem : public Base {
 public:
  void next(ArithmeticDecoder& from) override {
    Item::Point::take(static_cast<Item&>(*this), from);
  }

  void next_with(ArithmeticDecoder& from, PackedItem& other,
                 ArithmeticDecoder& from_other) override {
    Item::Point::take_in_turn(static_cast<Item&>(*this), from, static_cast<Item&>(other),
                              from_other);
  }
};

/// The item that says where a point is.
class PackedPosition : public PackedItem {
 public:
  virtual LazPoint point() const = 0;  ///< the last one taken
};

/// Coordinates, intensity, returns, class, scan angle, user data, source (20 bytes).
/// @param first    the bytes of the chunk's first point.
/// @param version  1 or 2, also in what follows.
std::unique_ptr<PackedPosition> make_point10(std::string_view first, unsigned version);

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
