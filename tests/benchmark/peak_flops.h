#pragma once

namespace roadbed::benchmark_scene {

/// Fused multiply-adds in double precision that one core does now, at best [Gflop/s, two each]:
/// what a kernel's share of it is measured by. Takes about 50 ms.
double peak_gflops();

}  // namespace roadbed::benchmark_scene
