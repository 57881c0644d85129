// What a symbol of an arithmetic decoder takes, of random bytes: one decoder, or several in turn,
// which do not wait for each other. Reads as symbols per second.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/laz/arithmetic_decoder.h"

namespace roadbed::map {
namespace {

std::string random_bytes(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::string bytes(std::size_t{8} << 20, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random() & 0xffu);
  return bytes;
}

template <std::uint32_t kOf>
void laz_symbols(benchmark::State& state) {
  constexpr int kSymbols = 1'000'000;
  const auto decoders = static_cast<std::uint32_t>(state.range(0));
  std::vector<std::string> bytes;
  for (std::uint32_t i = 0; i < decoders; ++i) bytes.push_back(random_bytes(i));
  for (auto _ : state) {
    std::vector<ArithmeticDecoder> from(bytes.begin(), bytes.end());
    std::vector<SymbolModel<kOf>> models(decoders);
    std::uint32_t sum = 0;
    for (int i = 0; i < kSymbols; ++i) {
      for (std::uint32_t k = 0; k < decoders; ++k) sum += from[k].symbol(models[k]);
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * kSymbols * decoders);
}
BENCHMARK(laz_symbols<16>)->Arg(1)->Arg(2)->Arg(4)->ArgName("decoders");
BENCHMARK(laz_symbols<33>)->Arg(1)->Arg(2)->Arg(4)->ArgName("decoders");
BENCHMARK(laz_symbols<256>)->Arg(1)->Arg(2)->Arg(4)->ArgName("decoders");

}  // namespace
}  // namespace roadbed::map
