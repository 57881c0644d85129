#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/derived/map_totals.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/index/road_map_index.h"
#include "roadbed/tests/support/reseal.h"

namespace {

using namespace roadbed::map;

/// Calls and forgets that a place is damaged: others may still be whole.
template <typename Use>
void guarded(const Use& use) {
  try {
    use();
  } catch (const InputError&) {
    return;
  }
}

// Touches every record and asks the index, whatever is damaged.
void use(const RoadMap& road_map) {
  for (std::size_t i = 0; i < road_map.lanes().size(); ++i) {
    guarded([&] {
      const Lane& lane = road_map.lanes()[i];
      road_map.find_lane(lane.name);
      lane.width_m(0.5 * lane.length_m());
      const Eigen::Vector2d start = lane.pose_at(0.0).position();
      road_map.locate(start, 50.0, false);
      road_map.locate(std::vector{start, lane.right.in_map.points().back()}, 1e6, 1, true);
      road_map.index().lanes.in_box(start, start + Eigen::Vector2d(5.0, 5.0), LaneTypes::all());
    });
    guarded([&] { road_map.graph().of(LaneId{static_cast<std::uint32_t>(i)}); });
  }
  guarded([&] { road_map.find_lane("1/0/-1"); });
  guarded([&] { road_map.on_surface({0.0, 0.0}, 10.0); });
  guarded([&] { road_map.parts(); });
  guarded([&] { totals_of(road_map); });
}

/// Bytes as a file, as long as it lives.
class OpenedFile {
 public:
  explicit OpenedFile(const std::string& bytes) : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    if (::pwrite(descriptor_, bytes.data(), bytes.size(), 0) < 0) std::abort();
  }
  ~OpenedFile() { ::close(descriptor_); }
  OpenedFile(const OpenedFile&) = delete;
  OpenedFile& operator=(const OpenedFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace

// The bytes as they are, then with right sizes and checksums, so that what is fuzzed are the
// readers behind; of some sizes as a file, or with a chunk that is damaged after all.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  guarded([&] { verify_compiled_map(bytes, "as it is"); });
  roadbed::tests::reseal(bytes);
  if (size % 16 == 1) bytes.back() ^= 1;
  guarded([&] { verify_compiled_map(bytes, "fuzz"); });
  if (size % 4 != 0) {
    guarded([&] { use(read_compiled_map(bytes, "fuzz")); });
    return 0;
  }
  const OpenedFile file(bytes);
  guarded([&] { use(open_compiled_map(file.path())); });
  guarded([&] { source_of_compiled_map(file.path()); });
  return 0;
}
