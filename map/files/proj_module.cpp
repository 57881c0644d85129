#include "roadbed/map/files/proj_module.h"

#include <dlfcn.h>
#include <proj.h>
#include <proj_experimental.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <regex>
#include <string>
#include <string_view>

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
  proj_context_set_enable_network(context.get(), 0);
  proj_context_use_proj4_init_rules(context.get(), 1);  // +init=epsg:25832, as old maps have it
  static const std::string tables = own_tables();
  const char* const folder = tables.c_str();
  if (!tables.empty()) proj_context_set_search_paths(context.get(), 1, &folder);
  return context;
}

/// Of the thread: its tables stay open, which takes milliseconds.
PJ_CONTEXT* kept_context() {
  thread_local const Context context = quiet_context();
  return context.get();
}

/// An object, or why there is none.
struct Made {
  Object object;
  std::string fault;
};

Made made(PJ* object) {
  if (object != nullptr) return {Object(object), {}};
  const int fault = proj_context_errno(kept_context());
  const bool says_nothing = fault == 0 || fault == PROJ_ERR_OTHER;
  return {nullptr, says_nothing ? "it cannot be understood"
                                : proj_context_errno_string(kept_context(), fault)};
}

/// "EPSG:25832": found by PROJ itself, too, but unknown ones a hundred times as slowly.
Made of_code(const std::string& authority, const std::string& code) {
  Object object(proj_create_from_database(kept_context(), authority.c_str(), code.c_str(),
                                          PJ_CATEGORY_CRS, 0, nullptr));
  if (!object) return {nullptr, "it knows no such system"};
  return {std::move(object), {}};
}

/// Whether a system has PROJ open a file by its path: "+nadgrids=/dev/stdin", or a quoted one in
/// well-known text or JSON. Grids that PROJ has itself go by their names alone.
bool names_a_path(const std::string& crs) {
  bool is_value = false;
  char before = ' ';
  for (const char c : crs) {
    const bool starts = std::string_view("\"\x9c@.~").find(before) != std::string_view::npos;
    if (c == '/' && (is_value || starts)) return true;
    if (c == '=') is_value = true;
    if (std::isspace(static_cast<unsigned char>(c)) != 0 || (c == '"' && before != '=')) {
      is_value = false;
    }
    before = c;
  }
  const bool is_json = crs.find_first_not_of(" \t\r\n") == crs.find('{');
  return is_json && (crs.find('\\') != crs.npos || crs.find("\"filename\"") != crs.npos);
}

/// PROJ takes any other text for a name and looks for one like it: "WGS" would be WGS 72.
Made system_of(const std::string& crs) {
  static const std::regex code("\\s*([A-Za-z]\\w*):(\\w+)\\s*");
  static const std::regex text(
      "\\s*(\\w*(CS|CRS)\\s*\\[|\\{|urn:|https?:|[A-Za-z]\\w*:\\w+\\+)[^]*", std::regex::icase);
  if (names_a_path(crs)) return {nullptr, "it names a file, which no coordinate system may"};
  if (std::smatch found; crs.size() < 100 && std::regex_match(crs, found, code)) {
    return of_code(found[1], found[2]);
  }
  const auto says = [&](const char* word) { return crs.find(word) != std::string::npos; };
  const bool is_text = std::regex_match(crs.substr(0, 100), text);
  if (!is_text && (says("proj=") || says("init="))) {  // its words may come without plus signs
    return made(proj_create(kept_context(), (says("type=crs") ? crs : crs + " +type=crs").c_str()));
  }
  if (is_text) return made(proj_create(kept_context(), crs.c_str()));
  return {nullptr, "a system is a code (EPSG:32632), a PROJ string or well-known text"};
}

/// Heights are another matter: of a compound system the horizontal part.
Made horizontal(const std::string& crs) {
  Made system = system_of(crs);
  if (!system.object) return system;
  PJ* object = system.object.get();
  if (proj_get_type(object) == PJ_TYPE_COMPOUND_CRS) {
    system.object.reset(proj_crs_get_sub_crs(kept_context(), object, 0));
    object = system.object.get();
  }
  if (object == nullptr || proj_is_crs(object) == 0) return {nullptr, "it is no coordinate system"};
  return made(proj_crs_demote_to_2D(kept_context(), nullptr, object));
}

/// From a system to longitude and latitude.
Made path_from(const std::string& crs) {
  Made from = horizontal(crs);
  if (!from.object) return from;
  const Object to(proj_create(kept_context(), "OGC:CRS84"));
  const Object found(proj_create_crs_to_crs_from_pj(kept_context(), from.object.get(), to.get(),
                                                    nullptr, nullptr));
  if (!found) return {nullptr, "it has no way to longitude and latitude"};
  return made(proj_normalize_for_visualization(kept_context(), found.get()));
}

/// To find a path takes milliseconds, to go along it nanoseconds.
const Made& kept_path_from(const std::string& crs) {
  kept_context();  // goes after the path
  thread_local std::string kept_crs;
  thread_local Made kept;
  if (!kept.object || kept_crs != crs) {
    kept = path_from(crs);
    kept_crs = crs;
  }
  return kept;
}

}  // namespace

int roadbed_proj_lon_lat(const char* crs, int to_lon_lat, double* xy, std::size_t count,
                         char* message, std::size_t message_size) {
  const Made& path = kept_path_from(crs);
  if (!path.object) return say(path.fault, message, message_size);
  constexpr std::size_t stride = 2 * sizeof(double);
  proj_trans_generic(path.object.get(), to_lon_lat != 0 ? PJ_FWD : PJ_INV, xy, stride, count,
                     xy + 1, stride, count, nullptr, 0, 0, nullptr, 0, 0);
  for (std::size_t i = 0; i < 2 * count; ++i) {
    if (!std::isfinite(xy[i])) return say("a point is outside its domain", message, message_size);
  }
  return 0;
}

int roadbed_proj_wkt(const char* crs, char* wkt, std::size_t wkt_size, char* message,
                     std::size_t message_size) {
  const Made system = horizontal(crs);
  if (!system.object) return say(system.fault, message, message_size);
  const char* options[] = {"MULTILINE=NO", nullptr};
  const char* text = proj_as_wkt(kept_context(), system.object.get(), PJ_WKT1_GDAL, options);
  if (text == nullptr) return say("it has no well-known text", message, message_size);
  if (std::strlen(text) >= wkt_size)
    return say("its description is too long", message, message_size);
  std::strcpy(wkt, text);
  return 0;
}
