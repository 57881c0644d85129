#pragma once

namespace roadbed::map::inline files {

/// Of a place on a map: the largest |x| and |y|, and the largest |z| [m]. What is beyond is a slip.
inline constexpr double kFarthestM = 1e8, kHighestM = 1e5;

}  // namespace roadbed::map::files
