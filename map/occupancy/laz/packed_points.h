#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/laz/chunk.h"
#include "roadbed/map/occupancy/laz/packed_item.h"

namespace roadbed::map::inline occupancy::inline laz {

/// The points of a chunk in formats 0 to 5: all that a point has is in one stream.
class PackedPoints : public Chunk {
 public:
  /// @param others  what a point has besides its position.
  /// @param bytes   from after the first point on, beyond the chunk.
  PackedPoints(std::unique_ptr<PackedPosition> position,
               std::vector<std::unique_ptr<PackedItem>> others, std::string_view bytes)
      : position_(std::move(position)), others_(std::move(others)), from_(bytes) {}

  LazPoint next() override {
    position_->next(from_);
    for (const auto& item : others_) item->next(from_);
    return position_->point();
  }

  std::array<LazPoint, 2> next_with(Chunk& chunk) override {
    auto& other = static_cast<PackedPoints&>(chunk);
    position_->next_with(from_, *other.position_, other.from_);
    for (std::size_t i = 0; i < others_.size(); ++i) {
      others_[i]->next_with(from_, *other.others_[i], other.from_);
    }
    return {position_->point(), other.position_->point()};
  }

  bool is_past_end() const override { return from_.is_past_end(); }

  std::size_t used() const override { return from_.used(); }

 private:
  std::unique_ptr<PackedPosition> position_;
  std::vector<std::unique_ptr<PackedItem>> others_;
  ArithmeticDecoder from_;
};

}  // namespace roadbed::map::occupancy::laz
