#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/octree/occupancy_merge.h"
#include "roadbed/tools/cli/arguments.h"
#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline commands::inline occupancy {

/// Occupancies that a command reads, octrees or folders of tiles.
class OccupancyInputs {
 public:
  /// @throws InputError if one is unusable.
  explicit OccupancyInputs(const std::vector<std::filesystem::path>& files);

  const map::OccupancySource& front() const { return *occupancies_.front(); }

  std::vector<map::NamedOccupancy> sources() const;

  /// Of the tiles of the first that has some.
  std::optional<std::int64_t> side_cells() const;

 private:
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<map::OccupancySource>> occupancies_;
};

/// The octree or the folder of tiles that a command makes of others: `-o`, `--format`, `--tiles`,
/// `--force`.
class OccupancyOutput {
 public:
  void declare(Arguments& arguments);

  /// What is wrong with its name.
  std::string fault() const;

  /// Before the work begins. @throws OutputError if it cannot be written.
  void check() const;

  /// Writes it, and says what it holds. The answer is no if that is nothing.
  /// @throws InputError, OutputError
  Exit write(const map::OccupancyMerge& merge, const OccupancyInputs& inputs,
             const Streams& streams, const CommonOptions& common) const;

 private:
  std::string suffix() const;
  std::int64_t side_cells(const OccupancyInputs& inputs) const;
  std::string write_octree(const map::OccupancyMerge& merge, std::size_t& nodes) const;
  std::string write_tiles(const map::OccupancyMerge& merge, std::int64_t side_cells,
                          std::size_t& nodes) const;

  std::filesystem::path file_;
  std::string format_;
  std::optional<double> tiles_m_;
  bool force_ = false;
};

}  // namespace roadbed::tools::commands::occupancy
