#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::map::inline files {

/// Reads XML in one pass, tag by tag, and builds no tree: for large files of many small elements,
/// several times as fast as XmlDocument. Names and values are views of the text, or of what was
/// decoded from it, and live as long as the text and the scanner. Text between tags, comments,
/// CDATA, instructions and the document type are skipped; no entity but XML's own five and
/// characters by number is replaced.
///
///     XmlScanner scanner(text, "map.osm");
///     while (scanner.next() != XmlScanner::Event::done) { … scanner.name() … }
class XmlScanner {
 public:
  /// `start` of an element, `end` of the one that began last (`<a/>` has both), or `done`: the
  /// first element of the text has ended.
  enum class Event { start, end, done };

  /// @param text  UTF-8; must outlive the scanner.
  /// @param file  stands for the file in messages.
  /// @param from  where to begin: at the start tag of an element, to read that element alone.
  XmlScanner(std::string_view text, std::string file, std::size_t from = 0);

  /// A stretch of a text.
  struct Stretch {
    std::size_t from, to;
    std::string_view inside;  ///< the element that it is in the midst of; empty: begins in it
  };

  /// Reads whole elements inside the text's first element; `done` comes behind the last of them, or
  /// with the first element's end. Stretches that lie end to end, of which the last alone comes to
  /// that end, hold the same elements as the text, if all of them can be read.
  XmlScanner(std::string_view text, std::string file, const Stretch& stretch);

  /// @throws InputError with the line if the text is not well-formed, is nested deeper than 1,000
  ///         elements or has an element of more than 10,000 attributes.
  Event next();

  /// Goes past the end of the element that has just started.
  void skip();

  /// @throws InputError if another element follows the first.
  void expect_end();

  /// The element that starts or ends here.
  std::string_view name() const { return name_; }

  /// Elements that are open, the one that starts here included.
  std::size_t depth() const { return open_.size(); }

  /// Of an attribute of the element that starts here, empty if it has none of that name.
  std::string_view value(std::string_view attribute) const;

  /// Where the tag begins in the text.
  std::size_t offset() const { return offset_; }

 private:
  struct Attribute {
    std::string_view name, value;
  };

  [[noreturn]] void refuse(const std::string& reason) const;
  bool at_end() const { return at_ == text_.size(); }
  char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool skip_space();
  void skip_past(std::string_view end, const char* what);
  void skip_markup();
  void skip_document_type();
  std::string_view take_name();
  std::string_view take_value();
  bool take_plain_attribute();
  void take_attribute();
  bool find_tag();
  Event enter();
  Event leave();
  Event read_start();
  Event read_end();

  std::string_view text_;
  std::string file_;
  std::size_t at_, offset_;
  std::string_view name_;
  std::vector<Attribute> attributes_;
  std::vector<std::string_view> open_;
  bool is_empty_ = false;  // the element that starts here ends here, too
  bool is_done_ = false;
  bool is_stretch_ = false;  // ends where the text does not
  std::deque<std::string> decoded_;
};

/// Name of a text's first element, even of one that is not well-formed; empty if it has none.
std::string_view root_element(std::string_view text);

}  // namespace roadbed::map::files
