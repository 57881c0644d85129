#include "roadbed/tools/audit/certificate_values.h"

#include <fmt/format.h>

namespace roadbed::tools::inline audit {

using planning::ProvenSpan;
using planning::Stretch;

std::vector<JsonNode> numbers(const JsonNode& node, std::size_t count) {
  std::vector<JsonNode> elements = node.elements();
  if (elements.size() != count) {
    node.refuse(fmt::format("has {} values", elements.size()), fmt::format("{}", count),
                "write the certificate anew");
  }
  return elements;
}

Json spans_json(const std::vector<ProvenSpan>& spans) {
  Json json = Json::array();
  for (const ProvenSpan& span : spans) {
    json.push_back({span.segment, span.from, span.to, span.at_least_m});
  }
  return json;
}

std::vector<ProvenSpan> read_spans(const JsonNode& node) {
  std::vector<ProvenSpan> spans;
  for (const JsonNode& element : node.elements()) {
    const std::vector<JsonNode> values = numbers(element, 4);
    spans.push_back({static_cast<std::size_t>(values[0].number(kCount)),
                     values[1].number(kFraction), values[2].number(kFraction),
                     values[3].number(kLength_m)});
    if (!(spans.back().from < spans.back().to)) {
      element.refuse("is empty", "a start before its end", "write the certificate anew");
    }
  }
  return spans;
}

Json stretches_json(const std::vector<Stretch>& stretches) {
  Json json = Json::array();
  for (const Stretch& stretch : stretches) json.push_back({stretch.from_s, stretch.to_s});
  return json;
}

std::vector<Stretch> read_stretches(const JsonNode& node) {
  std::vector<Stretch> stretches;
  for (const JsonNode& element : node.elements()) {
    const std::vector<JsonNode> values = numbers(element, 2);
    stretches.push_back({values[0].number(kAny), values[1].number(kAny)});
  }
  return stretches;
}

}  // namespace roadbed::tools::audit
