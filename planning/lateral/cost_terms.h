#pragma once

#include <array>
#include <span>
#include <string_view>

namespace roadbed::planning::inline lateral {

/// The twelve terms of the paper's Table 1, in its order: one candidate at a time, as the equations
/// say. The search ranks all candidates by the same numbers, many at once (CandidateBatch,
/// batch_cost_kernel.h); tests hold the two together.
enum class CostTerm {
  length,
  curvature,
  curvature_rate,
  curvature_second,
  curvature_third,
  offset,
  lateral_acceleration,
  longitudinal_acceleration,
  lateral_jerk,
  longitudinal_jerk,
  consistency,
  time,
};
inline constexpr int kCostTerms = 12;
std::string_view to_string(CostTerm term);

/// One number per term, in the order of CostTerm; `of(terms, CostTerm::time)` reads better.
using CostTerms = std::array<double, kCostTerms>;
inline double& of(CostTerms& terms, CostTerm term) { return terms[static_cast<std::size_t>(term)]; }
inline double of(const CostTerms& terms, CostTerm term) {
  return terms[static_cast<std::size_t>(term)];
}

/// A candidate at one of its points, equally spaced in the reference line's station.
struct CostPoint {
  double d_m = 0.0;
  double previous_d_m = 0.0;  ///< of the previous plan there; d_m itself if there is none
  double stretch = 1.0;       ///< dσ/ds, arc length of the candidate per station
  double curvature_per_m = 0.0;
  double curvature_d1_per_m2 = 0.0;  ///< with respect to the candidate's own arc length
  double curvature_d2_per_m3 = 0.0;
  double curvature_d3_per_m4 = 0.0;
  double speed_mps = 0.0;  ///< of the speed plan at this station, and its derivatives in time
  double acceleration_mps2 = 0.0;
  double jerk_mps3 = 0.0;
};

/// What brings each squared quantity to order one: terms are in units of these squared. Those of
/// the curvature are the peaks of a quintic lane change by 3.5 m over 20 m.
namespace cost_scale {
inline constexpr double kCurvature_per_m = 0.05;
inline constexpr double kCurvatureD1_per_m2 = 0.026;
inline constexpr double kCurvatureD2_per_m3 = 0.008;
inline constexpr double kCurvatureD3_per_m4 = 0.0008;
inline constexpr double kOffset_m = 1.0;
inline constexpr double kAcceleration_mps2 = 2.0;
inline constexpr double kJerk_mps3 = 2.0;
inline constexpr double kConsistency_m = 0.5;
}  // namespace cost_scale

/// Slower than this the time term does not count: a stop would drown every other term.
inline constexpr double kSlowestCounted_mps = 1.0;

/// What a candidate is measured against.
struct CostFrame {
  double end_l_m = 0.0;          ///< its length along the reference line
  double max_l_m = 0.0;          ///< of the longest candidate
  double start_speed_mps = 0.0;  ///< now
};

// Every term is without unit, at least 0 and independent of the number of points: `mean` is the
// trapezoidal mean over the points, so a weight keeps its meaning when their number or the
// candidate's length changes. @pre points.size() ≥ 2

/// (1 − l_e / L_max)²: longer candidates are preferred, as they react less to noise.
double length_term(const CostFrame& frame);
/// mean k² / (0.05 1/m)²
double curvature_term(std::span<const CostPoint> points);
/// mean (dk/dσ)² / (0.026 1/m²)²
double curvature_rate_term(std::span<const CostPoint> points);
/// mean (d²k/dσ²)² / (0.008 1/m³)²
double curvature_second_term(std::span<const CostPoint> points);
/// mean (d³k/dσ³)² / (0.0008 1/m⁴)²
double curvature_third_term(std::span<const CostPoint> points);
/// mean d² / (1 m)²
double offset_term(std::span<const CostPoint> points);
/// mean (v² k)² / (2 m/s²)²
double lateral_acceleration_term(std::span<const CostPoint> points);
/// mean a² / (2 m/s²)²
double longitudinal_acceleration_term(std::span<const CostPoint> points);
/// mean (d(v² k)/dt)² / (2 m/s³)², d(v² k)/dt = 2 v a k + v³ dk/dσ
double lateral_jerk_term(std::span<const CostPoint> points);
/// mean (da/dt)² / (2 m/s³)²
double longitudinal_jerk_term(std::span<const CostPoint> points);
/// mean (d − d of the previous plan)² / (0.5 m)²
double consistency_term(std::span<const CostPoint> points);
/// (T / T_ref)²: T = l_e · mean (dσ/ds / v), against L_max at the present speed; v ≥ 1 m/s in both.
double time_term(std::span<const CostPoint> points, const CostFrame& frame);

/// All twelve.
CostTerms cost_terms(std::span<const CostPoint> points, const CostFrame& frame);

/// Weighted sum, paper eq. 12.
double total_cost(const CostTerms& terms, const CostTerms& weights);

/// Documented in README.md, section "Cost".
CostTerms default_weights();

/// @throws std::invalid_argument naming the first weight that is negative or not finite.
void check_weights(const CostTerms& weights);

}  // namespace roadbed::planning::lateral
