#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::tools::inline files {

/// Fields of a line of CSV (RFC 4180 without line breaks in fields): spaces around a field do not
/// count, what stands in quotes is taken as it is.
std::vector<std::string> csv_fields(std::string_view line);

/// Goes through a table: a header line that names the columns, then a row a line. Byte order mark,
/// carriage returns and empty lines do not count.
class CsvReader {
 public:
  /// Reads the header line. The bytes have to outlive the reader; `name` stands for the file in
  /// messages.
  CsvReader(std::string_view bytes, std::string name);

  /// Place of a column in each row, if there is such a column. @throws InputError if it is there
  /// twice.
  std::optional<std::size_t> find_column(std::string_view name) const;

  /// The same. @throws InputError if there is none, with a header line that would do.
  std::size_t column(std::string_view name, std::string_view header_that_would_do) const;

  /// Goes to the next row; false if there is none.
  bool next_row();

  /// Line of the row (or header) in the file, from 1.
  std::size_t line() const { return line_; }
  const std::vector<std::string>& fields() const { return fields_; }

  /// How many fields the header has.
  std::size_t width() const { return names_.size(); }

  /// @throws InputError if the row has more or fewer fields than the header.
  void check_width() const;

  /// A number of the row. @throws InputError if it is none, or not from `least` to `most`.
  double number(std::size_t column, double least, double most) const;

  /// Refuses the row or header with its place.
  [[noreturn]] void refuse(const std::string& element, const std::string& found,
                           const std::string& needed,
                           const std::string& remedy = "mend the row") const;

 private:
  std::string_view take_line();

  std::string_view rest_;
  std::string name_;
  std::size_t line_ = 0;
  std::vector<std::string> names_, fields_;
};

}  // namespace roadbed::tools::files
