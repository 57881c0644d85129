#include "roadbed/map/files/xml.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/xml_characters.h"

namespace roadbed::map::inline files {
namespace {

// What pugixml will allocate for elements, texts and attributes [bytes]: 64 for a node, 40 for an
// attribute.
std::size_t tree_bytes(const std::string& bytes) {
  std::size_t nodes = 0, attributes = 0;
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i) {
    const char next = bytes[i + 1];
    nodes += bytes[i] == '<' && next != '/' ? 1 : 0;
    nodes += bytes[i] == '>' && next != '<' && next > ' ' ? 1 : 0;
    attributes += bytes[i] == '=' && (next == '"' || next == '\'') ? 1 : 0;
  }
  return 64 * nodes + 40 * attributes;
}

void check_size(const std::string& bytes, const std::string& name) {
  constexpr std::size_t small = 8'000'000, longest = 0xffff'ffff;
  if (bytes.size() <= small) return;
  const bool too_long = bytes.size() > longest;
  if (!too_long && tree_bytes(bytes) <= bytes.size() + geometry::most_bytes_read(bytes.size()))
    return;
  throw InputError({.file = name,
                    .found = too_long ? "more than 4 GB" : "next to nothing but empty elements",
                    .needed = "a map with content of its size",
                    .remedy = "check whether it is the right file"});
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> parse_finite(std::string_view text) {
  text = trim(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

// Takes the root's prefix off all names that have it: <o:OpenDRIVE> and what it holds are read as
// if the namespace were the default one. Names only become shorter, in place, and none becomes
// empty, which would have no place.
void drop_prefix(pugi::xml_node root) {
  const std::string_view name = root.name();
  const auto colon = name.find(':');
  if (colon == name.npos) return;
  const std::string prefix(name.substr(0, colon + 1));
  const auto shorten = [&](pugi::xml_node node) {
    const std::string_view full = node.name();
    const bool has_more = full.size() > prefix.size();
    if (has_more && full.starts_with(prefix))
      node.set_name(std::string(full.substr(prefix.size())).c_str());
  };
  pugi::xml_node node = root;
  while (node) {
    shorten(node);
    if (node.first_child()) {
      node = node.first_child();
      continue;
    }
    while (node && node != root && !node.next_sibling()) node = node.parent();
    node = node == root ? pugi::xml_node() : node.next_sibling();
  }
}

}  // namespace

XmlDocument::XmlDocument(std::string bytes, std::string name)
    : name_(std::move(name)),
      size_bytes_(bytes.size()),
      text_(std::make_unique<std::string>(without_controls(std::move(bytes)))),
      line_starts_(*text_) {
  check_size(*text_, name_);
  // Text is kept in its element: a node less for each. Comments and the like are kept for who
  // writes the document again.
  const pugi::xml_parse_result result = document_.load_buffer_inplace(
      text_->data(), text_->size(), pugi::parse_full | pugi::parse_embed_pcdata);
  if (!result) {
    throw InputError(
        {.file = name_,
         .place = std::to_string(line_starts_.line_at(static_cast<std::size_t>(result.offset))),
         .found = fmt::format("not well-formed XML ({})", result.description()),
         .needed = "a whole XML document",
         .remedy = "check whether the file was cut off or is of another kind"});
  }
  drop_prefix(document_.document_element());
}

long XmlDocument::line_of(pugi::xml_node node) const {
  const std::ptrdiff_t offset = node.offset_debug();
  return offset < 0 ? 0 : line_starts_.line_at(static_cast<std::size_t>(offset));
}

std::string XmlDocument::place_of(pugi::xml_node node) {
  std::string element = fmt::format("<{}>", node.name());
  for (pugi::xml_node up = node; up; up = up.parent()) {
    const std::string_view kind = up.name();
    if (kind == "road" || kind == "junction" || kind == "lane" || kind == "lanelet" ||
        kind == "planningProblem" || kind.ends_with("bstacle")) {
      element += fmt::format(" of {} {}", kind, up.attribute("id").value());
    }
  }
  return element;
}

void XmlDocument::refuse(pugi::xml_node node, const std::string& found, const std::string& needed,
                         const std::string& remedy) const {
  throw InputError({.file = name_,
                    .place = std::to_string(line_of(node)),
                    .element = place_of(node),
                    .found = found,
                    .needed = needed,
                    .remedy = remedy});
}

double XmlDocument::number(pugi::xml_node node, const char* attribute) const {
  pugi::xml_attribute first;
  return number(node, attribute, first);
}

double XmlDocument::number(pugi::xml_node node, const char* attribute,
                           pugi::xml_attribute& next) const {
  const pugi::xml_attribute found = node.attribute(attribute, next);
  if (!found) {
    refuse(node, fmt::format("attribute {} is missing", attribute), "a finite number", "add it");
  }
  const std::optional<double> value = parse_finite(found.value());
  if (!value) {
    refuse(node, fmt::format("{}=\"{}\"", attribute, found.value()), "a finite number",
           "correct the value");
  }
  return *value;
}

double XmlDocument::number_or(pugi::xml_node node, const char* attribute, double fallback) const {
  pugi::xml_attribute found = node.attribute(attribute);
  return found ? number(node, attribute, found) : fallback;
}

std::optional<double> XmlDocument::optional_number(pugi::xml_node node,
                                                   const char* attribute) const {
  pugi::xml_attribute first;
  return optional_number(node, attribute, first);
}

std::optional<double> XmlDocument::optional_number(pugi::xml_node node, const char* attribute,
                                                   pugi::xml_attribute& next) const {
  const pugi::xml_attribute found = node.attribute(attribute, next);
  return found ? parse_finite(found.value()) : std::nullopt;
}

std::optional<int> XmlDocument::optional_integer(pugi::xml_node node, const char* attribute) const {
  std::string_view written = trim(node.attribute(attribute).value());
  if (written.starts_with('+')) written.remove_prefix(1);
  int value = 0;
  const auto [end, error] = std::from_chars(written.data(), written.data() + written.size(), value);
  if (error != std::errc() || end != written.data() + written.size() || written.empty()) return {};
  return value;
}

int XmlDocument::integer(pugi::xml_node node, const char* attribute) const {
  const std::optional<int> value = optional_integer(node, attribute);
  if (!value) {
    refuse(node, fmt::format("{}=\"{}\"", attribute, trim(node.attribute(attribute).value())),
           "a whole number", "correct the value");
  }
  return *value;
}

std::string XmlDocument::text(pugi::xml_node node, const char* attribute) const {
  const std::string value = node.attribute(attribute).value();
  if (value.empty()) {
    refuse(node, fmt::format("attribute {} is missing or empty", attribute), "a text", "add it");
  }
  return value;
}

double XmlDocument::text_number(pugi::xml_node parent, const char* child) const {
  const pugi::xml_node node = parent.child(child);
  if (!node) refuse(parent, fmt::format("element <{}> is missing", child), "a number", "add it");
  const std::optional<double> value = parse_finite(node.child_value());
  if (!value) {
    refuse(node, fmt::format("\"{}\"", node.child_value()), "a finite number", "correct the value");
  }
  return *value;
}

}  // namespace roadbed::map::files
