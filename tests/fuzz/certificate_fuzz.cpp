// certificate.json in, certificate or InputError out; what can be read is checked against a small
// occupancy and an obstacle that moves, and must end in a list of faults.
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/planning/audit/check/certificate_check.h"
#include "roadbed/tools/audit/certificate_file_check.h"
#include "roadbed/tools/audit/certificate_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const geometry::Trajectory drive({{.t_s = 0}, {.t_s = 1, .x_m = 8}, {.t_s = 2, .x_m = 9}});
  const std::vector<map::OccupancyCell> cells{{{5, 3, 1}, 0.4, map::CellState::occupied},
                                              {{5, 0, 1}, 1.6, map::CellState::free}};
  const std::vector<planning::ObstacleInSource> movers{
      {.id = "a",
       .length_m = 4.0,
       .width_m = 2.0,
       .motion = geometry::Trajectory({{.t_s = 0, .y_m = 4}, {.t_s = 2, .x_m = 5, .y_m = 4}})}};
  try {
    const auto file = tools::parse_certificate_json(bytes, "fuzz.json");
    for (const auto& part : file.parts) {
      planning::check_certificate(part, cells, 0.4, drive);
      planning::check_certificate(part, cells, 0.4, drive, movers);
      planning::checked_distance_m(part, drive);
    }
    tools::part_faults(file, tools::Vehicle{});
    tools::ground_faults_of(file, drive, nullptr, cells, 0.4);
  } catch (const map::InputError&) {
  } catch (const std::length_error&) {
  }
  return 0;
}
