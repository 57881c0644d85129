#include "roadbed/tools/report/report.h"

namespace roadbed::tools::inline report {

Tone tone_of(planning::Verdict verdict) {
  if (verdict == planning::Verdict::clear) return Tone::good;
  return verdict == planning::Verdict::conflict ? Tone::bad : Tone::open;
}

}  // namespace roadbed::tools::report
