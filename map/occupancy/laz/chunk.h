#pragma once

#include <array>
#include <cstddef>

#include "roadbed/map/occupancy/laz/point_steps.h"

namespace roadbed::map::inline occupancy::inline laz {

/// Points that are packed without regard to those of other chunks, all but the first one.
class Chunk {
 public:
  virtual ~Chunk() = default;

  virtual LazPoint next() = 0;

  /// The next point of this and of another chunk of the same file, in less time than one after the
  /// other.
  virtual std::array<LazPoint, 2> next_with(Chunk& other) = 0;

  /// Whether points were taken that its bytes do not hold; they are anything.
  virtual bool is_past_end() const = 0;

  /// Bytes after the first point, of the points taken so far or of all.
  virtual std::size_t used() const = 0;
};

}  // namespace roadbed::map::occupancy::laz
