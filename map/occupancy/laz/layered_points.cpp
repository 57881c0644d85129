#include "roadbed/map/occupancy/laz/layered_points.h"

#include <optional>

#include "roadbed/map/occupancy/laz/integer_decoder.h"
#include "roadbed/map/occupancy/laz/return_contexts.h"
#include "roadbed/map/occupancy/laz/running_median.h"

namespace roadbed::map::inline occupancy::inline laz {
namespace {

constexpr std::size_t kIntensityAt = 12, kReturnsAt = 14, kFlagsAt = 15,
                      kClassAt = 16;  // in a point of format 6

std::optional<ArithmeticDecoder> decoder_of(std::string_view layer) {
  if (layer.empty()) return std::nullopt;
  return ArithmeticDecoder(layer);
}

/// Of the last point of a channel.
struct LastReturn {
  PointSteps steps;
  std::uint32_t number, returns;
  std::uint16_t intensity;
  std::uint8_t classification;
  bool time_changed = false;

  std::size_t context() const {
    return (number == 1 ? 1u : 0u) + (number >= returns ? 2u : 0u) + (time_changed ? 4u : 0u);
  }
  // Of the first return of a pulse 2, of the last one 1, of the only one 3.
  std::uint32_t end_of_pulse() const {
    return (number == 1 ? 2u : 0u) + (number >= returns ? 1u : 0u);
  }
  LazPoint point() const {
    return {steps, intensity, classification, static_cast<std::uint8_t>(number),
            static_cast<std::uint8_t>(returns)};
  }
};

}  // namespace

/// What the points of one of a scanner's channels are decoded by.
struct LayeredPoints::Channel {
  Channel(std::size_t number_of_channel, const LastReturn& seed)
      : number(number_of_channel), last(seed) {
    last.time_changed = false;
    heights.fill(seed.steps[2]);
    intensities.fill(seed.intensity);
  }

  std::uint32_t single() const { return last.returns == 1 ? 1 : 0; }
  std::size_t map() const {
    return 2u * kReturnMap6[last.returns][last.number] + (last.time_changed ? 1u : 0u);
  }
  ROADBED_INLINE void step(ArithmeticDecoder& from, IntegerDecoder<32>& decoder,
                           RunningMedian& steps, std::size_t axis) {
    const std::int32_t step = decoder.take_sum(from, steps.get());
    steps.add(step);
    last.steps[axis] = moved(last.steps[axis], step);
  }

  std::size_t number;
  LastReturn last;
  std::array<SymbolModel<128>, 8> changed;
  SymbolModel<3> channel;
  SymbolModel<13> number_in_pulse;
  std::array<LateModel<16>, 16> returns, return_number;
  IntegerDecoder<32> dx{2}, dy{22}, z{20};
  std::array<RunningMedian, 12> x_steps, y_steps;
  std::array<std::int32_t, 8> heights, intensities;
  std::array<LateModel<256>, 64> classification;
  IntegerDecoder<16> intensity{4};
};

namespace {

LastReturn seed_of(std::string_view first) {
  const auto returns = static_cast<unsigned char>(first[kReturnsAt]);
  return {.steps = steps_at(first),
          .number = returns & 15u,
          .returns = returns >> 4 & 15u,
          .intensity = integer_at<std::uint16_t>(first, kIntensityAt),
          .classification = static_cast<std::uint8_t>(first[kClassAt])};
}

}  // namespace

LayeredPoints::LayeredPoints(std::string_view first, const PointLayers& layers, std::size_t bytes)
    : bytes_(bytes),
      xy_(layers.returns_and_xy),
      z_(decoder_of(layers.z)),
      classification_(decoder_of(layers.classification)),
      intensity_(decoder_of(layers.intensity)) {
  const std::size_t number = static_cast<unsigned char>(first[kFlagsAt]) >> 4 & 3u;
  channels_[number] = std::make_unique<Channel>(number, seed_of(first));
  channel_ = channels_[number].get();
}

LazPoint LayeredPoints::first_point(std::string_view first) { return seed_of(first).point(); }

LayeredPoints::~LayeredPoints() = default;

template <typename Part>
void LayeredPoints::take_layer(Layer LayeredPoints::*layer) {
  if (this->*layer) Part::take(*this, *(this->*layer));
}

template <typename Part>
void LayeredPoints::take_layer_with(LayeredPoints& other, Layer LayeredPoints::*layer) {
  if (this->*layer && other.*layer) {
    Part::take_in_turn(*this, *(this->*layer), other, *(other.*layer));
  } else {
    take_layer<Part>(layer);
    other.take_layer<Part>(layer);
  }
}

LazPoint LayeredPoints::next() {
  ReturnsAndXy::take(*this, xy_);
  take_layer<Z>(&LayeredPoints::z_);
  take_layer<Classification>(&LayeredPoints::classification_);
  take_layer<Intensity>(&LayeredPoints::intensity_);
  return channel_->last.point();
}

std::array<LazPoint, 2> LayeredPoints::next_with(Chunk& chunk) {
  auto& other = static_cast<LayeredPoints&>(chunk);
  ReturnsAndXy::take_in_turn(*this, xy_, other, other.xy_);
  take_layer_with<Z>(other, &LayeredPoints::z_);
  take_layer_with<Classification>(other, &LayeredPoints::classification_);
  take_layer_with<Intensity>(other, &LayeredPoints::intensity_);
  return {channel_->last.point(), other.channel_->last.point()};
}

ROADBED_INLINE void LayeredPoints::changes(ArithmeticDecoder& from) {
  const std::uint32_t changed = from.symbol(channel_->changed[channel_->last.context()]);
  if ((changed & 64) != 0) switch_channel(from);
  channel_->last.time_changed = (changed & 16) != 0;
  take_returns(from, changed);
}

ROADBED_INLINE void LayeredPoints::switch_channel(ArithmeticDecoder& from) {
  const std::size_t number =
      (channel_->number + from.symbol(channel_->channel) + 1) % channels_.size();
  std::unique_ptr<Channel>& channel = channels_[number];
  if (!channel) channel = std::make_unique<Channel>(number, channel_->last);
  channel_ = channel.get();
}

ROADBED_INLINE void LayeredPoints::take_returns(ArithmeticDecoder& from, std::uint32_t changed) {
  LastReturn& last = channel_->last;
  if ((changed & 4) != 0) {
    last.returns = from.symbol(channel_->returns[last.returns].get());
  }
  switch (changed & 3) {
    case 1:
      last.number = (last.number + 1) % 16;
      break;
    case 2:
      last.number = (last.number + 15) % 16;
      break;
    case 3:
      last.number = last.time_changed
                        ? from.symbol(channel_->return_number[last.number].get())
                        : (last.number + from.symbol(channel_->number_in_pulse) + 2) % 16;
      break;
    default:
      break;
  }
}

ROADBED_INLINE void LayeredPoints::x_interval(ArithmeticDecoder& from) {
  channel_->dx.take_interval(from, channel_->single());
}

ROADBED_INLINE void LayeredPoints::x(ArithmeticDecoder& from) {
  channel_->step(from, channel_->dx, channel_->x_steps[channel_->map()], 0);
}

ROADBED_INLINE void LayeredPoints::y_interval(ArithmeticDecoder& from) {
  channel_->dy.take_interval(from, channel_->single() + even_up_to(channel_->dx.k(), 20));
}

ROADBED_INLINE void LayeredPoints::y(ArithmeticDecoder& from) {
  channel_->step(from, channel_->dy, channel_->y_steps[channel_->map()], 1);
}

ROADBED_INLINE void LayeredPoints::z_interval(ArithmeticDecoder& from) {
  const std::uint32_t k = (channel_->dx.k() + channel_->dy.k()) / 2;
  channel_->z.take_interval(from, channel_->single() + even_up_to(k, 18));
}

ROADBED_INLINE void LayeredPoints::z(ArithmeticDecoder& from) {
  LastReturn& last = channel_->last;
  std::int32_t& height = channel_->heights[return_level(last.returns, last.number)];
  last.steps[2] = height = channel_->z.take_sum(from, height);
}

ROADBED_INLINE void LayeredPoints::classification(ArithmeticDecoder& from) {
  LastReturn& last = channel_->last;
  const std::size_t context =
      2u * (last.classification & 31u) + (last.end_of_pulse() == 3 ? 1u : 0u);
  last.classification =
      static_cast<std::uint8_t>(from.symbol(channel_->classification[context].get()));
}

ROADBED_INLINE void LayeredPoints::intensity_interval(ArithmeticDecoder& from) {
  channel_->intensity.take_interval(from, channel_->last.end_of_pulse());
}

ROADBED_INLINE void LayeredPoints::intensity(ArithmeticDecoder& from) {
  LastReturn& last = channel_->last;
  std::int32_t& intensity =
      channel_->intensities[2 * last.end_of_pulse() + (last.time_changed ? 1u : 0u)];
  intensity = channel_->intensity.take_sum(from, intensity);
  last.intensity = static_cast<std::uint16_t>(intensity);
}

}  // namespace roadbed::map::occupancy::laz
