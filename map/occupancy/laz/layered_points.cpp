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

SymbolModel& made(std::optional<SymbolModel>& model, std::uint32_t symbols) {
  if (!model) model.emplace(symbols);
  return *model;
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
  explicit Channel(const LastReturn& seed) : last(seed) {
    last.time_changed = false;
    heights.fill(seed.steps[2]);
    intensities.fill(seed.intensity);
  }

  LastReturn last;
  std::vector<SymbolModel> changed = std::vector<SymbolModel>(8, SymbolModel(128));
  SymbolModel channel{3}, number_in_pulse{13};
  std::array<std::optional<SymbolModel>, 16> returns, number;
  IntegerDecoder dx{32, 2}, dy{32, 22}, z{32, 20};
  std::array<RunningMedian, 12> x_steps, y_steps;
  std::array<std::int32_t, 8> heights, intensities;
  std::array<std::optional<SymbolModel>, 64> classification;
  IntegerDecoder intensity{16, 4};
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

LayeredPoints::LayeredPoints(std::string_view first, const PointLayers& layers)
    : xy_(layers.returns_and_xy),
      z_(decoder_of(layers.z)),
      classification_(decoder_of(layers.classification)),
      intensity_(decoder_of(layers.intensity)),
      channel_(static_cast<unsigned char>(first[kFlagsAt]) >> 4 & 3u) {
  channels_[channel_] = std::make_unique<Channel>(seed_of(first));
}

LazPoint LayeredPoints::first_point(std::string_view first) { return seed_of(first).point(); }

LayeredPoints::~LayeredPoints() = default;

LazPoint LayeredPoints::next() {
  const std::uint32_t changed =
      xy_.symbol(channels_[channel_]->changed[channels_[channel_]->last.context()]);
  if ((changed & 64) != 0) switch_channel();
  Channel& channel = *channels_[channel_];
  LastReturn& last = channel.last;
  last.time_changed = (changed & 16) != 0;
  take_returns(changed);
  const std::uint32_t single = last.returns == 1 ? 1 : 0;
  const std::size_t map =
      2u * kReturnMap6[last.returns][last.number] + (last.time_changed ? 1u : 0u);
  const std::int32_t dx = channel.dx.decode(xy_, channel.x_steps[map].get(), single);
  channel.x_steps[map].add(dx);
  const std::int32_t dy =
      channel.dy.decode(xy_, channel.y_steps[map].get(), single + even_up_to(channel.dx.k(), 20));
  channel.y_steps[map].add(dy);
  last.steps[0] = moved(last.steps[0], dx);
  last.steps[1] = moved(last.steps[1], dy);
  if (z_) {
    std::int32_t& height = channel.heights[return_level(last.returns, last.number)];
    const std::uint32_t k = (channel.dx.k() + channel.dy.k()) / 2;
    height = channel.z.decode(*z_, height, single + even_up_to(k, 18));
    last.steps[2] = height;
  }
  take_attributes(channel);
  return last.point();
}

void LayeredPoints::take_attributes(Channel& channel) {
  LastReturn& last = channel.last;
  const std::uint32_t end = last.end_of_pulse();
  if (classification_) {
    const std::size_t context = 2u * (last.classification & 31u) + (end == 3 ? 1u : 0u);
    last.classification = static_cast<std::uint8_t>(
        classification_->symbol(made(channel.classification[context], 256)));
  }
  if (intensity_) {
    std::int32_t& intensity = channel.intensities[2 * end + (last.time_changed ? 1u : 0u)];
    intensity = channel.intensity.decode(*intensity_, intensity, end);
    last.intensity = static_cast<std::uint16_t>(intensity);
  }
}

void LayeredPoints::switch_channel() {
  const Channel& before = *channels_[channel_];
  channel_ = (channel_ + xy_.symbol(channels_[channel_]->channel) + 1) % channels_.size();
  if (!channels_[channel_]) channels_[channel_] = std::make_unique<Channel>(before.last);
}

void LayeredPoints::take_returns(std::uint32_t changed) {
  Channel& channel = *channels_[channel_];
  LastReturn& last = channel.last;
  if ((changed & 4) != 0) {
    last.returns = xy_.symbol(made(channel.returns[last.returns], 16));
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
                        ? xy_.symbol(made(channel.number[last.number], 16))
                        : (last.number + xy_.symbol(channel.number_in_pulse) + 2) % 16;
      break;
    default:
      break;
  }
}

}  // namespace roadbed::map::occupancy::laz
