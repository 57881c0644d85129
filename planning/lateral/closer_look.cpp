#include "roadbed/planning/lateral/closer_look.h"

#include <algorithm>
#include <span>

namespace roadbed::planning::inline lateral {
namespace {

constexpr std::size_t kRememberedEdges = 3, kRememberedContacts = 4;

std::size_t blocks_per_row(const Grid& grid) {
  return (grid.lanes() + kLanesPerBlock - 1) / kLanesPerBlock;
}

}  // namespace

CloserLook::CloserLook(Cycle& cycle)
    : cycle_(cycle),
      way_on_(cycle.course(), cycle.scene(), cycle.vehicle(),
              {.horizon_s = cycle.options().way_on_horizon_s,
               .deceleration_mps2 = cycle.options().way_on_deceleration_mps2,
               .clearance_m = cycle.room().clearance_m,
               .recovery_m = cycle.options().recovery_m,
               .circles = cycle.options().circles}) {}

Rejection CloserLook::at(std::size_t index) {
  const CandidateDrive drive = cycle_.drive(index);
  if (const auto edge_m = edge_place_m(drive)) {
    remember(*edge_m, std::nullopt);
    return Rejection::off_road;
  }
  const Grid& grid = cycle_.grid();
  if (const auto contact = cycle_.collision().first_contact(drive.points)) {
    remember(contact_place_m(drive, *contact), contact);
    return Rejection::collision;
  }
  const bool leads_on = way_on_.exists(grid.end_d_m(index), grid.end_l_m(index));
  return leads_on ? Rejection::none : Rejection::collision;
}

Rejection CloserLook::known(std::size_t index) {
  const Grid& grid = cycle_.grid();
  const std::size_t row = index / grid.lanes(), lane = index % grid.lanes();
  const std::size_t block = lane / kLanesPerBlock, first_lane = block * kLanesPerBlock;
  for (Place& place : places_) {
    auto& who = place.who[row * blocks_per_row(grid) + block];
    if (!who) who = who_fails(place, row, first_lane);
    if ((*who >> (lane - first_lane) & 1) == 0) continue;
    return place.contact ? Rejection::collision : Rejection::off_road;
  }
  return way_on_.is_known_to_end(grid.end_d_m(index), grid.end_l_m(index)) ? Rejection::collision
                                                                           : Rejection::none;
}

void CloserLook::remember(double l_m, const std::optional<Contact>& contact) {
  const Grid& grid = cycle_.grid();
  const std::size_t most = contact ? kRememberedContacts : kRememberedEdges;
  const auto is_alike = [&](const Place& place) {
    return place.contact.has_value() == contact.has_value();
  };
  if (std::ranges::count_if(places_, is_alike) == static_cast<std::ptrdiff_t>(most)) {
    const auto last = std::find_if(places_.rbegin(), places_.rend(), is_alike);
    places_.erase(std::next(last).base());
  }
  Place place{.l_m = l_m, .contact = contact, .who = {}};
  place.who.resize(grid.rows() * blocks_per_row(grid));
  places_.insert(places_.begin(), std::move(place));
}

// Where the body is farthest outside the corridor; none if it keeps inside.
std::optional<double> CloserLook::edge_place_m(const CandidateDrive& drive) const {
  std::optional<double> place_m;
  double most_m = kLimitSlack;
  for (std::size_t i = 0; i < drive.points.size(); ++i) {
    const double excess_m = cycle_.excess_m(drive, i);
    if (!(excess_m > most_m)) continue;
    most_m = excess_m;
    place_m = drive.stations[i].l_m;
  }
  return place_m;
}

// Where the body comes nearest to what it comes too near to.
double CloserLook::contact_place_m(const CandidateDrive& drive, const Contact& contact) const {
  const auto distance_m = [&](std::size_t i) {
    const geometry::Rectangle body = geometry::body_at(drive.points[i].pose(), cycle_.vehicle());
    return cycle_.collision().distance_m(contact, body, drive.points[i].t_s);
  };
  std::size_t nearest = contact.leg;
  for (std::size_t i = contact.leg + 1; i < drive.points.size(); ++i) {
    if (distance_m(i) < distance_m(nearest)) nearest = i;
  }
  return drive.stations[nearest].l_m;
}

std::uint8_t CloserLook::who_fails(const Place& place, std::size_t row, std::size_t first_lane) {
  const std::vector<double>& end_d_m = cycle_.grid().end_d_m();
  const std::size_t count = std::min(kLanesPerBlock, end_d_m.size() - first_lane);
  const std::vector<CandidateBody> bodies = cycle_.bodies(
      row, std::span(end_d_m).subspan(first_lane, count), place.l_m, place.contact.has_value());
  unsigned who = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].is_there && fails(place, bodies[i])) who |= 1U << i;
  }
  return static_cast<std::uint8_t>(who);
}

bool CloserLook::fails(const Place& place, const CandidateBody& at) const {
  if (!place.contact) return cycle_.excess_m(at) > kLimitSlack;
  return cycle_.collision().surely_hits(*place.contact, at.body, at.t_s, at.driven_m);
}

}  // namespace roadbed::planning::lateral
