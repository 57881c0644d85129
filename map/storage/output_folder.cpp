#include "roadbed/map/storage/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>

#include "roadbed/map/storage/output_file.h"

namespace roadbed::map::inline storage {
namespace {

namespace fs = std::filesystem;

/// "drive/" is "drive".
fs::path without_slash(const fs::path& folder) {
  return folder.has_filename() || !folder.has_parent_path() ? folder : folder.parent_path();
}

OutputPlace look_at_folder(const fs::path& folder, bool force) {
  OutputPlace place = look_at_output(without_slash(folder));
  if (!place.there) return place;
  if (!S_ISDIR(place.there->st_mode)) {
    refuse_output(folder, "exists and is not a folder", "choose another place");
  }
  std::error_code error;
  const bool is_empty = fs::is_empty(place.path, error);
  if (error) refuse_output(folder, "cannot be read: " + error.message(), "choose another folder");
  if (!is_empty && !force) {
    refuse_output(folder, "holds files already", "give --force to replace them");
  }
  if (::access(place.path.c_str(), W_OK) != 0) {
    refuse_output(folder, std::string("cannot be written: ") + std::strerror(errno),
                  "choose a folder that you may write to");
  }
  place.path = fs::canonical(place.path);
  return place;
}

[[noreturn]] void refuse_made_meanwhile(const fs::path& output) {
  if (errno != EEXIST && errno != ENOTEMPTY) refuse_write(output);
  refuse_output(output, "exists already", "give --force to replace it");
}

bool is_mount(const fs::path& folder) {
  struct statx status {};
  return ::statx(AT_FDCWD, folder.c_str(), 0, STATX_TYPE, &status) == 0 &&
         (status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
}

/// Whoever works in the folder would be left in the old one.
bool holds_current_folder(const fs::path& folder) {
  std::error_code error;
  const fs::path current = fs::current_path(error);
  return !error && !current.lexically_relative(folder).native().starts_with("..");
}

bool may_be_exchanged(const OutputPlace& place) {
  if (!place.there) return true;
  if (::access(folder_around(place.path).c_str(), W_OK) != 0) return false;
  return !is_mount(place.path) && !holds_current_folder(place.path);
}

bool link_file(const fs::path& from, const fs::path& to) {
  std::error_code error;
  if (fs::exists(fs::symlink_status(to, error))) return true;
  return ::linkat(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), 0) == 0 || errno == EEXIST;
}

/// Gives what `from` holds second names in `to`, but where there is something and for what is
/// dropped. Returns false where that cannot be done.
bool carry_over(const fs::path& from, const fs::path& to,
                const std::function<bool(const std::string&)>& is_dropped) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(from, error)) {
    const fs::path target = to / entry.path().filename();
    if (entry.symlink_status().type() == fs::file_type::directory) {
      fs::create_directory(target, entry.path(), error);  // with its permissions
      if (error || !carry_over(entry.path(), target, [](const auto&) { return false; })) {
        return false;
      }
    } else if (!is_dropped(entry.path().filename().string()) && !link_file(entry.path(), target)) {
      return false;
    }
  }
  return !error;
}

/// Descriptor of the folder that is there, locked; less than 0 if somebody else keeps it locked.
int locked_folder(const fs::path& folder) {
  constexpr int kTries = 300;
  for (int i = 0; i < kTries; ++i) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return -1;
    const bool is_locked = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    if (is_locked && is_still_there(folder, descriptor)) return descriptor;
    ::close(descriptor);
    if (!is_locked) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return -1;
}

}  // namespace

void make_output_folder(const fs::path& folder, bool force) {
  const OutputPlace place = look_at_folder(folder, force);
  std::error_code error;
  if (!place.there && !fs::create_directories(place.path, error) && error) {
    refuse_output(folder, "cannot be made: " + error.message(),
                  "choose a folder that you may write to");
  }
}

OutputFolder::OutputFolder(const fs::path& folder, OutputFolderOptions options)
    : place_(look_at_folder(folder, options.force)), options_(std::move(options)) {
  check_parent();
  is_beside_ = may_be_exchanged(place_);
  remove_abandoned(name_beside_or_in());
}

fs::path OutputFolder::name_beside_or_in() const {
  return is_beside_ ? place_.path : place_.path / "files";
}

const fs::path& OutputFolder::in_the_making() {
  if (!hidden_.empty()) return hidden_;
  make_parents();
  hidden_ = take_name(name_beside_or_in(), [this](const fs::path& name) {
    if (::mkdir(name.c_str(), 0777) != 0) return false;
    descriptor_ = ::open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool is_locked = descriptor_ >= 0 && lock_in_the_making(descriptor_);
    if (is_locked && is_still_there(name, descriptor_)) return true;
    const int error = descriptor_ >= 0 ? EAGAIN : errno;  // who had the lock removes it
    if (descriptor_ >= 0) {
      ::close(std::exchange(descriptor_, -1));
    } else if (error != ENOENT) {
      ::rmdir(name.c_str());
    }
    errno = error == ENOENT ? EAGAIN : error;
    return false;
  });
  return hidden_;
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  const bool is_locked = !has_exchanged_ || old_descriptor_ >= 0;
  if (!hidden_.empty() && is_locked) fs::remove_all(hidden_, ignored);
  for (const int descriptor : {descriptor_, old_descriptor_}) {
    if (descriptor >= 0) ::close(descriptor);
  }
  for (const fs::path& parent : made_parents_) fs::remove(parent, ignored);  // if it is empty
}

/// Before the work begins: the nearest folder that is there is one that may be written to.
void OutputFolder::check_parent() const {
  if (place_.there) return;
  std::error_code error;
  fs::path above = folder_around(place_.path);
  while (above.has_parent_path() && above.has_relative_path() && !fs::exists(above, error)) {
    above = above.parent_path();
  }
  if (!fs::exists(above, error)) above = ".";
  if (::access((above / "").c_str(), W_OK | X_OK) == 0) return;
  refuse_output(place_.path, std::string("cannot be made: ") + std::strerror(errno),
                "choose a folder that you may write to");
}

void OutputFolder::make_parents() {
  std::error_code error;
  const fs::path parent = folder_around(place_.path);
  for (fs::path above = parent; !above.empty() && !fs::exists(above, error);
       above = above.parent_path()) {
    made_parents_.push_back(above);
  }
  if (!fs::create_directories(parent, error) && error) {
    refuse_output(place_.path, "cannot be made: " + error.message(),
                  "choose a folder that you may write to");
  }
}

void OutputFolder::write(std::string_view name, std::string_view bytes) {
  write_output(in_the_making() / name, bytes, false);
  names_.emplace_back(name);
}

void OutputFolder::commit() {
  place_.there = look_at_folder(place_.path, options_.force).there;
  check_inputs();
  in_the_making();
  if (place_.there) keep_permissions_of_files();
  sync_folder(hidden_);
  is_beside_ ? exchange() : put_files_one_by_one();
  sync_folder(folder_around(place_.path));
  made_parents_.clear();
}

void OutputFolder::check_inputs() const {
  for (const std::string& name : names_) refuse_input(place_.path / name, options_.inputs);
}

void OutputFolder::keep_permissions_of_files() const {
  for (const std::string& name : names_) {
    struct stat old {};
    if (::lstat((place_.path / name).c_str(), &old) != 0 || !S_ISREG(old.st_mode)) continue;
    const int file = ::open((hidden_ / name).c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) refuse_write(place_.path / name);
    try {
      keep_permissions(file, old, place_.path / name);
    } catch (...) {
      ::close(file);
      throw;
    }
    ::close(file);
  }
}

/// Puts the hidden folder in the place of the old one, which is removed in the end.
void OutputFolder::exchange() {
  if (place_.there) keep_permissions(descriptor_, *place_.there, place_.path);
  if (!options_.force) {
    // An empty folder may be renamed over, another one not.
    const bool is_put = place_.there ? ::rename(hidden_.c_str(), place_.path.c_str()) == 0
                                     : rename_to_free_name(hidden_, place_.path);
    if (!is_put) refuse_made_meanwhile(place_.path);
    hidden_.clear();
    return;
  }
  if (!place_.there && rename_to_free_name(hidden_, place_.path)) {
    hidden_.clear();
    return;
  }
  if (!carry_over(place_.path, hidden_, options_.is_dropped) || !exchange_names()) {
    return put_files_one_by_one();
  }
  // What others put into the old one meanwhile goes with it, or all stays as it was.
  if (carry_over(hidden_, place_.path, options_.is_dropped)) return;
  const bool is_back = exchange_names();
  const fs::path kept = is_back ? place_.path : std::exchange(hidden_, {});
  refuse_output(kept, "holds files that others made meanwhile and that could not be kept",
                "look at them, and run again");
}

/// Only who has the folder locked that is in the place exchanges it: one writer after the other,
/// and under its hidden name the old one is not taken for abandoned.
bool OutputFolder::exchange_names() {
  if (old_descriptor_ < 0) old_descriptor_ = locked_folder(place_.path);
  if (::renameat2(AT_FDCWD, hidden_.c_str(), AT_FDCWD, place_.path.c_str(), RENAME_EXCHANGE) != 0) {
    return false;
  }
  has_exchanged_ = !has_exchanged_;
  return true;
}

void OutputFolder::put_files_one_by_one() {
  std::error_code error;
  for (const std::string& name : names_) {  // before the first is replaced
    if (!fs::is_directory(fs::symlink_status(place_.path / name, error))) continue;
    refuse_output(place_.path / name, "is a folder", "remove it, or choose another place");
  }
  for (const std::string& name : names_) {
    const fs::path made = hidden_ / name, file = place_.path / name;
    const bool is_put = options_.force ? ::rename(made.c_str(), file.c_str()) == 0
                                       : rename_to_free_name(made, file);
    if (!is_put) refuse_made_meanwhile(file);
  }
  std::vector<fs::path> dropped;
  for (const fs::directory_entry& entry : fs::directory_iterator(place_.path, error)) {
    const std::string name = entry.path().filename().string();
    const bool is_new = std::ranges::find(names_, name) != names_.end();
    if (!is_new && entry.is_regular_file(error) && options_.is_dropped(name)) {
      dropped.push_back(entry.path());
    }
  }
  for (const fs::path& file : dropped) fs::remove(file, error);
  sync_folder(place_.path);
}

}  // namespace roadbed::map::storage
