#include "roadbed/map/occupancy/clouds/read_point_cloud.h"

#include <fmt/format.h>

#include <utility>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/logs/feather.h"
#include "roadbed/map/logs/log.h"
#include "roadbed/map/occupancy/clouds/argoverse_sweeps.h"
#include "roadbed/map/occupancy/clouds/cloud_formats.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

using Parser = RawCloud (*)(std::string_view, const std::string&, const CloudFilter&);

bool begins_as_pcd(std::string_view bytes) {
  TextScanner lines(bytes.substr(0, 4096));
  while (!lines.done()) {
    std::string_view line = lines.next_line();
    if (line.starts_with("# .PCD")) return true;
    const std::string word = lower(next_word(line));
    if (word.empty() || word.starts_with('#')) continue;
    return word == "version" || word == "fields" || word == "columns";
  }
  return false;
}

Parser parser_by_suffix(const std::string& name) {
  const std::string suffix = lower(suffix_of_input(name));
  if (suffix == ".pcd") return parse_pcd;
  if (suffix == ".ply") return parse_ply;
  if (suffix == ".las" || suffix == ".laz") return parse_las;
  if (suffix == ".bin") return parse_kitti;
  for (const char* text : {".xyz", ".csv", ".txt", ".asc", ".pts"}) {
    if (suffix == text) return parse_xyz;
  }
  return nullptr;
}

Parser choose_parser(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("LASF")) return parse_las;
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return parse_ply;
  if (begins_as_pcd(bytes)) return parse_pcd;
  if (is_feather(bytes)) return parse_sweep;
  refuse_unusable_log(bytes, name);
  if (const Parser parser = parser_by_suffix(name)) return parser;
  if (begins_as_xyz(bytes)) return parse_xyz;
  refuse_cloud(name, "", "", "is of no known point cloud format",
               ".pcd, .ply, .las, .laz, .xyz, .csv, .bin or .feather",
               "convert it, or rename it to what it is");
}

/// The cloud of what was parsed, of which something has to be there.
PointCloud cloud_of(RawCloud raw, const std::string& name, const CloudFilter& filter) {
  if (raw.empty() && raw.filtered_out == 0) {
    refuse_cloud(name, "", "",
                 raw.dropped_not_finite == 0
                     ? "holds no point"
                     : fmt::format("none of its {} points is finite", raw.dropped_not_finite),
                 "at least one finite point", "check how the cloud was made");
  }
  PointCloud cloud = relative_to_origin(std::move(raw));
  cloud.name = name;
  return without_vehicle(std::move(cloud), filter);
}

}  // namespace

PointCloud parse_point_cloud(std::string_view bytes, const std::string& name,
                             const CloudFilter& filter) {
  return cloud_of(choose_parser(bytes, name)(bytes, name, filter), name, filter);
}

PointCloud point_cloud_of(const std::filesystem::path& file, std::string_view bytes,
                          const CloudFilter& filter) {
  const std::string name = input_name(file);
  if (!is_feather(bytes)) return parse_point_cloud(bytes, name, filter);
  SweepInLog sweep(file);
  return sweep.in_city(cloud_of(sweep.parse(bytes, name, filter), name, filter));
}

PointCloud read_point_cloud(const std::filesystem::path& file) {
  return point_cloud_of(file, read_file(file, most_unpacked_of_rows));
}

}  // namespace roadbed::map::occupancy::clouds
