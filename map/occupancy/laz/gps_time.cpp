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
class GpsTime final : public SteppedItem<GpsTime> {
 private:
  // What a time is: 0 to kMost or kMost to kMost + kLeast how many times the last step it is after
  // its sequence's last time, or less; the same; of a sequence that begins; or of another one.
  static constexpr std::uint32_t kMost = 500, kLeast = 10, kSame = kMost + kLeast + 1,
                                 kFull = kSame + 1, kFirst = kFull + 4;

  ROADBED_INLINE void kind(ArithmeticDecoder& from) {
    for (std::size_t switches = 0; switches < steps_.size(); ++switches) {
      kind_ = steps_[sequence_].last == 0 ? kind_after_none(from.symbol(after_none_))
                                          : from.symbol(multiple_);
      if (kind_ <= kFull || kind_ == kFirst) return;
      sequence_ = (sequence_ + kind_ - kFull) % steps_.size();
    }
    kind_ = kSame;  // none is that far away: tens of thousands of switches would fit into a byte
    from.break_off();
  }

  // Of 0 none, 1 some, 2 all of it, then another sequence.
  static std::uint32_t kind_after_none(std::uint32_t symbol) {
    return symbol == 0 ? kSame : symbol == 1 ? kFirst : kFull - 2 + symbol;
  }

  ROADBED_INLINE void interval(ArithmeticDecoder& from) {
    if (kind_ != kSame) step_.take_interval(from, context());
  }

  ROADBED_INLINE std::uint32_t context() const {
    if (kind_ == 1) return 1;
    if (kind_ == 0) return 7;
    if (kind_ < kMost) return kind_ < 10 ? 2 : 3;
    if (kind_ < kSame) return kind_ == kMost ? 4 : kind_ < kMost + kLeast ? 5 : 6;
    return kind_ == kFirst ? 0 : 8;
  }

  ROADBED_INLINE void sum(ArithmeticDecoder& from) {
    if (kind_ == kSame) return;
    TimeStep& step = steps_[sequence_];
    const std::uint32_t factor = kind_ <= kMost ? kind_ : kMost - kind_;
    const std::int32_t taken = step_.take_sum(from, times(factor, step.last));
    if (kind_ == kFirst) {
      step.restart(taken);
    } else if (kind_ >= kFull) {
      from.raw_bits(32);  // the lower half
      sequence_ = newest_ = (newest_ + 1) % steps_.size();
      steps_[sequence_].restart(0);
    } else if (kind_ == 1) {
      step.extremes = 0;
    } else if (kind_ == 0 || kind_ == kMost || kind_ == kMost + kLeast) {
      step.take_extreme(taken);
    }
  }

  SymbolModel<6> after_none_;
  SymbolModel<kFull + 4> multiple_;
  IntegerDecoder<32> step_{9};
  std::array<TimeStep, 4> steps_;
  std::size_t sequence_ = 0, newest_ = 0;
  std::uint32_t kind_ = kSame;

 public:
  using Point = Steps<&GpsTime::kind, &GpsTime::interval, &GpsTime::sum>;
};

class GpsTimeVersion1 final : public SteppedItem<GpsTimeVersion1> {
 public:
  void all(ArithmeticDecoder& from) {
    if (step_.last != 0) {
      take_multiple(from, from.symbol(multiple_));
      return;
    }
    const std::uint32_t symbol = from.symbol(after_none_);
    if (symbol == 1) step_.last = steps_.decode(from, 0, 0);
    if (symbol == 2) from.raw_64();
  }
  using Point = Steps<&GpsTimeVersion1::all>;

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

  SymbolModel<3> after_none_;
  SymbolModel<kSymbols> multiple_;
  IntegerDecoder<32> steps_{6};
  TimeStep step_;
};

}  // namespace

std::unique_ptr<PackedItem> make_gps_time(unsigned version) {
  if (version == 1) return std::make_unique<GpsTimeVersion1>();
  return std::make_unique<GpsTime>();
}

}  // namespace roadbed::map::occupancy::laz
