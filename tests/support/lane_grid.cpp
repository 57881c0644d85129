#include "roadbed/tests/support/lane_grid.h"

#include <array>
#include <random>

namespace roadbed::tests {
namespace {

using planning::NetworkLane;
using planning::RouteNetwork;
using planning::Turn;

constexpr double kBlock_m = 100.0, kHalf_m = 10.0, kLane_m = 3.5;
const std::array<Eigen::Vector2d, 4> kAlong = {Eigen::Vector2d{1, 0}, Eigen::Vector2d{0, 1},
                                               Eigen::Vector2d{-1, 0}, Eigen::Vector2d{0, -1}};

class Grid {
 public:
  Grid(int columns, int rows, unsigned seed)
      : columns_(columns), rows_(rows), random_(seed), in_(crossings()), out_(crossings()) {}

  RouteNetwork build() && {
    for (int y = 0; y < rows_; ++y) {
      for (int x = 0; x < columns_; ++x) {
        for (std::size_t way = 0; way < 4; ++way) add_road(x, y, way);
      }
    }
    for (std::size_t crossing = 0; crossing < crossings(); ++crossing) add_turns(crossing);
    add_windows();
    for (const auto& links : links_) {
      network_.successors.items.insert(network_.successors.items.end(), links.begin(), links.end());
      network_.successors.end_list();
    }
    return std::move(network_);
  }

 private:
  struct Arm {
    std::size_t way;  ///< direction of travel
    std::uint32_t left, right;
  };

  std::size_t crossings() const { return static_cast<std::size_t>(columns_ * rows_); }
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * columns_ + x); }

  std::uint32_t add_lane(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double length_m,
                         double limit_mps, Turn turn) {
    NetworkLane lane;
    lane.length_m = length_m;
    lane.start_in_map = from;
    lane.end_in_map = to;
    lane.users = map::Participants::vehicles();
    lane.turn = turn;
    network_.lanes.push_back(lane);
    network_.speeds.items.push_back({length_m, limit_mps, 0.0});
    network_.speeds.end_list();
    links_.emplace_back();
    return static_cast<std::uint32_t>(network_.lanes.size()) - 1;
  }

  void join(std::uint32_t left, std::uint32_t right) {
    network_.lanes[left].right = right;
    network_.lanes[right].left = left;
  }

  void add_windows() {
    for (const NetworkLane& lane : network_.lanes) {
      if (lane.left != planning::kNoLane)
        network_.left_windows.items.push_back({0.0, lane.length_m});
      network_.left_windows.end_list();
      if (lane.right != planning::kNoLane) {
        network_.right_windows.items.push_back({0.0, lane.length_m});
      }
      network_.right_windows.end_list();
    }
  }

  void add_road(int x, int y, std::size_t way) {
    const int to_x = x + static_cast<int>(kAlong[way].x()),
              to_y = y + static_cast<int>(kAlong[way].y());
    if (to_x < 0 || to_y < 0 || to_x >= columns_ || to_y >= rows_) return;
    const Eigen::Vector2d along = kAlong[way], right(along.y(), -along.x());
    const double piece_m = 0.5 * kBlock_m - kHalf_m;
    const double limit_mps = std::uniform_real_distribution<double>(8.0, 17.0)(random_);
    Eigen::Vector2d at = kBlock_m * Eigen::Vector2d(x, y) + kHalf_m * along;
    std::array<std::uint32_t, 2> before{};
    for (int piece = 0; piece < 2; ++piece) {
      std::array<std::uint32_t, 2> lanes{};
      for (std::size_t i = 0; i < 2; ++i) {
        const Eigen::Vector2d from = at + (0.5 + static_cast<double>(i)) * kLane_m * right;
        lanes[i] = add_lane(from, from + piece_m * along, piece_m, limit_mps, Turn::none);
        if (piece > 0) links_[before[i]].push_back(lanes[i]);
      }
      join(lanes[0], lanes[1]);
      if (piece == 0) out_[index(x, y)].push_back({way, lanes[0], lanes[1]});
      before = lanes;
      at += piece_m * along;
    }
    in_[index(to_x, to_y)].push_back({way, before[0], before[1]});
  }

  void add_turn(std::uint32_t from, std::uint32_t to, Turn turn) {
    const Eigen::Vector2d a = network_.lanes[from].end_in_map, b = network_.lanes[to].start_in_map;
    const double length_m = (b - a).norm() * (turn == Turn::straight ? 1.0 : 1.1);
    const std::uint32_t lane = add_lane(a, b, length_m, turn == Turn::straight ? 14.0 : 6.0, turn);
    links_[from].push_back(lane);
    links_[lane].push_back(to);
  }

  void add_turns(std::size_t crossing) {
    for (const Arm& in : in_[crossing]) {
      for (const Arm& out : out_[crossing]) {
        const std::size_t bend = (out.way + 4 - in.way) % 4;
        if (bend == 0) {
          add_turn(in.left, out.left, Turn::straight);
          add_turn(in.right, out.right, Turn::straight);
        } else if (bend == 1) {
          add_turn(in.left, out.left, Turn::left);
        } else if (bend == 3) {
          add_turn(in.right, out.right, Turn::right);
        } else {
          add_turn(in.left, out.left, Turn::u_turn);
        }
      }
    }
  }

  int columns_, rows_;
  std::mt19937 random_;
  RouteNetwork network_;
  std::vector<std::vector<std::uint32_t>> links_;
  std::vector<std::vector<Arm>> in_, out_;
};

}  // namespace

RouteNetwork lane_grid(int columns, int rows, unsigned seed) {
  return Grid(columns, rows, seed).build();
}

}  // namespace roadbed::tests
