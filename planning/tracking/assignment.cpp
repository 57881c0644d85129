#include "roadbed/planning/tracking/assignment.h"

#include <Eigen/Core>
#include <limits>
#include <map>

namespace roadbed::planning::inline tracking {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Least sum over a full matrix with no fewer columns than rows; per row its column.
class LeastSum {
 public:
  explicit LeastSum(const Eigen::MatrixXd& costs)
      : costs_(costs),
        of_row_(static_cast<std::size_t>(costs.rows()), 0.0),
        of_column_(static_cast<std::size_t>(costs.cols()), 0.0),
        row_of_(static_cast<std::size_t>(costs.cols()), kNone) {}

  std::vector<std::size_t> columns() {
    for (std::size_t row = 0; row < of_row_.size(); ++row) add(row);
    std::vector<std::size_t> column_of(of_row_.size(), kNone);
    for (std::size_t column = 0; column < row_of_.size(); ++column) {
      if (row_of_[column] != kNone) column_of[row_of_[column]] = column;
    }
    return column_of;
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  double reduced(std::size_t row, std::size_t column) const {
    return costs_(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) -
           of_row_[row] - of_column_[column];
  }

  /// Along the shortest path of exchanges to a column that nobody has.
  void add(std::size_t new_row) {
    const std::size_t columns = row_of_.size();
    std::vector<double> way(columns, kInfinity);
    std::vector<std::size_t> from(columns, kNone);
    std::vector<bool> is_done(columns, false);
    std::vector<std::size_t> done;
    std::size_t row = new_row, last = kNone;  // column that row has
    double reached = 0.0;
    while (true) {
      std::size_t nearest = kNone;
      for (std::size_t column = 0; column < columns; ++column) {
        if (is_done[column]) continue;
        const double over = reached + reduced(row, column);
        if (over < way[column]) {
          way[column] = over;
          from[column] = last;
        }
        if (nearest == kNone || way[column] < way[nearest]) nearest = column;
      }
      reached = way[nearest];
      last = nearest;
      if (row_of_[nearest] == kNone) break;
      is_done[nearest] = true;
      done.push_back(nearest);
      row = row_of_[nearest];
    }
    of_row_[new_row] += reached;
    for (const std::size_t column : done) {
      of_row_[row_of_[column]] += reached - way[column];
      of_column_[column] -= reached - way[column];
    }
    for (std::size_t column = last; column != kNone; column = from[column]) {
      row_of_[column] = from[column] == kNone ? new_row : row_of_[from[column]];
    }
  }

  const Eigen::MatrixXd& costs_;
  std::vector<double> of_row_, of_column_;  ///< potentials
  std::vector<std::size_t> row_of_;         ///< per column
};

/// Numbers for those that take part, in the order in which they are first named.
class Numbers {
 public:
  std::size_t of(std::size_t name) {
    const auto [at, is_new] = number_.try_emplace(name, names_.size());
    if (is_new) names_.push_back(name);
    return at->second;
  }
  const std::vector<std::size_t>& names() const { return names_; }

 private:
  std::map<std::size_t, std::size_t> number_;
  std::vector<std::size_t> names_;
};

}  // namespace

std::vector<std::optional<std::size_t>> assign(std::size_t rows, std::size_t columns,
                                               const std::vector<PossiblePair>& pairs,
                                               double cost_of_none) {
  std::vector<std::optional<std::size_t>> column_of(rows);
  std::vector<int> of_row(rows, 0), of_column(columns, 0);
  for (const PossiblePair& pair : pairs) {
    ++of_row[pair.row];
    ++of_column[pair.column];
  }
  std::vector<PossiblePair> contested;
  Numbers row_numbers, column_numbers;
  for (const PossiblePair& pair : pairs) {
    if (of_row[pair.row] == 1 && of_column[pair.column] == 1) {
      column_of[pair.row] = pair.column;
      continue;
    }
    contested.push_back(pair);
    row_numbers.of(pair.row);
    column_numbers.of(pair.column);
  }
  if (contested.empty()) return column_of;
  // Every row may also have a column of its own that stands for none.
  const auto own = static_cast<Eigen::Index>(column_numbers.names().size());
  const auto count = static_cast<Eigen::Index>(row_numbers.names().size());
  const double never = cost_of_none * static_cast<double>(count + 1) + 1.0;
  Eigen::MatrixXd costs = Eigen::MatrixXd::Constant(count, own + count, never);
  costs.rightCols(count).diagonal().setConstant(cost_of_none);
  for (const PossiblePair& pair : contested) {
    costs(static_cast<Eigen::Index>(row_numbers.of(pair.row)),
          static_cast<Eigen::Index>(column_numbers.of(pair.column))) = pair.cost;
  }
  const std::vector<std::size_t> found = LeastSum(costs).columns();
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool is_real = found[i] < column_numbers.names().size();
    if (is_real) column_of[row_numbers.names()[i]] = column_numbers.names()[found[i]];
  }
  return column_of;
}

}  // namespace roadbed::planning::tracking
