#pragma once

#include <string>
#include <string_view>

namespace roadbed::map::inline files {

/// For what was not told as a log, before it is taken for a table or a cloud.
/// @throws InputError if it begins as a log that nobody here reads: a bag of ROS 1, or an MCAP file
/// of
///         another version or with a damaged start.
void refuse_unusable_log(std::string_view bytes, const std::string& name);

}  // namespace roadbed::map::files
