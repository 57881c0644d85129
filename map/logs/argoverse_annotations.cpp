#include "roadbed/map/logs/argoverse_annotations.h"

#include <span>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/logs/pose_columns.h"

namespace roadbed::map::inline logs {

std::vector<AnnotatedBox> read_annotations(std::string_view bytes, const std::string& name) {
  constexpr const char* remedy = "give annotations.feather";
  std::vector<std::string> wanted{"timestamp_ns"};
  wanted.insert(wanted.end(), kPoseColumns.begin(), kPoseColumns.end());
  for (const char* size : {"length_m", "width_m", "height_m"}) wanted.emplace_back(size);
  const std::vector<FeatherColumn> columns =
      parse_feather(bytes, name, wanted, {"track_uuid", "category"});
  const std::span<const FeatherColumn> all(columns);
  const std::vector<std::int64_t>& stamps_ns = stamps_in(columns[0], name, remedy);
  const auto poses = poses_in(all.subspan(1, kPoseColumns.size()), name, remedy);
  const auto sizes = all.subspan(1 + kPoseColumns.size(), 3);
  std::vector<AnnotatedBox> boxes;
  for (std::size_t row = 0; row < stamps_ns.size(); ++row) {
    const auto size_m = [&](std::size_t i) {
      const FeatherColumn& column = sizes[i];
      const double size =
          column.is_whole ? static_cast<double>(column.wholes[row]) : column.reals[row];
      if (size > 0.0 && size < 1e3) return size;
      throw InputError({.file = name,
                        .place = "row " + std::to_string(row + 1),
                        .element = "column " + column.name,
                        .found = "is " + std::to_string(size),
                        .needed = "above 0, below 1000 m",
                        .remedy = remedy});
    };
    boxes.push_back({stamps_ns[row],
                     columns[columns.size() - 2].texts[row],
                     columns.back().texts[row],
                     {size_m(0), size_m(1), size_m(2)},
                     poses[row]});
  }
  return boxes;
}

}  // namespace roadbed::map::logs
