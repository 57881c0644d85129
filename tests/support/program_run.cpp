#include "roadbed/tests/support/program_run.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace roadbed::tests {
namespace {

// Standard error of a child goes to a file; standard input is empty, or comes from one.
class Redirections {
 public:
  explicit Redirections(const std::string& err, const std::string& in = "/dev/null") {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, in.c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, err.c_str(), kWrite, 0600);
  }
  ~Redirections() { posix_spawn_file_actions_destroy(&actions_); }
  Redirections(const Redirections&) = delete;
  Redirections& operator=(const Redirections&) = delete;

  void print_to(const std::string& file) {
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, file.c_str(), kWrite, 0600);
  }

  void print_to(int descriptor) {
    if (descriptor < 0) {
      posix_spawn_file_actions_addclose(&actions_, STDOUT_FILENO);
    } else {
      posix_spawn_file_actions_adddup2(&actions_, descriptor, STDOUT_FILENO);
    }
  }

  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  static constexpr int kWrite = O_WRONLY | O_CREAT | O_TRUNC;

  posix_spawn_file_actions_t actions_;
};

int wait_for(pid_t child) {
  int state = 0;
  if (::waitpid(child, &state, 0) != child) throw std::runtime_error("waitpid failed");
  return WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
}

int status_of(const std::filesystem::path& program, const std::vector<std::string>& arguments,
              const Redirections& redirections) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  std::transform(words.begin(), words.end(), std::back_inserter(argv),
                 [](std::string& word) { return word.data(); });
  argv.push_back(nullptr);

  pid_t child = 0;
  if (::posix_spawn(&child, argv.front(), redirections.get(), nullptr, argv.data(), environ) != 0) {
    throw std::runtime_error("cannot start " + words.front());
  }
  return wait_for(child);
}

ProgramRun run_reading(const std::filesystem::path& program, const std::string& input,
                       const std::vector<std::string>& arguments) {
  const TemporaryFolder streams;
  const std::string out = streams / "out", err = streams / "err";
  Redirections redirections(err, input);
  redirections.print_to(out);
  const int status = status_of(program, arguments, redirections);
  return {.status = status, .out = bytes_of(out), .err = bytes_of(err)};
}

}  // namespace

TemporaryFolder::TemporaryFolder(const std::filesystem::path& within) {
  std::string pattern = (within / "roadbed.XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string TemporaryFolder::write(std::string_view name, std::string_view bytes) const {
  const std::filesystem::path file = path_ / name;
  std::ofstream(file, std::ios::binary) << bytes;
  return file.string();
}

std::filesystem::path program_file() { return ROADBED_PROGRAM; }

ProgramRun run_roadbed(const std::vector<std::string>& arguments) {
  return run_roadbed_reading("/dev/null", arguments);
}

ProgramRun run_program(const std::filesystem::path& program,
                       const std::vector<std::string>& arguments) {
  return run_reading(program, "/dev/null", arguments);
}

ProgramRun run_roadbed_reading(const std::string& input,
                               const std::vector<std::string>& arguments) {
  return run_reading(program_file(), input, arguments);
}

ProgramRun run_roadbed_into(int descriptor, const std::vector<std::string>& arguments) {
  const TemporaryFolder streams;
  const std::string err = streams / "err";
  Redirections redirections(err);
  redirections.print_to(descriptor);
  const int status = status_of(program_file(), arguments, redirections);
  return {.status = status, .out = {}, .err = bytes_of(err)};
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> files_below(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(folder).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace roadbed::tests
