#include "roadbed/map/files/unusable_log.h"

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline files {

void refuse_unusable_log(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("#ROSBAG ")) {
    throw InputError({.file = name,
                      .found = "is a bag of ROS 1",
                      .needed = "a log of ROS 2, or MCAP",
                      .remedy = "convert it: rosbags-convert --src " + name + " --dst FOLDER"});
  }
  if (bytes.size() >= 8 && bytes.substr(1, 4) == "MCAP") {
    throw InputError({.file = name,
                      .place = "byte 0",
                      .found = "is MCAP of another version, or damaged",
                      .needed = "MCAP 0",
                      .remedy = "copy it anew, or let mcap recover what there is"});
  }
}

}  // namespace roadbed::map::files
