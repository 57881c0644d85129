#include "roadbed/map/storage/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "roadbed/map/files/read_file.h"

namespace roadbed::map::inline storage {
namespace {

[[noreturn]] void refuse_existing(const std::filesystem::path& file) {
  refuse_output(file, "exists already", "give --force to replace it");
}

/// Replaced by a file, a device such as /dev/null would be lost to all programs.
OutputPlace look_at_file(const std::filesystem::path& file) {
  OutputPlace place = look_at_output(file);
  if (!place.there) return place;
  if (S_ISDIR(place.there->st_mode)) refuse_output(file, "is a folder", "name a file in it");
  if (!S_ISREG(place.there->st_mode)) {
    refuse_output(file, "is a device or a pipe, which a file would replace", "name a file");
  }
  return place;
}

std::string name_of_descriptor(int descriptor) {
  return fmt::format("/proc/self/fd/{}", descriptor);
}

/// A file without a name; negative where there are none, or none that can be named later.
int open_nameless(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor < 0 || ::access(name_of_descriptor(descriptor).c_str(), F_OK) == 0) {
    return descriptor;
  }
  ::close(descriptor);
  return -1;
}

}  // namespace

void check_writable(const std::filesystem::path& file, bool force) {
  if (is_standard_stream(file)) return;
  if (!is_folder(folder_around(file))) {
    refuse_output(file, "cannot be written: its folder does not exist", "make the folder first");
  }
  const OutputPlace place = look_at_file(file);
  if (place.there && !force) refuse_existing(file);
  if (::access(folder_around(place.path).c_str(), W_OK) != 0) {
    refuse_output(file, std::string("cannot be written: ") + std::strerror(errno),
                  "choose a folder that you may write to");
  }
}

OutputFile::OutputFile(const std::filesystem::path& file, bool force)
    : place_(look_at_file(file)), force_(force) {
  if (place_.there && !force_) refuse_existing(file);
  remove_abandoned(place_.path);
  descriptor_ = open_nameless(folder_around(place_.path));
  if (descriptor_ >= 0) return;
  hidden_ = take_name(place_.path, [this](const std::filesystem::path& name) {
    // Not by mkstemp: its files have rights of their own, and the process's mask, which says what
    // they should be, can only be read by changing it under the feet of other threads.
    descriptor_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 || lock_in_the_making(descriptor_)) return descriptor_ >= 0;
    ::close(std::exchange(descriptor_, -1));
    errno = EAGAIN;
    return false;
  });
}

OutputFile::~OutputFile() {
  if (!hidden_.empty()) ::unlink(hidden_.c_str());
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(std::uint64_t offset, std::string_view bytes) {
  constexpr std::uint64_t kAhead = std::uint64_t{1} << 21;
  const bool fills_a_piece = offset / kAhead != (offset + bytes.size()) / kAhead;
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written == 0) errno = ENOSPC;
    if (written <= 0) refuse_write(place_.path);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
  // On its way to the disk while the next piece is made, so that the end has less to wait for.
  if (fills_a_piece) ::sync_file_range(descriptor_, 0, 0, SYNC_FILE_RANGE_WRITE);
}

void OutputFile::sync() {
  if (::fsync(descriptor_) != 0) refuse_write(place_.path);
}

void OutputFile::commit() {
  place_.there = look_at_file(place_.path).there;
  if (place_.there && !force_) refuse_existing(place_.path);
  if (place_.there) keep_permissions(descriptor_, *place_.there, place_.path);
  sync();
  if (place_.there || !put_at_free_name()) replace();
  hidden_.clear();
  sync_folder(folder_around(place_.path));
}

bool OutputFile::give_name(const std::filesystem::path& name) const {
  return ::linkat(AT_FDCWD, name_of_descriptor(descriptor_).c_str(), AT_FDCWD, name.c_str(),
                  AT_SYMLINK_FOLLOW) == 0;
}

/// Returns false where something is there by now that may be replaced.
bool OutputFile::put_at_free_name() {
  if (hidden_.empty() ? give_name(place_.path) : rename_to_free_name(hidden_, place_.path)) {
    return true;
  }
  if (errno != EEXIST) refuse_write(place_.path);
  if (!force_) refuse_existing(place_.path);
  return false;
}

/// A file without a name cannot take the place of another: it has a hidden one for that moment.
void OutputFile::replace() {
  if (hidden_.empty()) {
    lock_in_the_making(descriptor_);
    hidden_ = take_name(place_.path, [this](const auto& name) { return give_name(name); });
  }
  if (::rename(hidden_.c_str(), place_.path.c_str()) != 0) refuse_write(place_.path);
}

void write_to_standard_output(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) refuse_write("standard output");
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void write_output(const std::filesystem::path& file, std::string_view bytes, bool force) {
  if (is_standard_stream(file)) return write_to_standard_output(bytes);
  OutputFile output(file, force);
  output.write(0, bytes);
  output.commit();
}

void OutputFiles::add(const std::filesystem::path& file, std::string_view bytes) {
  if (is_standard_stream(file)) {
    to_standard_output_ += bytes;
    return;
  }
  files_.push_back(std::make_unique<OutputFile>(file, force_));
  files_.back()->write(0, bytes);
}

void OutputFiles::commit() {
  for (const auto& file : files_) file->sync();
  for (const auto& file : files_) file->commit();
  if (!to_standard_output_.empty()) write_to_standard_output(to_standard_output_);
}

}  // namespace roadbed::map::storage
