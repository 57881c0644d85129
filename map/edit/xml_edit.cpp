#include "roadbed/map/edit/xml_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "roadbed/map/files/xml_characters.h"

namespace roadbed::map::inline edit {
namespace {

class StringWriter : public pugi::xml_writer {
 public:
  explicit StringWriter(std::string& text) : text_(text) {}
  void write(const void* data, std::size_t size) override {
    text_.append(static_cast<const char*>(data), size);
  }

 private:
  std::string& text_;
};

// Whether the blanks before elements would be more than the elements.
class IsDeep : public pugi::xml_tree_walker {
 public:
  bool for_each(pugi::xml_node&) override {
    is_deep_ = depth() >= kDeep;
    return !is_deep_;
  }
  bool operator()(pugi::xml_node root) {
    root.traverse(*this);
    return is_deep_;
  }

 private:
  static constexpr int kDeep = 100;
  bool is_deep_ = false;
};

pugi::xml_node next_said(pugi::xml_node node, const Ignored& ignored) {
  while (node && (node.type() == pugi::node_comment || ignored(node))) node = node.next_sibling();
  return node;
}

void print_declaration(pugi::xml_node declaration, pugi::xml_writer& writer) {
  pugi::xml_document copy;
  copy.append_copy(declaration);
  declare_utf8(copy.first_child());
  copy.print(writer, "", pugi::format_default, pugi::encoding_utf8);
}

bool have_same_attributes(pugi::xml_node a, pugi::xml_node b) {
  pugi::xml_attribute one = a.first_attribute(), other = b.first_attribute();
  for (; one && other; one = one.next_attribute(), other = other.next_attribute()) {
    if (std::strcmp(one.name(), other.name()) != 0 || std::strcmp(one.value(), other.value()) != 0)
      return false;
  }
  return !one && !other;
}

}  // namespace

double number(pugi::xml_node node, const char* attribute) {
  return node.attribute(attribute).as_double();
}

std::string text(pugi::xml_node node, const char* attribute) {
  return node.attribute(attribute).value();
}

void set_text(pugi::xml_node node, const char* attribute, std::string_view value) {
  pugi::xml_attribute found = node.attribute(attribute);
  if (!found) found = node.append_attribute(attribute);
  found.set_value(std::string(value).c_str());
}

void set_number(pugi::xml_node node, const char* attribute, double value) {
  set_text(node, attribute, fmt::format("{}", value + 0.0));  // no −0
}

std::vector<pugi::xml_node> children(pugi::xml_node parent, const char* name) {
  const auto range = parent.children(name);
  return {range.begin(), range.end()};
}

void remove_children(pugi::xml_node parent, const char* name) {
  while (parent.remove_child(name)) continue;
}

pugi::xml_node child_of(pugi::xml_node parent, const char* name) {
  const pugi::xml_node found = parent.child(name);
  return found ? found : parent.append_child(name);
}

namespace {

// The child before which one of that name has to stand; none: at the end.
pugi::xml_node follower(pugi::xml_node parent, std::string_view name,
                        std::span<const std::string_view> order) {
  const auto place = [&](std::string_view one) {
    return std::find(order.begin(), order.end(), one) - order.begin();
  };
  return parent.find_child([&](pugi::xml_node child) {
    return child.type() == pugi::node_element && place(child.name()) > place(name);
  });
}

}  // namespace

pugi::xml_node ordered_child(pugi::xml_node parent, const char* name,
                             std::span<const std::string_view> order) {
  if (const pugi::xml_node found = parent.child(name)) return found;
  const pugi::xml_node next = follower(parent, name, order);
  return next ? parent.insert_child_before(name, next) : parent.append_child(name);
}

pugi::xml_node insert_ordered(pugi::xml_node parent, pugi::xml_node element,
                              std::span<const std::string_view> order) {
  const pugi::xml_node next = follower(parent, element.name(), order);
  return next ? parent.insert_copy_before(element, next) : parent.append_copy(element);
}

// Pairs that are still to be compared stand in a list: depth is the file's, not ours.
bool say_the_same(pugi::xml_node a, pugi::xml_node b, const Ignored& ignored) {
  std::vector<std::pair<pugi::xml_node, pugi::xml_node>> open{{a, b}};
  while (!open.empty()) {
    const auto [one, other] = open.back();
    open.pop_back();
    if (std::strcmp(one.name(), other.name()) != 0 ||
        std::strcmp(one.value(), other.value()) != 0 || !have_same_attributes(one, other))
      return false;
    pugi::xml_node x = next_said(one.first_child(), ignored);
    pugi::xml_node y = next_said(other.first_child(), ignored);
    while (x && y) {
      open.emplace_back(x, y);
      x = next_said(x.next_sibling(), ignored);
      y = next_said(y.next_sibling(), ignored);
    }
    if (x || y) return false;
  }
  return true;
}

std::string text_of(const XmlDocument& xml, const std::string& indent) {
  return text_of(xml.root(), indent, xml.size_bytes());
}

std::string text_of(pugi::xml_node root, const std::string& indent, std::size_t likely_bytes) {
  std::string text;
  text.reserve(likely_bytes + likely_bytes / 8);
  StringWriter writer(text);
  const unsigned format = IsDeep()(root) ? pugi::format_raw : pugi::format_default;
  for (const pugi::xml_node node : root.parent().children()) {
    if (node.type() == pugi::node_declaration) {
      print_declaration(node, writer);
    } else {
      node.print(writer, indent.c_str(), format, pugi::encoding_utf8);
    }
  }
  return text;
}

std::string indent_of(std::string_view text) {
  // The first line that begins with blanks and an element's start.
  for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1)) {
    const std::size_t begin = text.find_first_not_of(" \t", at + 1);
    if (begin == text.npos || begin == at + 1 || text[begin] != '<') continue;
    return std::string(text.substr(at + 1, std::min<std::size_t>(begin - at - 1, 8)));
  }
  return "  ";
}

}  // namespace roadbed::map::edit
