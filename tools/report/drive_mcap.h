#pragma once

#include <string>

#include "roadbed/tools/report/drive_space.h"
#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

/// The name of a drive's log in its folder.
inline constexpr const char* kDriveLogName = "drive.mcap";

/// A drive as MCAP, for Foxglove, Lichtblick, Rerun and whoever reads Protocol Buffers: the topics
/// are listed in README.md. Occupied cells are those up to 60 m around, 2^20 at most: where there
/// are more, cells of twice their size in each direction, and so on. Times are the drive's, from
/// its first row on where that is before 1970 or after 2200. Same input, same bytes.
/// @pre the drive has a row
std::string drive_mcap(const ReportInput& input, const DriveSpace& space);

}  // namespace roadbed::tools::report
