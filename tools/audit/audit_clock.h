#pragma once

#include <filesystem>
#include <span>

namespace roadbed::tools::inline audit {

/// The time step of CommonRoad that is second 0 of a drive: what its scenario records, obstacles
/// and lights, is looked at in that time.
///
/// Of a CommonRoad solution it is time step 0: its states keep their absolute steps. Of any other
/// drive, a swept one too, it is the initial step of the scenario's planning problem, as `simulate`
/// writes drives; time step 0 where there is none.
///
/// @param drive  its file; empty: swept.
/// @param files  that may be the scenario: the first of CommonRoad's with a planning problem is.
///               Empty names are none.
/// @throws InputError if a file is unusable.
long second_0_step(const std::filesystem::path& drive,
                   std::span<const std::filesystem::path> files);

}  // namespace roadbed::tools::audit
