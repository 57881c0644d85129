// Times in seconds of the calls that Python makes, for tests/benchmark/python_calls:
//   bench_calls MAP OCCUPANCY POINTS POSES PAIRS REPS
// POINTS, POSES and PAIRS are files of doubles: x y, x y heading, x y x y. Prints JSON.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cstring>
#include <string>
#include <vector>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"
#include "roadbed/planning/route/match_place.h"
#include "roadbed/planning/route/router.h"

namespace {

using namespace roadbed;

std::vector<double> doubles_in(const std::string& file) {
  const std::string bytes = map::read_file(file);
  std::vector<double> values(bytes.size() / sizeof(double));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
  return values;
}

template <typename Work>
std::vector<double> seconds_of(int reps, const Work& work) {
  std::vector<double> seconds;
  for (int i = 0; i < reps; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return seconds;
}

}  // namespace

int main(int count, char** words) {
  if (count != 7) return 2;
  const map::RoadMap road_map = map::load_map(words[1]);
  const auto occupancy = map::open_occupancy(words[2]);
  const std::vector<double> points = doubles_in(words[3]), poses = doubles_in(words[4]),
                            pairs = doubles_in(words[5]);
  const int reps = std::stoi(words[6]);
  double sum = 0.0;  // of all answers, so that none is left out

  std::vector<Eigen::Vector2d> in_map(points.size() / 2);
  const auto locate = seconds_of(reps, [&] {
    for (std::size_t i = 0; i < in_map.size(); ++i) {
      in_map[i] = road_map.to_map({points[2 * i], points[2 * i + 1]});
    }
    const map::LaneMatches found =
        road_map.locate(in_map, std::numeric_limits<double>::infinity(), 1, false);
    for (std::size_t i = 0; i < in_map.size(); ++i) sum += found.of(i).front().place.s_m;
  });

  const geometry::VehicleShape vehicle;
  const map::ClearanceField field(*occupancy, {.to_m = vehicle.height_m});
  const auto clearance = seconds_of(reps, [&] {
    for (std::size_t i = 0; i + 2 < poses.size(); i += 3) {
      const auto near = field.nearest(geometry::Pose2{poses[i], poses[i + 1], poses[i + 2]},
                                      vehicle, std::numeric_limits<double>::infinity());
      if (near) sum += near->distance_m;
    }
  });

  planning::Router router(road_map);
  router.prepare();
  const auto place = [&](const double* at) {
    return planning::match_place(road_map, road_map.to_map({at[0], at[1]}), {}).front().place;
  };
  const auto routes = seconds_of(reps, [&] {
    std::vector<planning::RouteAnswer> answers;  // kept, as Python's list keeps them
    answers.reserve(pairs.size() / 4);
    for (std::size_t i = 0; i + 3 < pairs.size(); i += 4) {
      answers.push_back(router.find(place(&pairs[i]), place(&pairs[i + 2])));
      if (answers.back().route) sum += answers.back().route->cost_s;
    }
  });
  fmt::print("{{\"locate_s\":[{}],\"clearance_s\":[{}],\"routes_s\":[{}],\"sum\":{}}}\n",
             fmt::join(locate, ","), fmt::join(clearance, ","), fmt::join(routes, ","), sum);
  return 0;
}
