#include "roadbed/map/storage/output_place.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

namespace roadbed::map::inline storage {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kMostNames = 1000;

std::string cause() { return std::strerror(errno); }

/// As Linux does it where fs.protected_symlinks is set: a link in a sticky folder that all may
/// write to leads only those who made it, or made the folder.
void refuse_planted_link(const fs::path& link, const struct stat& status) {
  struct stat folder {};
  if (::stat(folder_around(link).c_str(), &folder) != 0) refuse_write(link);
  const bool is_shared = (folder.st_mode & S_ISVTX) != 0 && (folder.st_mode & S_IWOTH) != 0;
  if (!is_shared || status.st_uid == ::geteuid() || status.st_uid == folder.st_uid) return;
  refuse_output(link, "is a link that another user made in a shared folder",
                "choose a folder of your own");
}

/// Removes a name that nobody has locked. Returns whether it is free now.
bool remove_if_abandoned(const fs::path& name) {
  const int descriptor = ::open(name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return errno == ENOENT;
  std::error_code error;
  const bool is_ours =
      ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && is_still_there(name, descriptor);
  if (is_ours) fs::remove_all(name, error);
  ::close(descriptor);
  return is_ours && !error;
}

}  // namespace

void refuse_output(const fs::path& output, const std::string& found, const std::string& remedy) {
  throw OutputError({.file = output.string(), .found = found, .remedy = remedy});
}

void refuse_write(const fs::path& output) {
  refuse_output(output, "cannot be written: " + cause(),
                "free some space or choose another folder");
}

void refuse_input(const fs::path& output, const std::vector<fs::path>& inputs) {
  std::error_code error;
  for (const fs::path& input : inputs) {
    if (!fs::equivalent(output, input, error)) continue;
    refuse_output(input, "is an input, which the output would replace",
                  "choose another place for the output");
  }
}

OutputPlace look_at_output(const fs::path& output) {
  const auto refuse_look = [&] {
    refuse_output(output, "cannot be looked at: " + cause(), "choose a folder of your own");
  };
  OutputPlace place{output, {}};
  struct stat status {};
  if (::lstat(output.c_str(), &status) != 0) {
    if (errno != ENOENT) refuse_look();
    return place;
  }
  if (S_ISLNK(status.st_mode)) {
    refuse_planted_link(output, status);
    if (::stat(output.c_str(), &status) != 0) {
      if (errno != ENOENT) refuse_look();
      refuse_output(output, "is a link that leads nowhere", "remove it");
    }
    std::error_code error;
    const fs::path target = fs::canonical(output, error);
    if (!error) place.path = target;  // /dev/stdout leads to what has no path
  }
  place.there = status;
  return place;
}

fs::path folder_around(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

fs::path name_in_the_making(const fs::path& output, unsigned number) {
  constexpr std::size_t longest = 200;  // a name may have 255 bytes
  return folder_around(output) /
         fmt::format(".{}.roadbed-{}", output.filename().string().substr(0, longest), number);
}

void remove_abandoned(const fs::path& output) {
  struct stat status {};
  for (unsigned number = 0; number < kMostNames; ++number) {
    const fs::path name = name_in_the_making(output, number);
    if (::lstat(name.c_str(), &status) != 0) return;
    remove_if_abandoned(name);
  }
}

fs::path take_name(const fs::path& output, const std::function<bool(const fs::path&)>& make) {
  for (unsigned number = 0; number < kMostNames; ++number) {
    fs::path name = name_in_the_making(output, number);
    if (make(name)) return name;
    if (errno == EEXIST && remove_if_abandoned(name) && make(name)) return name;
    if (errno != EEXIST && errno != EAGAIN) break;
  }
  refuse_output(output, "cannot be written: " + cause(), "choose a folder that you may write to");
}

bool is_still_there(const fs::path& name, int descriptor) {
  struct stat opened {
  }, named{};
  return ::fstat(descriptor, &opened) == 0 && ::lstat(name.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

bool lock_in_the_making(int descriptor) {
  // Where a file system knows no locks, nobody takes what is there for abandoned.
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

void keep_permissions(int descriptor, const struct stat& old, const fs::path& output) {
  struct stat now {};
  if (::fstat(descriptor, &now) != 0) refuse_write(output);
  const bool is_same_owner = now.st_uid == old.st_uid && now.st_gid == old.st_gid;
  const bool is_same_group = is_same_owner || ::fchown(descriptor, old.st_uid, old.st_gid) == 0 ||
                             ::fchown(descriptor, static_cast<uid_t>(-1), old.st_gid) == 0;
  mode_t mode = old.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO);
  if (!is_same_group) mode &= ~static_cast<mode_t>(S_IRWXG) | (mode & S_IRWXO) << 3;
  if ((now.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO)) == mode) return;
  if (::fchmod(descriptor, mode) != 0) refuse_write(output);
}

bool rename_to_free_name(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  // A file system without it: a second name for a file, where it can have one, else a look.
  if (::link(from.c_str(), to.c_str()) == 0) return ::unlink(from.c_str()) == 0;
  if (errno == EEXIST) return false;
  struct stat status {};
  if (::lstat(to.c_str(), &status) == 0) {
    errno = EEXIST;
    return false;
  }
  return ::rename(from.c_str(), to.c_str()) == 0;
}

void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // the file itself is synced; some systems refuse to open folders
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace roadbed::map::storage
