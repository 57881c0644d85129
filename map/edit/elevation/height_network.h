#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace roadbed::map::inline edit::inline elevation {

/// Values at places that lines connect, some of them known.
///
/// Those between are such that Σ (zᵢ − zⱼ)² / lengthᵢⱼ over all connections is least: linear along
/// a line, one value where lines meet, and constant beyond the last known one.
class HeightNetwork {
 public:
  explicit HeightNetwork(std::size_t places) : places_(places) {}

  void connect(std::size_t a, std::size_t b, double length_m);

  /// A value for each place; none where no line leads to a known one. O(N) where lines meet seldom.
  /// @throws InputError where so many are connected with each other that it would take O(N³).
  std::vector<std::optional<double>> filled(const std::vector<std::optional<double>>& known) const;

 private:
  struct Connection {
    std::size_t a, b;
    double length_m;
  };

  std::vector<bool> reached(const std::vector<std::optional<double>>& known) const;

  std::size_t places_;
  std::vector<Connection> connections_;
};

}  // namespace roadbed::map::edit::elevation
