#include "roadbed/map/logs/message_unpacker.h"

#include <fmt/format.h>

#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/unpack.h"
#include "roadbed/map/logs/unpack_block.h"

namespace roadbed::map::inline logs {

MessageUnpacker::MessageUnpacker(std::string file, std::uint64_t file_bytes)
    : file_(std::move(file)), file_bytes_(file_bytes), left_(most_unpacked_in_all(file_bytes)) {}

// CDR never begins as Zstandard does; messages in other encodings may.
std::string_view MessageUnpacker::unpacked(const LogTopic& topic, std::string_view bytes,
                                           const std::string& place) {
  if (topic.encoding != "cdr" || !is_packed(bytes)) return bytes;
  message_ =
      files::unpacked(bytes, file_ + ":" + place, files::most_unpacked_of_rows(file_bytes_) / 2);
  if (left_.spend(message_.size())) return message_;
  throw InputError(
      {.file = file_,
       .place = place,
       .found = fmt::format("messages of more than {} bytes", most_unpacked_in_all(file_bytes_)),
       .needed = "fewer",
       .remedy = "copy or record the log anew"});
}

}  // namespace roadbed::map::logs
