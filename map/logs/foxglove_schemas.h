#pragma once

#include <string>
#include <string_view>

#include "roadbed/map/logs/mcap_writer.h"

namespace roadbed::map::inline logs {

// Messages in Protocol Buffers, by name:
//
// - those of Foxglove [https://docs.foxglove.dev/docs/visualization/message-schemas], which
//   Foxglove, Lichtblick and, in part, Rerun show: foxglove.FrameTransform, PosesInFrame,
//   SceneUpdate, PointCloud, LocationFix, Log;
// - roadbed's own: `roadbed.DriveState`, a row of a drive, all of it and bit for bit;
//   `roadbed.Clearance`, the distance to the nearest thing at a time; `roadbed.Hypotheses` and
//   `roadbed.Candidates`, what a planning cycle considered.

inline constexpr std::string_view kDriveStateType = "roadbed.DriveState";

/// What a message of a type holds, with all types that it is made of.
/// @throws std::invalid_argument if the type is none of the above.
McapSchema foxglove_schema(std::string_view type);

}  // namespace roadbed::map::logs
