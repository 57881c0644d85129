#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace roadbed::geometry::inline curves {

/// Symmetric matrix that is zero away from the diagonal; only the lower half is kept.
class BandMatrix {
 public:
  /// @param bandwidth  number of diagonals below the main one.
  BandMatrix(std::size_t size, std::size_t bandwidth)
      : size_(size), width_(bandwidth + 1), values_(size * width_, 0.0) {}

  std::size_t size() const { return size_; }

  /// Entry of the lower half: row ≥ column ≥ row − bandwidth.
  double& at(std::size_t row, std::size_t column) {
    return values_[row * width_ + column + width_ - 1 - row];
  }

  /// x of `matrix x = right` by Cholesky's factors; none if the matrix is not positive definite to
  /// the digits that there are. O(N · bandwidth²).
  static std::optional<std::vector<double>> solve(BandMatrix matrix, std::vector<double> right);

 private:
  std::size_t first_column(std::size_t row) const {
    return row < width_ - 1 ? 0 : row - (width_ - 1);
  }
  bool factorise();

  std::size_t size_, width_;
  std::vector<double> values_;
};

}  // namespace roadbed::geometry::curves
