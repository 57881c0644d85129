#pragma once

// Private to tools/audit: numbers, spans and stretches as they stand in certificates.

#include <cstddef>
#include <vector>

#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/audit/proven_span.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline audit {

inline constexpr Range kAny{-1e12, 1e12}, kFraction{0.0, 1.0}, kLength_m{0.0, 200.0},
    kCount{0.0, 1e9};

/// Elements of a list of so many.
/// @throws InputError if there are others.
std::vector<JsonNode> numbers(const JsonNode& node, std::size_t count);

/// `[segment, from, to, at_least_m]` each.
Json spans_json(const std::vector<planning::ProvenSpan>& spans);
std::vector<planning::ProvenSpan> read_spans(const JsonNode& node);  ///< the inverse

/// `[from_s, to_s]` each.
Json stretches_json(const std::vector<planning::Stretch>& stretches);
std::vector<planning::Stretch> read_stretches(const JsonNode& node);  ///< the inverse

}  // namespace roadbed::tools::audit
