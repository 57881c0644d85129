#include "roadbed/tools/cli/build_id.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <set>
#include <string_view>
#include <vector>

#include "roadbed/map/files/projection.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/sha256.h"

namespace roadbed::tools::inline cli {
namespace {

// Parts of a note begin at multiples of four bytes.
std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

std::string hexadecimal(std::string_view bytes) {
  std::string digits;
  for (const char byte : bytes) digits += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return digits;
}

/// The build id among the notes of a segment; empty if there is none.
std::string id_among(std::string_view notes) {
  constexpr std::string_view owner("GNU\0", 4);
  while (notes.size() >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes.data(), sizeof(note));
    const std::size_t end_of_name = sizeof(note) + padded(note.n_namesz);
    const std::size_t end = end_of_name + padded(note.n_descsz);
    if (end > notes.size()) break;
    if (note.n_type == NT_GNU_BUILD_ID && notes.substr(sizeof(note), note.n_namesz) == owner) {
      return hexadecimal(notes.substr(end_of_name, note.n_descsz));
    }
    notes.remove_prefix(end);
  }
  return {};
}

std::string id_of(const dl_phdr_info& object) {
  std::string id;
  for (int i = 0; i < object.dlpi_phnum && id.empty(); ++i) {
    const ElfW(Phdr)& segment = object.dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader says where it is as a number
    const auto* const begin = reinterpret_cast<const char*>(object.dlpi_addr + segment.p_vaddr);
    id = id_among({begin, segment.p_memsz});
  }
  return id;
}

struct Object {
  std::string file;  // empty for the program itself
  std::string id;
};

int add_object(dl_phdr_info* object, std::size_t, void* objects) {
  static_cast<std::vector<Object>*>(objects)->push_back({object->dlpi_name, id_of(*object)});
  return 0;
}

// The program itself comes first.
std::vector<Object> loaded_objects() {
  std::vector<Object> objects;
  ::dl_iterate_phdr(add_object, &objects);
  return objects;
}

std::string line_of_library(const Object& library) {
  const std::filesystem::path file = library.file;
  const std::string id = library.id.empty() ? map::sha256_of_file(file) : library.id;
  return file.filename().string() + " " + id + "\n";
}

}  // namespace

std::string version() { return ROADBED_VERSION; }

std::string release_date() { return ROADBED_RELEASED; }

std::string name_and_version() { return "roadbed " + version(); }

std::string build_id() {
  const std::vector<Object> objects = loaded_objects();
  return objects.empty() ? "" : objects.front().id;
}

std::string libraries_id() {
  map::open_projection_module();
  std::set<std::string> lines;  // where a library is, and which is loaded first, does not matter
  for (const Object& object : loaded_objects()) {
    const bool is_file = object.file.starts_with('/');  // the system's own code has no path
    if (is_file) lines.insert(line_of_library(object));
  }
  map::Sha256 sha256;
  for (const std::string& line : lines) sha256.add(line);
  return sha256.take_hex();
}

}  // namespace roadbed::tools::cli
