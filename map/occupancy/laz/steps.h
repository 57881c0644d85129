#pragma once

#include <memory>

#include "roadbed/map/occupancy/laz/arithmetic_decoder.h"

namespace roadbed::map::inline occupancy::inline laz {

/// Members of what decodes a part of a point, called one after the other, each with the decoder:
/// a symbol a step. Two chunks in turn take little more time than one, since a symbol waits for the
/// last one of its own stream only.
template <auto... kStep>
struct Steps {
  template <typename Item>
  ROADBED_INLINE static void take(Item& item, ArithmeticDecoder& from) {
    ArithmeticDecoder local = from;  // in registers
    ((item.*kStep)(local), ...);
    from = local;
  }

  template <typename Item>
  ROADBED_INLINE static void take_in_turn(Item& first, ArithmeticDecoder& from_first, Item& second,
                                          ArithmeticDecoder& from_second) {
    ArithmeticDecoder local_first = from_first, local_second = from_second;
    (((first.*kStep)(local_first), (second.*kStep)(local_second)), ...);
    from_first = local_first;
    from_second = local_second;
  }
};

/// A model that most files do not need.
template <std::uint32_t kMost>
class LateModel {
 public:
  ROADBED_INLINE SymbolModel<kMost>& get() {
    if (!model_) [[unlikely]]
      model_ = std::make_unique<SymbolModel<kMost>>();
    return *model_;
  }

 private:
  std::unique_ptr<SymbolModel<kMost>> model_;
};

}  // namespace roadbed::map::occupancy::laz
