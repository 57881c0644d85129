#include "roadbed/map/logs/argoverse_poses.h"

#include <span>

#include "roadbed/map/logs/pose_columns.h"

namespace roadbed::map::inline logs {

std::vector<TimedPose> read_ego_poses(std::string_view bytes, const std::string& name) {
  constexpr const char* remedy = "give city_SE3_egovehicle.feather";
  std::vector<std::string> wanted{"timestamp_ns"};
  wanted.insert(wanted.end(), kPoseColumns.begin(), kPoseColumns.end());
  const std::vector<FeatherColumn> columns = parse_feather(bytes, name, wanted);
  const std::vector<std::int64_t>& stamps_ns = stamps_in(columns[0], name, remedy);
  const auto in_city = poses_in(std::span(columns).subspan(1), name, remedy);
  std::vector<TimedPose> poses;
  for (std::size_t row = 0; row < stamps_ns.size(); ++row) {
    poses.push_back({stamps_ns[row], in_city[row]});
  }
  return poses;
}

}  // namespace roadbed::map::logs
