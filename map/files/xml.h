#pragma once

#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "roadbed/map/files/line_starts.h"

namespace roadbed::map::inline files {

/// An XML document that knows the line of each element, and reads attributes strictly.
/// External entities are never fetched and entity definitions never expanded. A namespace prefix of
/// the root is taken off the names of all elements. Values of attributes are one line
/// (`without_controls`).
class XmlDocument {
 public:
  /// @param name  stands for the file in messages.
  /// @throws InputError if the bytes are not well-formed XML, or hold more elements than a map of
  ///         their size does: memory stays bounded by the file's size.
  /// The elements stay where the bytes are: hand these over, and memory holds them once.
  XmlDocument(std::string bytes, std::string name);

  /// Lets the elements go, when all is read.
  void release() {
    document_.reset();
    text_.reset();
  }

  pugi::xml_node root() const { return document_.document_element(); }
  const std::string& name() const { return name_; }
  std::size_t size_bytes() const { return size_bytes_; }

  /// Line of an element, from 1.
  long line_of(pugi::xml_node node) const;

  /// A finite number.
  /// @throws InputError if the attribute is missing or not a finite number.
  double number(pugi::xml_node node, const char* attribute) const;

  /// The same, looked for from `next` on, which then is the attribute after it: quick for
  /// attributes that are asked for in the order in which files have them.
  double number(pugi::xml_node node, const char* attribute, pugi::xml_attribute& next) const;

  /// The same, `fallback` where the attribute is missing.
  double number_or(pugi::xml_node node, const char* attribute, double fallback) const;
  std::optional<double> optional_number(pugi::xml_node node, const char* attribute) const;
  std::optional<double> optional_number(pugi::xml_node node, const char* attribute,
                                        pugi::xml_attribute& next) const;

  /// @throws InputError if the attribute is missing or not a whole number.
  int integer(pugi::xml_node node, const char* attribute) const;
  std::optional<int> optional_integer(pugi::xml_node node, const char* attribute) const;

  /// @throws InputError if the attribute is missing or empty.
  std::string text(pugi::xml_node node, const char* attribute) const;

  /// What messages call an element: "<speed> of lane -1 of road 5".
  static std::string place_of(pugi::xml_node node);

  /// The finite number that is the element's text.
  /// @throws InputError if there is no element or its text is something else.
  double text_number(pugi::xml_node parent, const char* child) const;

  /// Throws InputError placed at the element.
  [[noreturn]] void refuse(pugi::xml_node node, const std::string& found, const std::string& needed,
                           const std::string& remedy) const;

 private:
  std::string name_;
  std::size_t size_bytes_;
  std::unique_ptr<std::string> text_;  // the elements' names and values lie in it
  LineStarts line_starts_;
  pugi::xml_document document_;
};

}  // namespace roadbed::map::files
