#include "roadbed/map/page/lon_lat_fit.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "roadbed/map/files/projection.h"

namespace roadbed::map {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

void utm32(std::span<Vector2d> places) { to_lon_lat("EPSG:25832", places); }

TEST(LonLatFit, IsTheProjectionWithinATenthOfAMillimetreOnTheBoxOfACity) {
  const AlignedBox2d box(Vector2d(680e3, 5330e3), Vector2d(720e3, 5350e3));
  const LonLatFit fit = fit_lon_lat(box, utm32);
  std::mt19937 random(20261125);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<Vector2d> places;
  for (int i = 0; i < 1000; ++i) {
    places.push_back(box.min() + box.sizes().cwiseProduct(Vector2d(share(random), share(random))));
  }
  std::vector<Vector2d> expected = places;
  utm32(expected);
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_LT((fit.at(places[i]) - expected[i]).cwiseAbs().maxCoeff(), 1e-9) << i;
  }
  EXPECT_LT(fit.most_error_deg, 1e-9);
}

}  // namespace
}  // namespace roadbed::map
