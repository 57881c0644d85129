// Feather in; an ego's poses, annotations and a sweep, or InputError out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/logs/argoverse_annotations.h"
#include "roadbed/map/logs/argoverse_poses.h"
#include "roadbed/map/logs/feather.h"
#include "roadbed/tests/fuzz/read_cloud.h"

namespace {

/// Calls what may refuse the bytes: others may still read them.
template <typename Read>
void tried(const Read& read) {
  try {
    read();
  } catch (const roadbed::map::InputError&) {
    return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (!map::is_feather(bytes)) return -1;
  tried([&] { map::parse_feather(bytes, "fuzz.feather", {"timestamp_ns", "tx_m", "qw"}); });
  tried([&] { map::parse_feather(bytes, "fuzz.feather", {"timestamp_ns"}, {"track_uuid"}); });
  tried([&] { map::read_ego_poses(bytes, "fuzz.feather"); });
  tried([&] { map::read_annotations(bytes, "fuzz.feather"); });
  tests::read_cloud(bytes, "fuzz.feather");
  return 0;
}
