#include "roadbed/map/sumo/lane_users.h"

#include <array>
#include <utility>

#include "roadbed/map/derived/crossings.h"

namespace roadbed::map::sumo {
namespace {

// What "Vehicle_Type_Parameter_Defaults" of SUMO's documentation calls abstract vehicle classes.
constexpr std::array<std::pair<Participant, const char*>, 10> kClasses = {{
    {Participant::car, "private passenger hov vip evehicle delivery"},
    {Participant::emergency, "emergency authority army"},
    {Participant::taxi, "taxi"},
    {Participant::bus, "bus coach"},
    {Participant::truck, "truck trailer"},
    {Participant::motorcycle, "motorcycle moped"},
    {Participant::bicycle, "bicycle scooter"},
    {Participant::pedestrian, "pedestrian wheelchair"},
    {Participant::tram, "tram"},
    {Participant::train, "rail_urban rail rail_electric rail_fast"},
}};

constexpr double kTown_mps = 50.0 / 3.6, kRamp_mps = 60.0 / 3.6;

Participants without_vehicles(Participants users) {
  return Participants::from_bits(
      static_cast<std::uint16_t>(users.bits() & ~Participants::vehicles().bits()));
}

}  // namespace

Participants users_of(const Lane& lane) {
  if (is_crosswalk(lane)) return {};
  if (is_drivable(lane.type)) return lane.participants;
  switch (lane.type) {
    case LaneType::bus:
    case LaneType::taxi:
      return lane.participants;
    case LaneType::biking:
    case LaneType::sidewalk:
    case LaneType::tram:
    case LaneType::rail:
      return without_vehicles(lane.participants);
    default:
      return {};
  }
}

std::string vehicle_classes(Participants users) {
  std::string classes;
  for (const auto& [kind, words] : kClasses) {
    if (!users.has(kind)) continue;
    if (!classes.empty()) classes += ' ';
    classes += words;
  }
  return classes;
}

double speed_mps(const Lane& lane) {
  const double limit_mps = lane.least_speed_limit_mps().value_or(0.0);
  if (limit_mps > 0.0) return limit_mps;
  switch (lane.type) {
    case LaneType::entry:
    case LaneType::exit:
    case LaneType::on_ramp:
    case LaneType::off_ramp:
    case LaneType::connecting_ramp:
      return kRamp_mps;
    default:
      return kTown_mps;
  }
}

}  // namespace roadbed::map::sumo
