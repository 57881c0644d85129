#include "roadbed/tools/files/weights_json.h"

#include <fmt/format.h>

#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline files {
namespace {

using planning::CostTerm;

constexpr Range kWeights{0.0, 1e6};

std::string known_terms() {
  std::string names;
  for (int i = 0; i < planning::kCostTerms; ++i) {
    if (i > 0) names += ", ";
    names += planning::to_string(static_cast<CostTerm>(i));
  }
  return names;
}

CostTerm find_term(const std::string& key, const JsonNode& node) {
  for (int i = 0; i < planning::kCostTerms; ++i) {
    const auto term = static_cast<CostTerm>(i);
    if (planning::to_string(term) == key) return term;
  }
  node.refuse("is no term of the cost", "one of " + known_terms(), "correct or remove the key");
}

}  // namespace

planning::CostTerms parse_weights(std::string_view bytes, const std::string& name) {
  const nlohmann::json document = parse_json_strictly(bytes, name);
  planning::CostTerms weights = planning::default_weights();
  for (const auto& [key, node] : JsonNode(document, name).members()) {
    planning::of(weights, find_term(key, node)) = node.number(kWeights);
  }
  return weights;
}

planning::CostTerms read_weights(const std::filesystem::path& file) {
  return parse_weights(map::read_file(file), file.string());
}

}  // namespace roadbed::tools::files
