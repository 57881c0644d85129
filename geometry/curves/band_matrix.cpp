#include "roadbed/geometry/curves/band_matrix.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadbed::geometry::inline curves {

bool BandMatrix::factorise() {
  for (std::size_t row = 0; row < size_; ++row) {
    for (std::size_t column = first_column(row); column <= row; ++column) {
      double sum = at(row, column);
      const std::size_t from = std::max(first_column(row), first_column(column));
      for (std::size_t k = from; k < column; ++k) sum -= at(row, k) * at(column, k);
      if (column < row) {
        at(row, column) = sum / at(column, column);
      } else if (sum > 0.0) {
        at(row, row) = std::sqrt(sum);
      } else {
        return false;
      }
    }
  }
  return true;
}

std::optional<std::vector<double>> BandMatrix::solve(BandMatrix matrix, std::vector<double> right) {
  if (!matrix.factorise()) return {};
  for (std::size_t row = 0; row < matrix.size_; ++row) {
    for (std::size_t k = matrix.first_column(row); k < row; ++k) {
      right[row] -= matrix.at(row, k) * right[k];
    }
    right[row] /= matrix.at(row, row);
  }
  for (std::size_t row = matrix.size_; row-- > 0;) {
    right[row] /= matrix.at(row, row);
    for (std::size_t k = matrix.first_column(row); k < row; ++k) {
      right[k] -= matrix.at(row, k) * right[row];
    }
  }
  return right;
}

}  // namespace roadbed::geometry::curves
