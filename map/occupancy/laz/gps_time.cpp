#include "roadbed/map/occupancy/laz/integer_decoder.h"
#include "roadbed/map/occupancy/laz/packed_item.h"

namespace roadbed::map::inline occupancy::inline laz {
namespace {

std::int32_t times(std::uint32_t factor, std::int32_t value) {
  return static_cast<std::int32_t>(factor * static_cast<std::uint32_t>(value));
}

/// The step from one time to the next of a sequence. Times themselves are not kept: what follows is
/// decoded by the steps alone.
struct TimeStep {
  std::int32_t last = 0;
  int extremes = 0;

  void restart(std::int32_t step) { *this = {.last = step}; }

  /// A step that fits its neighbours badly becomes the last one only at the fourth time.
  void take_extreme(std::int32_t step) {
    if (++extremes > 3) restart(step);
  }
};

/// Four sequences of times, which points may switch between.
class GpsTime : public PackedItem {
 public:
  void next(ArithmeticDecoder& from, LazPoint&) override {
    while (switches_sequence(from) && !from.is_past_end()) continue;
  }

 private:
  static constexpr std::uint32_t kMost = 500, kLeast = 10, kSame = kMost + kLeast + 1,
                                 kFull = kSame + 1;

  /// Takes a step; or is told that the time goes on with another sequence.
  bool switches_sequence(ArithmeticDecoder& from) {
    TimeStep& step = steps_[sequence_];
    const std::uint32_t symbol = from.symbol(step.last == 0 ? after_none_ : multiple_);
    // After no step: 0 none, 1 some, 2 all of it, then another sequence; else kSame, kFull,
    // another.
    const std::uint32_t full = step.last == 0 ? 2 : kFull;
    if (symbol > full) {
      sequence_ = (sequence_ + symbol - full) % steps_.size();
      return true;
    }
    if (symbol == full) {
      take_full(from);
    } else if (step.last != 0) {
      take_multiple(from, symbol, step);
    } else if (symbol == 1) {
      step.restart(step_.decode(from, 0, 0));
    }
    return false;
  }

  void take_full(ArithmeticDecoder& from) {
    step_.decode(from, 0, 8);  // the upper half
    from.raw_bits(32);
    sequence_ = newest_ = (newest_ + 1) % steps_.size();
    steps_[sequence_].restart(0);
  }

  void take_multiple(ArithmeticDecoder& from, std::uint32_t symbol, TimeStep& step) {
    if (symbol == 1) {
      step_.decode(from, step.last, 1);
      step.extremes = 0;
    } else if (symbol == 0) {
      step.take_extreme(step_.decode(from, 0, 7));
    } else if (symbol < kMost) {
      step_.decode(from, times(symbol, step.last), symbol < 10 ? 2 : 3);
    } else if (symbol == kMost) {
      step.take_extreme(step_.decode(from, times(kMost, step.last), 4));
    } else if (symbol < kMost + kLeast) {
      step_.decode(from, times(kMost - symbol, step.last), 5);
    } else if (symbol == kMost + kLeast) {
      step.take_extreme(step_.decode(from, times(0u - kLeast, step.last), 6));
    }
  }

  SymbolModel after_none_{6}, multiple_{kFull + 4};
  IntegerDecoder step_{32, 9};
  std::array<TimeStep, 4> steps_;
  std::size_t sequence_ = 0, newest_ = 0;
};

class GpsTimeVersion1 : public PackedItem {
 public:
  void next(ArithmeticDecoder& from, LazPoint&) override {
    if (step_.last != 0) {
      take_multiple(from, from.symbol(multiple_));
      return;
    }
    const std::uint32_t symbol = from.symbol(after_none_);
    if (symbol == 1) step_.last = steps_.decode(from, 0, 0);
    if (symbol == 2) from.raw_64();
  }

 private:
  static constexpr std::uint32_t kSymbols = 512;

  void take_multiple(ArithmeticDecoder& from, std::uint32_t symbol) {
    if (symbol == kSymbols - 2) from.raw_64();
    if (symbol >= kSymbols - 2) return;
    if (symbol == 1) {
      step_.restart(steps_.decode(from, step_.last, 1));
    } else if (symbol == 0) {
      step_.take_extreme(steps_.decode(from, step_.last / 4, 2));
    } else {
      const std::uint32_t context = symbol < 10 ? 3 : symbol < 50 ? 4 : 5;
      const std::int32_t step = steps_.decode(from, times(symbol, step_.last), context);
      if (symbol == kSymbols - 3) step_.take_extreme(step);
    }
  }

  SymbolModel after_none_{3}, multiple_{kSymbols};
  IntegerDecoder steps_{32, 6};
  TimeStep step_;
};

}  // namespace

std::unique_ptr<PackedItem> make_gps_time(unsigned version) {
  if (version == 1) return std::make_unique<GpsTimeVersion1>();
  return std::make_unique<GpsTime>();
}

}  // namespace roadbed::map::occupancy::laz
