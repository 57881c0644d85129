#pragma once

#include <string>

namespace roadbed::tools::inline cli {

/// Of the project, as "0.1.0".
std::string version();

/// When this version was released, as "2026-11-25".
std::string release_date();

/// "roadbed 0.1.0".
std::string name_and_version();

/// What the linker calls this program (ELF's note NT_GNU_BUILD_ID, a hash of what it linked), in
/// hexadecimal digits: the same for the same sources, compiler and options, another one after any
/// change of the code. Empty where the linker wrote none.
std::string build_id();

/// A hash of the build ids of all libraries that the program has loaded, with PROJ, which some
/// outputs need: SHA-256, hexadecimal. Another one after an update of any of them. Of a library
/// without a build id its bytes count.
std::string libraries_id();

}  // namespace roadbed::tools::cli
