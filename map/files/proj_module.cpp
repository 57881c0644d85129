#include "roadbed/map/files/proj_module.h"

#include <dlfcn.h>
#include <proj.h>
#include <proj_experimental.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <regex>
#include <string>

namespace {

struct Destroy {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
  void operator()(PJ* object) const { proj_destroy(object); }
};
using Context = std::unique_ptr<PJ_CONTEXT, Destroy>;
using Object = std::unique_ptr<PJ, Destroy>;

int say(const std::string& text, char* message, std::size_t size) {
  if (size == 0) return 1;
  const std::size_t length = std::min(size - 1, text.size());
  std::memcpy(message, text.data(), length);
  message[length] = '\0';
  return 1;
}

/// PROJ takes any other text for a name and looks for one like it: "WGS" would be WGS 72.
bool is_definition(const std::string& crs) {
  static const std::regex code("\\s*([A-Za-z]\\w*:\\w+(\\+(\\w+:)?\\w+)?|(urn:|https?:).*)\\s*");
  const auto says = [&](const char* word) { return crs.find(word) != std::string::npos; };
  return says("[") || says("proj=") || says("init=") || crs.starts_with("{") ||
         (crs.size() < 200 && std::regex_match(crs, code));
}

int say_fault(const Context& context, const char* crs, char* message, std::size_t size) {
  if (!is_definition(crs)) {
    return say("a system is a code (EPSG:32632), a PROJ string or well-known text", message, size);
  }
  const int fault = proj_context_errno(context.get());
  if (fault == 0) return say("it is no coordinate system", message, size);
  if (fault == PROJ_ERR_OTHER) return say("it knows no such system", message, size);
  return say(proj_context_errno_string(context.get(), fault), message, size);
}

/// Where PROJ's own tables are, in a package that brings them along; empty: where PROJ has them.
std::string own_tables() {
  Dl_info found{};
  if (::dladdr(reinterpret_cast<void*>(&own_tables), &found) == 0) return {};
  const std::filesystem::path folder =
      std::filesystem::path(found.dli_fname).parent_path() / "proj";
  return std::filesystem::exists(folder / "proj.db") ? folder.string() : std::string();
}

Context quiet_context() {
  Context context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  proj_context_use_proj4_init_rules(context.get(), 1);  // +init=epsg:25832, as old maps have it
  static const std::string tables = own_tables();
  const char* const folder = tables.c_str();
  if (!tables.empty()) proj_context_set_search_paths(context.get(), 1, &folder);
  return context;
}

/// Heights are another matter: of a compound system the horizontal part. The words of a PROJ string
/// may come without their plus signs.
Object horizontal(const Context& context, const char* crs) {
  std::string text = crs;
  if (!is_definition(text)) return nullptr;
  const auto says = [&](const char* word) { return text.find(word) != std::string::npos; };
  const bool is_well_known_text = says("[");
  if (!is_well_known_text && says("proj=") && !says("type=crs")) text += " +type=crs";
  Object object(proj_create(context.get(), text.c_str()));
  if (object && proj_get_type(object.get()) == PJ_TYPE_COMPOUND_CRS) {
    object.reset(proj_crs_get_sub_crs(context.get(), object.get(), 0));
  }
  if (!object || proj_is_crs(object.get()) == 0) return nullptr;
  return Object(proj_crs_demote_to_2D(context.get(), nullptr, object.get()));
}

/// From a system to longitude and latitude.
struct Path {
  Context context = quiet_context();  // of the object below, so made before it
  Object forward;
};

Path path_from(const char* crs) {
  Path path;
  PJ_CONTEXT* const context = path.context.get();
  const Object from = horizontal(path.context, crs);
  if (!from) return path;
  const Object to(proj_create(context, "OGC:CRS84"));
  const Object found(
      proj_create_crs_to_crs_from_pj(context, from.get(), to.get(), nullptr, nullptr));
  if (found) path.forward.reset(proj_normalize_for_visualization(context, found.get()));
  return path;
}

/// To find a path takes milliseconds, to go along it nanoseconds.
const Path& kept_path_from(const char* crs) {
  thread_local std::string kept_crs;
  thread_local Path kept;
  if (!kept.forward || kept_crs != crs) {
    kept.forward.reset();  // before its context goes
    kept = path_from(crs);
    kept_crs = crs;
  }
  return kept;
}

}  // namespace

int roadbed_proj_lon_lat(const char* crs, int to_lon_lat, double* xy, std::size_t count,
                         char* message, std::size_t message_size) {
  const Path& path = kept_path_from(crs);
  if (!path.forward) return say_fault(path.context, crs, message, message_size);
  constexpr std::size_t stride = 2 * sizeof(double);
  proj_trans_generic(path.forward.get(), to_lon_lat != 0 ? PJ_FWD : PJ_INV, xy, stride, count,
                     xy + 1, stride, count, nullptr, 0, 0, nullptr, 0, 0);
  for (std::size_t i = 0; i < 2 * count; ++i) {
    if (!std::isfinite(xy[i])) return say("a point is outside its domain", message, message_size);
  }
  return 0;
}

int roadbed_proj_wkt(const char* crs, char* wkt, std::size_t wkt_size, char* message,
                     std::size_t message_size) {
  const Context context = quiet_context();
  const Object object = horizontal(context, crs);
  if (!object) return say_fault(context, crs, message, message_size);
  const char* options[] = {"MULTILINE=NO", nullptr};
  const char* text = proj_as_wkt(context.get(), object.get(), PJ_WKT1_GDAL, options);
  if (text == nullptr) return say_fault(context, crs, message, message_size);
  if (std::strlen(text) >= wkt_size)
    return say("its description is too long", message, message_size);
  std::strcpy(wkt, text);
  return 0;
}
