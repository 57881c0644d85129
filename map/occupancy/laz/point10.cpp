#include <algorithm>

#include "roadbed/map/occupancy/laz/integer_decoder.h"
#include "roadbed/map/occupancy/laz/packed_item.h"
#include "roadbed/map/occupancy/laz/return_contexts.h"
#include "roadbed/map/occupancy/laz/running_median.h"

namespace roadbed::map::inline occupancy::inline laz {
namespace {

/// What of the last point the next one is decoded by.
struct LastPoint {
  explicit LastPoint(std::string_view bytes)
      : steps(steps_at(bytes)),
        flags(static_cast<std::uint8_t>(bytes[14])),
        type(static_cast<std::uint8_t>(bytes[15])),
        intensity(integer_at<std::uint16_t>(bytes, 12)),
        user_data(static_cast<std::uint8_t>(bytes[17])) {}

  std::uint32_t return_number() const { return flags & 7u; }
  std::uint32_t returns() const { return flags >> 3 & 7u; }
  std::uint32_t scan_direction() const { return flags >> 6 & 1u; }

  LazPoint point() const {
    return {steps, intensity, static_cast<std::uint8_t>(type & 31u),
            static_cast<std::uint8_t>(return_number()), static_cast<std::uint8_t>(returns())};
  }

  PointSteps steps;
  std::uint8_t flags, type;
  std::uint16_t intensity;
  std::uint8_t user_data;
};

/// A byte, decoded by a model for its last value.
class LastByte {
 public:
  ROADBED_INLINE void take(ArithmeticDecoder& from, std::uint8_t& value) {
    value = static_cast<std::uint8_t>(from.symbol(models_[value].get()));
  }

 private:
  std::array<LateModel<256>, 256> models_;
};

class Point10 final : public SteppedItem<Point10, PackedPosition> {
 public:
  explicit Point10(std::string_view first) : last_(first) { last_.intensity = 0; }

  LazPoint point() const override { return last_.point(); }

 private:
  ROADBED_INLINE void changes(ArithmeticDecoder& from) { changed_ = from.symbol(changes_); }
  ROADBED_INLINE void flags(ArithmeticDecoder& from) {
    if ((changed_ & 32) != 0) flags_.take(from, last_.flags);
  }
  ROADBED_INLINE void intensity_interval(ArithmeticDecoder& from) {
    if ((changed_ & 16) != 0) intensity_.take_interval(from, std::min(map(), 3u));
  }
  ROADBED_INLINE void intensity(ArithmeticDecoder& from) {
    std::int32_t& last = last_intensity_[map()];
    if ((changed_ & 16) != 0) last = intensity_.take_sum(from, last);
    if (changed_ != 0) last_.intensity = static_cast<std::uint16_t>(last);
  }
  ROADBED_INLINE void type(ArithmeticDecoder& from) {
    if ((changed_ & 8) != 0) type_.take(from, last_.type);
  }
  ROADBED_INLINE void scan_angle(ArithmeticDecoder& from) {
    if ((changed_ & 4) != 0) from.symbol(scan_angle_[last_.scan_direction()]);
  }
  ROADBED_INLINE void user_data(ArithmeticDecoder& from) {
    if ((changed_ & 2) != 0) user_data_.take(from, last_.user_data);
  }
  ROADBED_INLINE void source(ArithmeticDecoder& from) {
    if ((changed_ & 1) != 0) source_.decode(from, 0);
  }
  ROADBED_INLINE void x_interval(ArithmeticDecoder& from) { dx_.take_interval(from, single()); }
  ROADBED_INLINE void x(ArithmeticDecoder& from) { step(from, dx_, x_steps_[map()], 0); }
  ROADBED_INLINE void y_interval(ArithmeticDecoder& from) {
    dy_.take_interval(from, single() + even_up_to(dx_.k(), 20));
  }
  ROADBED_INLINE void y(ArithmeticDecoder& from) { step(from, dy_, y_steps_[map()], 1); }
  ROADBED_INLINE void z_interval(ArithmeticDecoder& from) {
    z_.take_interval(from, single() + even_up_to((dx_.k() + dy_.k()) / 2, 18));
  }
  ROADBED_INLINE void z(ArithmeticDecoder& from) {
    std::int32_t& height = heights_[return_level(last_.returns(), last_.return_number())];
    last_.steps[2] = height = z_.take_sum(from, height);
  }

  ROADBED_INLINE void step(ArithmeticDecoder& from, IntegerDecoder<32>& decoder,
                           RunningMedian& steps, std::size_t axis) {
    const std::int32_t step = decoder.take_sum(from, steps.get());
    steps.add(step);
    last_.steps[axis] = moved(last_.steps[axis], step);
  }
  std::uint32_t map() const { return kReturnMap[last_.returns()][last_.return_number()]; }
  std::uint32_t single() const { return last_.returns() == 1 ? 1 : 0; }

  LastPoint last_;
  std::uint32_t changed_ = 0;
  SymbolModel<64> changes_;
  LastByte flags_, type_, user_data_;
  std::array<SymbolModel<256>, 2> scan_angle_;
  IntegerDecoder<16> intensity_{4}, source_;
  IntegerDecoder<32> dx_{2}, dy_{22}, z_{20};
  std::array<std::int32_t, 16> last_intensity_{};
  std::array<RunningMedian, 16> x_steps_, y_steps_;
  std::array<std::int32_t, 8> heights_{};

 public:
  using Point = Steps<&Point10::changes, &Point10::flags, &Point10::intensity_interval,
                      &Point10::intensity, &Point10::type, &Point10::scan_angle,
                      &Point10::user_data, &Point10::source, &Point10::x_interval, &Point10::x,
                      &Point10::y_interval, &Point10::y, &Point10::z_interval, &Point10::z>;
};

/// The last three steps in turn, and their median.
class LastThree {
 public:
  std::int32_t median() const {
    const auto [a, b, c] = values_;
    return std::max(std::min(a, b), std::min(std::max(a, b), c));
  }
  void add(std::int32_t value) {
    values_[at_] = value;
    at_ = (at_ + 1) % 3;
  }

 private:
  std::array<std::int32_t, 3> values_{};
  std::size_t at_ = 0;
};

class Point10Version1 final : public SteppedItem<Point10Version1, PackedPosition> {
 public:
  explicit Point10Version1(std::string_view first) : last_(first) {}

  LazPoint point() const override { return last_.point(); }

  void all(ArithmeticDecoder& from) {
    constexpr std::uint32_t most = 19;
    const std::int32_t dx = dx_.decode(from, x_steps_.median());
    const std::int32_t dy = dy_.decode(from, y_steps_.median(), std::min(dx_.k(), most));
    const std::uint32_t k = (dx_.k() + dy_.k()) / 2;
    const std::int32_t z = z_.decode(from, last_.steps[2], std::min(k, most));
    last_.steps = {moved(last_.steps[0], dx), moved(last_.steps[1], dy), z};
    x_steps_.add(dx);
    y_steps_.add(dy);
    take_changed(from, from.symbol(changed_), k);
  }
  using Point = Steps<&Point10Version1::all>;

 private:
  void take_changed(ArithmeticDecoder& from, std::uint32_t changed, std::uint32_t k) {
    if ((changed & 32) != 0) {
      last_.intensity = static_cast<std::uint16_t>(intensity_.decode(from, last_.intensity));
    }
    if ((changed & 16) != 0) flags_.take(from, last_.flags);
    if ((changed & 8) != 0) type_.take(from, last_.type);
    if ((changed & 4) != 0) scan_angle_.decode(from, 0, k < 3 ? 1 : 0);
    if ((changed & 2) != 0) user_data_.take(from, last_.user_data);
    if ((changed & 1) != 0) source_.decode(from, 0);
  }

  LastPoint last_;
  LastThree x_steps_, y_steps_;
  SymbolModel<64> changed_;
  LastByte flags_, type_, user_data_;
  IntegerDecoder<32> dx_, dy_{20}, z_{20};
  IntegerDecoder<16> intensity_, source_;
  IntegerDecoder<8> scan_angle_{2};
};

}  // namespace

LazPoint first_of_point10(std::string_view first) { return LastPoint(first).point(); }

std::unique_ptr<PackedPosition> make_point10(std::string_view first, unsigned version) {
  if (version == 1) return std::make_unique<Point10Version1>(first);
  return std::make_unique<Point10>(first);
}

}  // namespace roadbed::map::occupancy::laz
