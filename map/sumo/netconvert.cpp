#include "roadbed/map/sumo/netconvert.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/storage/output_file.h"

namespace roadbed::map::sumo {
namespace {

/// A new folder, for as long as it is used.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::error_code fault;
    std::string name = (std::filesystem::temp_directory_path(fault) / "roadbed-XXXXXX").string();
    if (fault || ::mkdtemp(name.data()) == nullptr) refuse_write(name);
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;  // what is left is in the system's folder for such files
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string operator/(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::string program() {
  const char* home = std::getenv("SUMO_HOME");
  if (home == nullptr || *home == '\0') return "netconvert";
  const std::filesystem::path own = std::filesystem::path(home) / "bin/netconvert";
  std::error_code fault;
  return std::filesystem::exists(own, fault) ? own.string() : "netconvert";
}

[[noreturn]] void refuse(const std::string& found, const std::string& remedy) {
  throw InputError({.file = "netconvert",
                    .found = found,
                    .needed = "SUMO's netconvert for a .net.xml",
                    .remedy = remedy + ", or write its plain files: -o x.nod.xml"});
}

// Its exit status; what it prints goes to a file.
int run(std::vector<std::string> words, const std::string& log) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = 0;
  const int fault =
      ::posix_spawnp(&child, words.front().c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (fault == ENOENT) {
    refuse("it is neither in $SUMO_HOME/bin nor on PATH",
           "install SUMO (apt install sumo, or pip install eclipse-sumo)");
  }
  if (fault != 0) refuse(std::generic_category().message(fault), "check its installation");
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// The rest of each line that begins so.
std::vector<std::string> lines_with(const std::string& text, const std::string& start) {
  std::vector<std::string> found;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    // Where SUMO is installed is nothing about the map.
    const bool is_about_map = line.find("SUMO_HOME") == std::string::npos;
    if (line.starts_with(start) && is_about_map) found.push_back(line.substr(start.size()));
    at = end + 1;
  }
  return found;
}

// The comment before the first element says when and in which folder the net was made.
std::string without_comment(std::string net) {
  const std::size_t root = net.find("<net "), from = net.find("<!--");
  if (root == std::string::npos || from > root) return net;
  const std::size_t to = net.rfind("-->", root);
  if (to != std::string::npos) net.replace(from, to + 3 - from, "<!-- roadbed, netconvert -->");
  return net;
}

}  // namespace

ConvertedNet run_netconvert(const SumoFiles& files) {
  const ScratchFolder folder;
  const std::array<std::pair<const char*, const std::string*>, 5> inputs = {
      {{"net.nod.xml", &files.nodes},
       {"net.edg.xml", &files.edges},
       {"net.con.xml", &files.connections},
       {"net.tll.xml", &files.traffic_lights},
       {"net.netccfg", &files.configuration}}};
  for (const auto& [name, bytes] : inputs) write_output(folder / name, *bytes, false);
  const int status =
      run({program(), "-c", folder / "net.netccfg", "--xml-validation", "never"}, folder / "log");
  std::ifstream printed(folder / "log");
  const std::string log(std::istreambuf_iterator<char>(printed), {});
  if (status != 0) {
    const std::vector<std::string> errors = lines_with(log, "Error: ");
    refuse(errors.empty() ? "it ended with status " + std::to_string(status) : errors.front(),
           "check its version");
  }
  return {without_comment(read_file(folder / "net.net.xml")), lines_with(log, "Warning: ")};
}

}  // namespace roadbed::map::sumo
