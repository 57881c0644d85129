#pragma once

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {

/// The numbers of a CSV file, row by row, behind its head.
inline std::vector<std::vector<double>> rows_of(const std::filesystem::path& file) {
  std::istringstream lines(bytes_of(file));
  std::string line, field;
  std::getline(lines, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    rows.emplace_back();
    while (std::getline(fields, field, ',')) rows.back().push_back(std::stod(field));
  }
  return rows;
}

}  // namespace roadbed::tests
