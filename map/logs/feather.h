#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::map::inline logs {

/// Numbers, or texts, of one column of a Feather file.
struct FeatherColumn {
  std::string name;
  bool is_whole = false;
  std::vector<double> reals;         ///< where it is not whole
  std::vector<std::int64_t> wholes;  ///< where it is
  std::vector<std::string> texts;    ///< of a column of texts
};

/// Whether bytes begin as Feather, version 2: the file format of Apache Arrow.
bool is_feather(std::string_view bytes);

/// The columns of these names, all rows of all batches, plain or packed by LZ4 or Zstandard
/// [https://arrow.apache.org/docs/format/Columnar.html]. Whole numbers of 8 to 64 bits and floats
/// of 16 to 64 bits, and texts (UTF-8); other columns may be of any type. Bounded: nothing is taken
/// by what a header says before it is known to be there.
/// @param texts  names of columns of texts, which come behind those of numbers.
/// @throws InputError if the file is damaged, has no such column, or a value is missing (null).
std::vector<FeatherColumn> parse_feather(std::string_view bytes, const std::string& name,
                                         const std::vector<std::string>& columns,
                                         const std::vector<std::string>& texts = {});

}  // namespace roadbed::map::logs
