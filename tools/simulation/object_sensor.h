#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/tracking/tracker.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline simulation {

/// An object that is measured, and which one it truly is.
struct SeenObject {
  std::size_t obstacle = 0;       ///< index in the world
  planning::Detection detection;  ///< without an id
};

/// What a vehicle measures of those that it sees (planning/obstacles/visibility.h): extents
/// exactly, places, headings and speeds with white Gaussian noise, by seed.
class ObjectSensor {
 public:
  /// Refers to the world.
  ObjectSensor(const World& world, const ScenarioNoise& noise, std::uint64_t seed);

  /// By the order of the world's obstacles. O(n²) of those within the range; to be asked once per
  /// time.
  /// @param body  the vehicle's, as it truly is.
  std::vector<SeenObject> look(double t_s, const geometry::Rectangle& body);

 private:
  bool is_blind(double t_s) const;
  planning::Detection measured(const planning::Obstacle& obstacle, double t_s);
  double noise(double deviation) { return deviation * normal_(random_); }

  const World& world_;
  ScenarioNoise noise_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace roadbed::tools::simulation
