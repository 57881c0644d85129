#include "roadbed/planning/tracking/assignment.h"

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

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

using Given = std::vector<std::optional<std::size_t>>;

/// Pairs that have a row or a column in common with another one of them, and those apart from all
/// others. Rows come first in the forest, columns behind them.
std::vector<std::vector<PossiblePair>> in_groups(std::size_t rows, std::size_t columns,
                                                 const std::vector<PossiblePair>& pairs) {
  std::vector<std::size_t> above(rows + columns);
  std::iota(above.begin(), above.end(), std::size_t{0});
  const auto root = [&](std::size_t node) {
    while (above[node] != node) node = above[node] = above[above[node]];
    return node;
  };
  for (const PossiblePair& pair : pairs) above[root(pair.row)] = root(rows + pair.column);
  std::map<std::size_t, std::vector<PossiblePair>> groups;
  for (const PossiblePair& pair : pairs) groups[root(pair.row)].push_back(pair);
  std::vector<std::vector<PossiblePair>> all;
  for (auto& [at, group] : groups) all.push_back(std::move(group));
  return all;
}

/// The cheapest first.
void take_cheapest(std::vector<PossiblePair> pairs, std::size_t columns, Given& column_of) {
  std::ranges::sort(pairs, {}, [](const PossiblePair& pair) {
    return std::tuple(pair.cost, pair.row, pair.column);
  });
  std::vector<bool> is_taken(columns, false);
  for (const PossiblePair& pair : pairs) {
    if (column_of[pair.row] || is_taken[pair.column]) continue;
    column_of[pair.row] = pair.column;
    is_taken[pair.column] = true;
  }
}

void take_least_sum(const std::vector<PossiblePair>& pairs, double cost_of_none, Given& column_of) {
  Numbers row_numbers, column_numbers;
  for (const PossiblePair& pair : pairs) {
    row_numbers.of(pair.row);
    column_numbers.of(pair.column);
  }
  // Every row may also have a column of its own that stands for none.
  const auto own = static_cast<Eigen::Index>(column_numbers.names().size());
  const auto count = static_cast<Eigen::Index>(row_numbers.names().size());
  const double never = cost_of_none * static_cast<double>(count + 1) + 1.0;
  Eigen::MatrixXd costs = Eigen::MatrixXd::Constant(count, own + count, never);
  costs.rightCols(count).diagonal().setConstant(cost_of_none);
  for (const PossiblePair& pair : pairs) {
    costs(static_cast<Eigen::Index>(row_numbers.of(pair.row)),
          static_cast<Eigen::Index>(column_numbers.of(pair.column))) = pair.cost;
  }
  const std::vector<std::size_t> found = LeastSum(costs).columns();
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool is_real = found[i] < column_numbers.names().size();
    if (is_real) column_of[row_numbers.names()[i]] = column_numbers.names()[found[i]];
  }
}

std::size_t rows_of(const std::vector<PossiblePair>& pairs) {
  std::set<std::size_t> rows;
  for (const PossiblePair& pair : pairs) rows.insert(pair.row);
  return rows.size();
}

}  // namespace

Given assign(std::size_t rows, std::size_t columns, const std::vector<PossiblePair>& pairs,
             double cost_of_none) {
  constexpr std::size_t kMostRows = 100;
  Given column_of(rows);
  for (const std::vector<PossiblePair>& group : in_groups(rows, columns, pairs)) {
    if (group.size() == 1) {
      column_of[group.front().row] = group.front().column;
    } else if (rows_of(group) > kMostRows) {
      take_cheapest(group, columns, column_of);
    } else {
      take_least_sum(group, cost_of_none, column_of);
    }
  }
  return column_of;
}

}  // namespace roadbed::planning::tracking
