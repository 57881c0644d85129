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

class Point10 : public PackedItem {
 public:
  explicit Point10(std::string_view first) : last_(first) { last_.intensity = 0; }

  void next(ArithmeticDecoder& from, LazPoint& point) override {
    if (const std::uint32_t changed = from.symbol(changed_)) take_changed(from, changed);
    take_coordinates(from);
    point = last_.point();
  }

 private:
  std::uint32_t map() const { return kReturnMap[last_.returns()][last_.return_number()]; }

  void take_changed(ArithmeticDecoder& from, std::uint32_t changed) {
    if ((changed & 32) != 0) {
      last_.flags = static_cast<std::uint8_t>(from.symbol(flags_[last_.flags]));
    }
    if ((changed & 16) != 0) {
      std::int32_t& last = last_intensity_[map()];
      last = intensity_.decode(from, last, std::min(map(), 3u));
    }
    last_.intensity = static_cast<std::uint16_t>(last_intensity_[map()]);
    if ((changed & 8) != 0) {
      last_.type = static_cast<std::uint8_t>(from.symbol(type_[last_.type]));
    }
    if ((changed & 4) != 0) from.symbol(scan_angle_[last_.scan_direction()]);
    if ((changed & 2) != 0) {
      last_.user_data = static_cast<std::uint8_t>(from.symbol(user_data_[last_.user_data]));
    }
    if ((changed & 1) != 0) source_.decode(from, 0);
  }

  void take_coordinates(ArithmeticDecoder& from) {
    const std::uint32_t single = last_.returns() == 1 ? 1 : 0;
    RunningMedian& x_step = x_steps_[map()];
    const std::int32_t dx = dx_.decode(from, x_step.get(), single);
    x_step.add(dx);
    RunningMedian& y_step = y_steps_[map()];
    const std::int32_t dy = dy_.decode(from, y_step.get(), single + even_up_to(dx_.k(), 20));
    y_step.add(dy);
    std::int32_t& height = heights_[return_level(last_.returns(), last_.return_number())];
    height = z_.decode(from, height, single + even_up_to((dx_.k() + dy_.k()) / 2, 18));
    last_.steps = {moved(last_.steps[0], dx), moved(last_.steps[1], dy), height};
  }

  LastPoint last_;
  SymbolModel changed_{64};
  ByteModels flags_, type_, user_data_;
  std::array<SymbolModel, 2> scan_angle_{SymbolModel(256), SymbolModel(256)};
  IntegerDecoder intensity_{16, 4}, source_{16}, dx_{32, 2}, dy_{32, 22}, z_{32, 20};
  std::array<std::int32_t, 16> last_intensity_{};
  std::array<RunningMedian, 16> x_steps_, y_steps_;
  std::array<std::int32_t, 8> heights_{};
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

class Point10Version1 : public PackedItem {
 public:
  explicit Point10Version1(std::string_view first) : last_(first) {}

  void next(ArithmeticDecoder& from, LazPoint& point) override {
    constexpr std::uint32_t most = 19;
    const std::int32_t dx = dx_.decode(from, x_steps_.median());
    const std::int32_t dy = dy_.decode(from, y_steps_.median(), std::min(dx_.k(), most));
    const std::uint32_t k = (dx_.k() + dy_.k()) / 2;
    const std::int32_t z = z_.decode(from, last_.steps[2], std::min(k, most));
    last_.steps = {moved(last_.steps[0], dx), moved(last_.steps[1], dy), z};
    x_steps_.add(dx);
    y_steps_.add(dy);
    take_changed(from, from.symbol(changed_), k);
    point = last_.point();
  }

 private:
  void take_changed(ArithmeticDecoder& from, std::uint32_t changed, std::uint32_t k) {
    if ((changed & 32) != 0) {
      last_.intensity = static_cast<std::uint16_t>(intensity_.decode(from, last_.intensity));
    }
    if ((changed & 16) != 0) {
      last_.flags = static_cast<std::uint8_t>(from.symbol(flags_[last_.flags]));
    }
    if ((changed & 8) != 0) {
      last_.type = static_cast<std::uint8_t>(from.symbol(type_[last_.type]));
    }
    if ((changed & 4) != 0) scan_angle_.decode(from, 0, k < 3 ? 1 : 0);
    if ((changed & 2) != 0) {
      last_.user_data = static_cast<std::uint8_t>(from.symbol(user_data_[last_.user_data]));
    }
    if ((changed & 1) != 0) source_.decode(from, 0);
  }

  LastPoint last_;
  LastThree x_steps_, y_steps_;
  SymbolModel changed_{64};
  ByteModels flags_, type_, user_data_;
  IntegerDecoder dx_{32}, dy_{32, 20}, z_{32, 20}, intensity_{16}, scan_angle_{8, 2}, source_{16};
};

}  // namespace

LazPoint first_of_point10(std::string_view first) { return LastPoint(first).point(); }

std::unique_ptr<PackedItem> make_point10(std::string_view first, unsigned version) {
  if (version == 1) return std::make_unique<Point10Version1>(first);
  return std::make_unique<Point10>(first);
}

}  // namespace roadbed::map::occupancy::laz
