#include "roadbed/map/edit/elevation/height_network.h"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline edit::inline elevation {
namespace {

/// Says before it factorises how many steps that takes.
class CountingSolver : public Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> {
 public:
  double steps() const {
    double sum = 0.0;
    const auto* begins = m_matrix.outerIndexPtr();
    for (Eigen::Index i = 0; i < m_matrix.outerSize(); ++i) {
      const double entries = begins[i + 1] - begins[i] + 1.0;
      sum += entries * entries;
    }
    return sum;
  }
};

// Roads that cross each other in the plane take some n^1.5; places that all are connected with each
// other would take n³.
void check_steps(double steps, std::size_t places) {
  constexpr double kFactor = 200.0;  // these are short steps
  if (steps <= kFactor * static_cast<double>(geometry::most_steps(places))) return;
  throw InputError({.file = "elevation",
                    .found = fmt::format("{} places without a measured height, which are connected "
                                         "in more ways than those of roads",
                                         places),
                    .needed = "a network of roads, or ground under more of it",
                    .remedy = "clip the map to where the ground was measured"});
}

}  // namespace

void HeightNetwork::connect(std::size_t a, std::size_t b, double length_m) {
  constexpr double kLeastM = 1e-3;  // places at one place are one
  if (a != b) connections_.push_back({a, b, std::max(length_m, kLeastM)});
}

// Whether a connection, or some of them, lead to a known place.
std::vector<bool> HeightNetwork::reached(const std::vector<std::optional<double>>& known) const {
  std::vector<std::size_t> parent(places_);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto group_of = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const Connection& one : connections_) parent[group_of(one.a)] = group_of(one.b);
  std::vector<bool> is_known(places_), is_reached(places_);
  for (std::size_t i = 0; i < places_; ++i) {
    if (known[i]) is_known[group_of(i)] = true;
  }
  for (std::size_t i = 0; i < places_; ++i) is_reached[i] = is_known[group_of(i)];
  return is_reached;
}

std::vector<std::optional<double>> HeightNetwork::filled(
    const std::vector<std::optional<double>>& known) const {
  constexpr Eigen::Index kNone = -1;
  const std::vector<bool> is_reached = reached(known);
  std::vector<Eigen::Index> unknown(places_, kNone);
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < places_; ++i) {
    if (!known[i] && is_reached[i]) unknown[i] = count++;
  }
  if (count == 0) return known;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  const auto pull = [&](std::size_t at, std::size_t towards, double weight) {
    if (unknown[at] == kNone) return;
    entries.emplace_back(unknown[at], unknown[at], weight);
    if (known[towards]) {
      right[unknown[at]] += weight * *known[towards];
    } else {
      entries.emplace_back(unknown[at], unknown[towards], -weight);
    }
  };
  for (const Connection& one : connections_) {
    pull(one.a, one.b, 1.0 / one.length_m);
    pull(one.b, one.a, 1.0 / one.length_m);
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  CountingSolver solver;
  solver.analyzePattern(matrix);
  check_steps(solver.steps(), static_cast<std::size_t>(count));
  solver.factorize(matrix);
  if (solver.info() != Eigen::Success) throw std::logic_error("HeightNetwork: not positive");
  const Eigen::VectorXd values = solver.solve(right);
  std::vector<std::optional<double>> all = known;
  for (std::size_t i = 0; i < places_; ++i) {
    if (unknown[i] != kNone) all[i] = values[unknown[i]];
  }
  return all;
}

}  // namespace roadbed::map::edit::elevation
