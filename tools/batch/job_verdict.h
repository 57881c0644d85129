#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace roadbed::tools::inline batch {

/// What a job's document comes to.
struct JobVerdict {
  std::string text;      ///< "conflict, least clearance 0.120 m"
  double badness = 0.0;  ///< greater is worse, among jobs of one kind and status
};

/// @param kind      name of the command.
/// @param document  the JSON that it printed.
/// @throws std::invalid_argument if it is not what that command prints.
JobVerdict verdict_of(std::string_view kind, const nlohmann::json& document);

}  // namespace roadbed::tools::batch
