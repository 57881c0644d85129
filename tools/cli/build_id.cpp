#include "roadbed/tools/cli/build_id.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstddef>
#include <cstring>
#include <string_view>

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

int read_id(dl_phdr_info* object, std::size_t, void* found) {
  std::string& id = *static_cast<std::string*>(found);
  for (int i = 0; i < object->dlpi_phnum && id.empty(); ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader says where it is as a number
    const auto* const begin = reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr);
    id = id_among({begin, segment.p_memsz});
  }
  return 1;  // the program itself comes first, and no other object is asked
}

}  // namespace

std::string version() { return ROADBED_VERSION; }

std::string release_date() { return ROADBED_RELEASED; }

std::string name_and_version() { return "roadbed " + version(); }

std::string build_id() {
  std::string id;
  ::dl_iterate_phdr(read_id, &id);
  return id;
}

}  // namespace roadbed::tools::cli
