#include "roadbed/planning/lateral/feasibility_check.h"

#include <algorithm>
#include <span>

namespace roadbed::planning::inline lateral {
namespace {

constexpr std::size_t kRememberedEdges = 3, kRememberedContacts = 4;

std::size_t blocks_per_batch(const Grid& grid) {
  return (grid.offset_count() + kSimdWidth - 1) / kSimdWidth;
}

}  // namespace

FeasibilityCheck::FeasibilityCheck(CandidateEvaluator& evaluator)
    : evaluator_(evaluator),
      completion_(evaluator.context(), evaluator.scene(), evaluator.vehicle(),
                  {.horizon_s = evaluator.options().completion_horizon_s,
                   .deceleration_mps2 = evaluator.options().completion_deceleration_mps2,
                   .clearance_m = evaluator.margins().clearance_m,
                   .recovery_m = evaluator.options().recovery_m,
                   .circles = evaluator.options().circles}) {}

Rejection FeasibilityCheck::at(std::size_t index) {
  const CandidateDrive drive = evaluator_.drive(index);
  if (const auto edge_m = edge_place_m(drive)) {
    remember(*edge_m, std::nullopt);
    return Rejection::off_road;
  }
  const Grid& grid = evaluator_.grid();
  if (const auto contact = evaluator_.collision().first_contact(drive.points)) {
    remember(drive, *contact);
    return Rejection::collision;
  }
  const bool leads_on = completion_.exists(grid.end_d_m(index), grid.end_l_m(index));
  return leads_on ? Rejection::none : Rejection::collision;
}

void FeasibilityCheck::remember(const CandidateDrive& drive, const Contact& contact) {
  remember(contact_place_m(drive, contact), contact);
}

bool FeasibilityCheck::is_known_to_collide(std::size_t index) {
  return std::ranges::any_of(places_,
                             [&](Place& place) { return place.contact && is_among(place, index); });
}

bool FeasibilityCheck::collides(std::size_t index, const std::vector<std::size_t>& things) {
  if (is_known_to_collide(index)) return true;
  const CandidateDrive drive = evaluator_.drive(index);
  const auto contact = evaluator_.collision().first_contact(drive.points, things);
  if (contact) remember(drive, *contact);
  return contact.has_value();
}

bool FeasibilityCheck::is_among(Place& place, std::size_t index) {
  const Grid& grid = evaluator_.grid();
  const std::size_t batch = index / grid.offset_count(), offset = index % grid.offset_count();
  const std::size_t block = offset / kSimdWidth, first_offset = block * kSimdWidth;
  auto& who = place.who[batch * blocks_per_batch(grid) + block];
  if (!who) who = who_fails(place, batch, first_offset);
  return (*who >> (offset - first_offset) & 1) != 0;
}

Rejection FeasibilityCheck::known(std::size_t index) {
  const Grid& grid = evaluator_.grid();
  for (Place& place : places_) {
    if (is_among(place, index)) return place.contact ? Rejection::collision : Rejection::off_road;
  }
  return completion_.is_known_to_fail(grid.end_d_m(index), grid.end_l_m(index))
             ? Rejection::collision
             : Rejection::none;
}

void FeasibilityCheck::remember(double l_m, const std::optional<Contact>& contact) {
  const Grid& grid = evaluator_.grid();
  const std::size_t most = contact ? kRememberedContacts : kRememberedEdges;
  const auto is_alike = [&](const Place& place) {
    return place.contact.has_value() == contact.has_value();
  };
  if (std::ranges::count_if(places_, is_alike) == static_cast<std::ptrdiff_t>(most)) {
    const auto last = std::find_if(places_.rbegin(), places_.rend(), is_alike);
    places_.erase(std::next(last).base());
  }
  Place place{.l_m = l_m, .contact = contact, .who = {}};
  place.who.resize(grid.length_count() * blocks_per_batch(grid));
  places_.insert(places_.begin(), std::move(place));
}

// Where the body is farthest outside the corridor; none if it keeps inside.
std::optional<double> FeasibilityCheck::edge_place_m(const CandidateDrive& drive) const {
  std::optional<double> place_m;
  double most_m = kLimitSlack;
  for (std::size_t i = 0; i < drive.points.size(); ++i) {
    const double excess_m = evaluator_.excess_m(drive, i);
    if (!(excess_m > most_m)) continue;
    most_m = excess_m;
    place_m = drive.stations[i].l_m;
  }
  return place_m;
}

// From the contact on, as long as the body comes nearer yet.
double FeasibilityCheck::contact_place_m(const CandidateDrive& drive,
                                         const Contact& contact) const {
  const auto distance_m = [&](const geometry::TrajectoryPoint& at) {
    const geometry::Rectangle body = geometry::body_at(at.pose(), evaluator_.vehicle());
    return evaluator_.collision().distance_m(contact, body, at.t_s);
  };
  const std::size_t a = contact.segment, b = a + 1;
  double place_m = std::lerp(drive.stations[a].l_m, drive.stations[b].l_m, contact.fraction);
  double least_m = distance_m(interpolate(drive.points[a], drive.points[b], contact.fraction));
  for (std::size_t i = b; i < drive.points.size(); ++i) {
    const double next_m = distance_m(drive.points[i]);
    if (next_m >= least_m) break;
    least_m = next_m;
    place_m = drive.stations[i].l_m;
  }
  return place_m;
}

std::uint8_t FeasibilityCheck::who_fails(const Place& place, std::size_t batch,
                                         std::size_t first_offset) {
  const std::vector<double>& end_d_m = evaluator_.grid().end_d_m();
  const std::size_t count = std::min(kSimdWidth, end_d_m.size() - first_offset);
  const std::vector<CandidateBody> bodies = evaluator_.bodies(
      batch, std::span(end_d_m).subspan(first_offset, count), place.l_m,
      {.with_lengths = place.contact.has_value(),
       .parts = place.contact ? evaluator_.collision().parts(*place.contact) : 1});
  unsigned who = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].is_there && fails(place, bodies[i])) who |= 1U << i;
  }
  return static_cast<std::uint8_t>(who);
}

bool FeasibilityCheck::fails(const Place& place, const CandidateBody& at) const {
  if (!place.contact) return evaluator_.excess_m(at) > kLimitSlack;
  return evaluator_.collision().surely_hits(*place.contact, at.body, at.t_s, at.driven_m);
}

}  // namespace roadbed::planning::lateral
