// Runs a fuzz target without libFuzzer: on its seeds, and on COUNT inputs that are made from them
// by random number, the same ones every time. It knows nothing of coverage, so it finds less than
// .ci/nightly does; it needs no clang.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

std::vector<std::string> seeds_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> seeds;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return seeds;
}

class Mutator {
 public:
  explicit Mutator(std::vector<std::string> seeds) : seeds_(std::move(seeds)) {}

  std::string next() {
    std::string bytes = seed();
    for (std::size_t change = 0, changes = 1 + below(4); change < changes; ++change) {
      alter(bytes);
    }
    return bytes;
  }

 private:
  void alter(std::string& bytes) {
    const std::size_t at = below(bytes.size() + 1);
    const std::size_t length = std::min(below(16) + 1, bytes.size() - at);
    switch (below(6)) {
      case 0:
        bytes.resize(at);
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, bytes.substr(below(bytes.size() + 1), 64));
        break;
      case 3:
        bytes.replace(at, length, number());
        break;
      case 4:
        bytes.replace(at, length, splice());
        break;
      default:
        std::generate_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), length,
                        [&] { return static_cast<char>(below(256)); });
    }
  }

  std::string number() {
    static const std::vector<std::string> numbers = {
        "0", "-1", "nan", "-inf", "1e300", "1e-300", "4294967296", "-9223372036854775808", "1e9"};
    return numbers[below(numbers.size())];
  }

  std::string splice() {
    const std::string& other = seed();
    return other.substr(below(other.size() + 1), below(128));
  }

  const std::string& seed() { return seeds_[below(seeds_.size())]; }
  std::size_t below(std::size_t count) { return random_() % count; }

  std::vector<std::string> seeds_;
  std::mt19937_64 random_{1};
};

void run(const std::string& bytes) {
  const std::vector<std::uint8_t> exact(bytes.begin(), bytes.end());  // its end is watched
  LLVMFuzzerTestOneInput(exact.data(), exact.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "Usage: %s FOLDER COUNT\n", argv[0]);
    return 2;
  }
  const std::vector<std::string> seeds = seeds_in(argv[1]);
  if (seeds.empty()) {
    std::fprintf(stderr, "%s: no seeds\n", argv[1]);
    return 2;
  }
  for (const std::string& seed : seeds) run(seed);
  Mutator mutator(seeds);
  for (long left = std::stol(argv[2]); left > 0; --left) run(mutator.next());
  return 0;
}
