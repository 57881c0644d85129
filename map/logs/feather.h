#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::map::inline logs {

/// Numbers of one column of a Feather file.
struct FeatherColumn {
  std::string name;
  bool is_whole = false;
  std::vector<double> reals;         ///< where it is not whole
  std::vector<std::int64_t> wholes;  ///< where it is
};

/// Whether bytes begin as Feather, version 2: the file format of Apache Arrow.
bool is_feather(std::string_view bytes);

/// The columns of these names, all rows of all batches, plain or packed by LZ4 or Zstandard
/// [https://arrow.apache.org/docs/format/Columnar.html]. Whole numbers of 8 to 64 bits and floats
/// of 16 to 64 bits; other columns may be of any type. Bounded: nothing is taken by what a header
/// says before it is known to be there.
/// @throws InputError if the file is damaged, has no such column, or a value is missing (null).
std::vector<FeatherColumn> parse_feather(std::string_view bytes, const std::string& name,
                                         const std::vector<std::string>& columns);

}  // namespace roadbed::map::logs
