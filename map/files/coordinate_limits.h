#pragma once

namespace roadbed::map::inline files {

/// The largest |x|, |y| and |z| of a place on a map [m]: what is beyond is a slip, and squares of
/// it lose the millimetres.
inline constexpr double kFarthestM = 1e8, kHighestM = 1e5;

}  // namespace roadbed::map::files
