#include "roadbed/planning/audit/observed_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "roadbed/map/occupancy/ground/ground.h"

namespace roadbed::planning::inline audit {
namespace {

constexpr double kObservedStep_m = 0.02;
constexpr double kMostObservedSteps = 1e5;

struct HeightRange {
  double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;

  void add(double from_m, double to_m) {
    low_m = std::min(low_m, from_m);
    high_m = std::max(high_m, to_m);
  }
};

// Around the part on its way, and as far beside as it has to be looked at.
map::Box3 box_around(const geometry::Trajectory& drive, const Stretch& stretch,
                     const geometry::BodyPart& part) {
  Eigen::Vector2d least = drive.at(stretch.from_s).pose().position(), most = least;
  const auto take = [&](const geometry::TrajectoryPoint& state) {
    least = least.cwiseMin(state.pose().position());
    most = most.cwiseMax(state.pose().position());
  };
  take(drive.at(stretch.to_s));
  for (const geometry::TrajectoryPoint& sample : drive.points()) {
    if (sample.t_s > stretch.from_s && sample.t_s < stretch.to_s) take(sample);
  }
  constexpr double any_height_m = 1e6;
  const double margin_m = part.reach_m() + kObservedWithin_m;
  return {{least.x() - margin_m, least.y() - margin_m, -any_height_m},
          {most.x() + margin_m, most.y() + margin_m, any_height_m}};
}

bool overlap_in_plan(const map::Box3& a, const map::Box3& b) {
  return (a.min_in_source.head<2>().array() <= b.max_in_source.head<2>().array()).all() &&
         (b.min_in_source.head<2>().array() <= a.max_in_source.head<2>().array()).all();
}

// Over the ground as high as it is under the places of the stretch.
HeightRange heights_of(const map::HeightBand& band, const geometry::Trajectory& drive,
                       const Stretch& stretch) {
  HeightRange heights;
  for (const double t_s : {stretch.from_s, 0.5 * (stretch.from_s + stretch.to_s), stretch.to_s}) {
    const double ground_m =
        band.ground ? band.ground->height_m(drive.at(t_s).pose().position()) : 0.0;
    heights.add(ground_m + band.from_m, ground_m + band.to_m);
  }
  return heights;
}

}  // namespace

ObservedSearch::ObservedSearch(const map::ClearanceField& field, const ClearanceProbe& probe,
                               const geometry::BodyPart& part)
    : field_(field),
      probe_(probe),
      part_(part),
      step_m_(std::max(kObservedStep_m, probe.moved_m().back() / kMostObservedSteps)) {}

// A look that finds nothing costs little, one that finds something far away much: the next one goes
// a little less far beyond than the last thing found, or a little farther than nothing was.
void ObservedSearch::search(std::size_t to) {
  const double end_m = probe_.moved_m()[to];
  while (at_m_ < end_m) {
    const auto [segment, fraction] = probe_.place_moved(at_m_);
    const geometry::Rectangle core = part_.core_at(probe_.state_at(segment, fraction).pose());
    const double look_m = kObservedWithin_m + beyond_m_;
    const auto found = field_.nearest_measured(core, look_m + part_.radius_m);
    const double distance_m = found ? std::max(0.0, found->distance_m - part_.radius_m) : look_m;
    const double spare_m = kObservedWithin_m - distance_m;
    if (found && spare_m >= step_m_) {
      observe(at_m_ + spare_m, found->witness);
      continue;
    }
    pass_unobserved(at_m_ + std::max(-spare_m, step_m_));
    beyond_m_ = std::clamp((found ? 0.8 : 1.1) * -spare_m, kLeastBeyond_m, kMostBeyond_m);
  }
}

double ObservedSearch::time_moved_s(double moved_m) const {
  const auto [segment, fraction] = probe_.place_moved(moved_m);
  return probe_.time_at(segment, fraction);
}

void ObservedSearch::observe(double until_m, const map::Box2& column) {
  observed_.push_back({time_moved_s(at_m_), time_moved_s(until_m),
                       0.5 * (column.min_in_source + column.max_in_source)});
  at_m_ = until_m;
}

void ObservedSearch::pass_unobserved(double until_m) {
  const Stretch time{time_moved_s(at_m_), time_moved_s(until_m)};
  if (!unobserved_.empty() && unobserved_.back().to_s == time.from_s) {
    unobserved_.back().to_s = time.to_s;
  } else {
    unobserved_.push_back(time);
  }
  at_m_ = until_m;
}

std::string why_unobserved(const map::OccupancySource& occupancy,
                           const geometry::Trajectory& drive_in_source, const Stretch& stretch,
                           const geometry::BodyPart& part, const map::HeightBand& band) {
  const std::optional<map::Box3> measured = occupancy.bounds();
  if (!measured)
    return "nothing was measured at all; build the occupancy from clouds of this place";
  const map::Box3 near = box_around(drive_in_source, stretch, part);
  if (!overlap_in_plan(*measured, near)) {
    return fmt::format(
        "all that was measured lies at x {:.1f} to {:.1f}, y {:.1f} to {:.1f}, over {} m beside; "
        "bring drive and occupancy into one frame",
        measured->min_in_source.x(), measured->max_in_source.x(), measured->min_in_source.y(),
        measured->max_in_source.y(), kObservedWithin_m);
  }
  HeightRange there;
  for (const map::OccupancyCell& cell : occupancy.cells_in(near)) {
    const double z_m = cell.centre_in_source.z(), half_m = 0.5 * cell.size_m;
    if (cell.state != map::CellState::unknown) there.add(z_m - half_m, z_m + half_m);
  }
  const HeightRange asked = heights_of(band, drive_in_source, stretch);
  if (there.low_m > there.high_m || (there.low_m < asked.high_m && asked.low_m < there.high_m)) {
    return fmt::format(
        "no sensor saw the heights of z {:.2f} m to {:.2f} m there; measure that "
        "place, or cut the drive",
        asked.low_m, asked.high_m);
  }
  return fmt::format(
      "what was measured there lies at z {:.2f} m to {:.2f} m, and the {} takes z {:.2f} m to "
      "{:.2f} "
      "m; bring both into one frame, give --ground, or build with sensor positions, so that free "
      "space counts as measured",
      there.low_m, there.high_m, part.name, asked.low_m, asked.high_m);
}

}  // namespace roadbed::planning::audit
