#pragma once

namespace roadbed::tools::inline report {

// What passengers bear, from nuPlan's comfort metrics (motional/nuplan-devkit,
// ego_is_comfortable.yaml).
inline constexpr double kLeastAcceleration_mps2 = -4.05;
inline constexpr double kMostAcceleration_mps2 = 2.40;
inline constexpr double kMostLateralAcceleration_mps2 = 4.89;
inline constexpr double kMostYawRate_radps = 0.95;

}  // namespace roadbed::tools
