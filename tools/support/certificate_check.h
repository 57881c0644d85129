#pragma once

#include <filesystem>
#include <ostream>

#include "roadbed/tools/support/inputs.h"

namespace roadbed::tools {

/// Whether every claim of a certificate holds, by brute force; what does not is printed. Empty
/// paths stand for the files that the certificate names.
/// @throws InputError if a file is unusable.
bool check_certificate_file(const std::filesystem::path& certificate,
                            const std::filesystem::path& occupancy,
                            const std::filesystem::path& trajectory,
                            const std::filesystem::path& obstacles, bool json, const Inputs& inputs,
                            std::ostream& out);

}  // namespace roadbed::tools
