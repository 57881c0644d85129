#include "roadbed/tools/commands/maps/edit_output.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <iostream>

#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/formats.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/cli/output_format.h"

namespace roadbed::tools::inline commands::inline maps {

void refuse_other_format(const std::filesystem::path& file, const std::string& map_bytes) {
  const map::Format* own = map::format_of(map_bytes);
  const std::string suffix = map::format_suffix(file);
  const bool is_any_xml = suffix == ".xml";
  if (own == nullptr || is_any_xml || map::is_standard_stream(file)) return;
  for (const map::Format& format : map::formats()) {
    if (!format.is_written() || format.suffix != suffix || suffix == own->suffix) continue;
    throw map::OutputError({.file = file.string(),
                            .found = fmt::format("the map is {}, not {}", own->name, format.name),
                            .needed = std::string(own->suffix),
                            .remedy = "rename the output; roadbed convert makes one of the other"});
  }
}

void EditOutput::declare(Arguments& arguments) {
  arguments.add("-o,--output", file_, "The map, in the format of the input; - for standard output")
      .required()
      .writes("");
  arguments.flag("-f,--force", force_, "Replace the output if it exists");
  arguments.flag("-j,--json", json_, "Print one JSON document");
}

std::string EditOutput::fault() const {
  return standard_output_fault(file_, false, "", json_ ? "--json" : "");
}

void EditOutput::check() const { map::check_writable(file_, force_); }

Exit EditOutput::finish(const map::Edited& edited, const std::string& kind, const Streams& streams,
                        const CommonOptions& common, const Json& more,
                        const std::map<std::filesystem::path, std::string>& beside) const {
  const bool made = !edited.bytes.empty();
  if (made) refuse_other_format(file_, edited.bytes);
  map::OutputFiles files(force_);
  if (made) files.add(file_, edited.bytes);
  for (const auto& [file, bytes] : beside) files.add(file, bytes);
  files.commit();
  if (json_) {
    Json counts = Json::object();
    for (const auto& [what, many] : edited.counts) counts[what] = many;
    Json document = {{"roadbed_" + kind, 1},
                     {"written", made},
                     {"reason", made ? Json() : Json(edited.reason)},
                     {"counts", std::move(counts)},
                     {"notes", edited.notes}};
    document.update(more);
    fmt::print(streams.out, "{}\n", map::json_text(document, 2));
  }
  if (!made) fmt::print(streams.err, "roadbed: nothing is left: {}\n", edited.reason);
  if (made && !json_ && !common.quiet) {
    fmt::print(streams.err, "{}: {} bytes\n", output_name(file_), edited.bytes.size());
    for (const auto& [what, many] : edited.counts) fmt::print(streams.err, "{} {}\n", many, what);
    for (const std::string& note : edited.notes) fmt::print(streams.err, "note: {}\n", note);
  }
  return made ? Exit::ok : Exit::no;
}

}  // namespace roadbed::tools::commands::maps
