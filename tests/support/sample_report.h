#pragma once

#include "roadbed/tools/report/report.h"

namespace roadbed::tests {

/// The road of the sample.
map::RoadMapParts sample_road();

/// A made-up drive for tests of the report: 40 s on a bent two-lane road, past a parked car and
/// behind a slower one, with plans, plots, events, decisions and checks.
tools::ReportInput sample_report();

}  // namespace roadbed::tests
