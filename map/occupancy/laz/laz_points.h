#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/laz/point_steps.h"

namespace roadbed::map::inline occupancy::inline laz {

/// How the points of a LAZ file are packed: its record "laszip encoded", 22204.
struct LazLayout {
  enum class Packing : std::uint16_t { one_stream = 1, chunks = 2, layers = 3 };
  enum class Kind : std::uint16_t {
    extra_bytes = 0,
    point10 = 6,
    gps_time = 7,
    rgb = 8,
    wave_packet = 9,
    point14 = 10,  ///< what follows belongs to layers that are not looked at
    rgb14 = 11,
    rgb_infrared14 = 12,
    wave_packet14 = 13,
    extra_bytes14 = 14,
  };
  struct Item {
    Kind kind;
    std::uint16_t bytes, version;
  };
  Packing packing = Packing::one_stream;
  std::uint32_t chunk_points = 0;  ///< in every chunk but the last; of layers each chunk says it
  std::vector<Item> items;         ///< of a point, in order

  std::size_t point_bytes() const;
};

/// @param name  of the file, for messages.
/// @throws InputError if it is cut, or names what LASzip 3.4 has not.
LazLayout parse_laz_layout(std::string_view record, const std::string& name);

/// Unpacks all points, in order, some thousands at a time.
/// @param has_attributes  whether more than coordinates and returns is looked at, which is not free
///                        where points are packed in layers.
/// @param file   its bytes, to the end.
/// @param begin  where its points begin.
/// @throws InputError if the file ends before the last point, or holds what cannot be.
void unpack_laz(std::string_view file, std::size_t begin, std::uint64_t points,
                const LazLayout& layout, bool has_attributes, const std::string& name,
                const std::function<void(std::span<const LazPoint>)>& take);

}  // namespace roadbed::map::occupancy::laz
