#include "roadbed/map/compiled/compiled_map.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <functional>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "roadbed/map/derived/map_totals.h"
#include "roadbed/map/elements/byte_io.h"
#include "roadbed/map/elements/map_fields.h"
#include "roadbed/map/index/road_map_index.h"
#include "roadbed/map/storage/chunked_file.h"

namespace roadbed::map::inline compiled {
namespace {

using File = std::shared_ptr<const ChunkedFile>;

constexpr std::string_view kNames = "names", kTotals = "totals", kRouting = "appendix",
                           kSource = "source";

// Where the records of a list begin; one more than there are records.
std::string places(std::string_view list) { return fmt::format("{}.at", list); }

template <typename List>
using ItemOf = typename std::remove_cvref_t<List>::value_type;

// A section that is to be written.
struct Output {
  std::string name;
  std::uint64_t size = 0;
  std::function<void(ChunkedFileWriter&)> write;
};

Output output_of(std::string name, std::string_view bytes) {
  return {std::move(name), bytes.size(), [bytes](ChunkedFileWriter& file) { file.append(bytes); }};
}

// The sections of a list: its records, and where they begin.
template <typename Fields, typename List>
void add_list(std::string_view name, const Fields& fields, const List& list,
              std::vector<Output>& outputs) {
  ByteCount count;
  BasicByteWriter<ByteCount> counter(count);
  std::vector<std::uint64_t> at{0};
  at.reserve(list.size() + 1);
  for (const auto& item : list) {
    fields(counter, item);
    at.push_back(count.size);
  }
  const auto write = [&list, &fields](ChunkedFileWriter& file) {
    ByteWriter records(file.pending());
    for (const auto& item : list) {
      fields(records, item);
      file.flush();
    }
  };
  outputs.push_back({std::string(name), count.size, write});
  const auto places_array = std::make_shared<const FlatArray<std::uint64_t>>(std::move(at));
  outputs.push_back(
      {places(name), places_array->bytes().size(),
       [places_array](ChunkedFileWriter& file) { file.append(places_array->bytes()); }});
}

template <typename Io, typename Source>
void source_fields(Io& io, Source& source) {
  io(source.bytes);
  io(source.hash);
}

std::string bytes_of(const MapSource& source) {
  std::string bytes;
  ByteWriter writer(bytes);
  source_fields(writer, source);
  return bytes;
}

void write_outputs(const std::vector<Output>& outputs, ByteSink& sink) {
  std::vector<ChunkedFileWriter::Part> parts;
  for (const Output& output : outputs) parts.push_back({output.name, output.size});
  ChunkedFileWriter file(sink, parts);
  for (const Output& output : outputs) {
    file.begin_next();
    output.write(file);
  }
  file.finish();
}

// Bytes in memory as a place to write to.
class StringSink : public ByteSink {
 public:
  void expect(std::uint64_t size) override { bytes_.resize(size); }
  void write(std::uint64_t offset, std::string_view bytes) override {
    bytes_.replace(offset, bytes.size(), bytes);
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// Where a list's records begin, and the records.
struct ListSections {
  ListSections(const File& file, std::string_view name)
      : at(file, places(name)), records(file, name) {
    if (at.size() == 0) file->refuse(std::string(name), "no places of records");
  }
  std::size_t size() const { return at.size() - 1; }

  FlatArray<std::uint64_t> at;
  FlatArray<char> records;
};

// An item stands where its id says.
template <typename T>
void check_id(const ByteReader& reader, const T& item, std::size_t index) {
  if constexpr (requires { item.id.index; }) reader.check(item.id.index == index);
}

template <typename T, typename Fields>
T read_record(const ChunkedFile& file, std::string_view list, const ListSections& sections,
              const Fields& fields, const IdLimits& limits, std::size_t index) {
  const std::uint64_t* at = sections.at.span(index, 2);
  const auto damaged = [&](const std::string& found) {
    file.refuse(fmt::format("record {} of {}", index, list), found);
  };
  if (at[1] < at[0]) damaged("its content is damaged");
  try {
    const std::uint64_t size = at[1] - at[0];
    ByteReader reader({sections.records.span(at[0], size), size}, limits);
    T item;
    fields(reader, item);
    check_id(reader, item, index);
    reader.check(reader.at_end());
    return item;
  } catch (const ByteReader::Damaged&) {
    damaged("its content is damaged");
  } catch (const std::invalid_argument& error) {
    damaged(error.what());
  }
  throw std::logic_error("read_record: not reached");
}

template <typename T, typename Fields>
LazyList<T> open_list(const File& file, std::string_view name, const Fields& fields,
                      const IdLimits& limits) {
  const auto sections = std::make_shared<const ListSections>(file, name);
  return LazyList<T>(sections->size(), [file, name, fields, limits, sections](std::size_t index) {
    return read_record<T>(*file, name, *sections, fields, limits, index);
  });
}

IdLimits limits_of(const File& file) {
  return {.lanes = ListSections(file, "lanes").size(),
          .roads = ListSections(file, "roads").size(),
          .junctions = ListSections(file, "junctions").size()};
}

LazyMapContent open_content(const File& file) {
  const FlatArray<char> head(file, "head");
  const IdLimits limits = limits_of(file);
  LazyMapContent content;
  try {
    ByteReader reader(head.bytes(), limits);
    fields::head(reader, content);
  } catch (const ByteReader::Damaged&) {
    file->refuse("head", "its content is damaged");
  }
  const auto open = [&](std::string_view name, const auto& fields, auto& list) {
    list = open_list<ItemOf<decltype(list)>>(file, name, fields, limits);
  };
  fields::lists(open, content);
  return content;
}

RoadMapIndex open_index(const File& file) {
  lane_index::Data data;
  const auto open = [&](std::string_view name, auto& array) {
    array = std::remove_reference_t<decltype(array)>(file, name);
  };
  lane_index::visit(open, data);
  const auto optional = [&](std::string_view name) {
    return file->has(name) ? FlatArray<char>(file, name) : FlatArray<char>();
  };
  return {LaneIndex(std::move(data)), FlatArray<std::uint32_t>(file, kNames), optional(kTotals),
          optional(kRouting)};
}

RoadMap open_map(const File& file) {
  try {
    return {open_content(file), open_index(file)};
  } catch (const std::invalid_argument& error) {
    file->refuse({}, error.what());
  }
}

// Makes every record of a list, one at a time, so that neither they nor the chunks that they lie
// in gather in memory. Returns how many there are.
template <typename T, typename Fields, typename Visit>
std::size_t visit_records(const File& file, std::string_view name, const Fields& fields,
                          const IdLimits& limits, const Visit& visit) {
  const ListSections sections(file, name);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    visit(read_record<T>(*file, name, sections, fields, limits, i));
    file->evict_over_budget();
  }
  return sections.size();
}

VerifiedMap verify(const File& file) {
  file->check_all();
  const RoadMap road_map = open_map(file);
  const IdLimits limits = limits_of(file);
  VerifiedMap verified{file->chunks(), 0};
  RoadMapIndexCheck index(road_map.index());
  TotalsCounter totals;
  const auto visit = [&](std::string_view name, const auto& fields, const auto& list) {
    using T = ItemOf<decltype(list)>;
    verified.records += visit_records<T>(file, name, fields, limits, [&](const T& item) {
      totals.add(item);
      if constexpr (std::is_same_v<T, Lane>) index.add(item);
    });
  };
  fields::lists(visit, road_map.content());
  if (!index.holds()) file->refuse("index", "the index does not belong to these lanes");
  if (!are_stored_as(road_map, std::move(totals).totals())) {
    file->refuse(std::string(kTotals), "not what its things add up to");
  }
  return verified;
}

}  // namespace

std::string write_compiled_map(const RoadMap& road_map) {
  return write_compiled_map(road_map, road_map.index().routing.bytes());
}

std::string write_compiled_map(const RoadMap& road_map, std::string_view routing) {
  return write_compiled_map(road_map, routing, std::nullopt);
}

std::string write_compiled_map(const RoadMap& road_map, std::string_view routing,
                               const std::optional<MapSource>& source,
                               const std::optional<MapTotals>& totals) {
  StringSink sink;
  write_compiled_map(road_map, routing, sink, source, totals);
  return sink.take();
}

void write_compiled_map(const RoadMap& road_map, std::string_view routing, ByteSink& sink,
                        const std::optional<MapSource>& source,
                        const std::optional<MapTotals>& known_totals) {
  std::string head;
  ByteWriter head_writer(head);
  fields::head(head_writer, road_map.content());
  const std::string totals = write_totals(known_totals ? *known_totals : totals_of(road_map));
  std::vector<Output> outputs{output_of("head", head), output_of(std::string(kTotals), totals)};
  const auto add_array = [&](std::string_view name, const auto& array) {
    outputs.push_back(output_of(std::string(name), array.bytes()));
  };
  lane_index::visit(add_array, road_map.index().lanes.data());
  add_array(kNames, road_map.index().by_name);
  const auto add = [&](std::string_view name, const auto& fields, const auto& list) {
    add_list(name, fields, list, outputs);
  };
  fields::lists(add, road_map.content());
  if (!routing.empty()) outputs.push_back(output_of(std::string(kRouting), routing));
  const std::string source_bytes = source ? bytes_of(*source) : std::string();
  if (source) outputs.push_back(output_of(std::string(kSource), source_bytes));
  write_outputs(outputs, sink);
}

MapSource source_of_content(std::string_view content) {
  return {content.size(), XXH3_64bits(content.data(), content.size())};
}

std::optional<MapSource> source_of_compiled_map(const std::filesystem::path& path) {
  const File file = ChunkedFile::open(path);
  if (!file->has(kSource)) return {};
  const FlatArray<char> section(file, std::string(kSource));
  try {
    ByteReader reader(section.bytes(), {});
    MapSource source;
    source_fields(reader, source);
    reader.check(reader.at_end());
    return source;
  } catch (const ByteReader::Damaged&) {
    file->refuse(std::string(kSource), "its content is damaged");
  }
}

bool is_compiled_map(std::string_view bytes) {
  constexpr std::string_view magic = ChunkedFile::kMagic;
  return bytes.starts_with(magic.substr(0, magic.size() - 4));
}

RoadMap open_compiled_map(const std::filesystem::path& file) {
  return open_map(ChunkedFile::open(file));
}

RoadMap read_compiled_map(std::string bytes, const std::string& name) {
  return open_map(ChunkedFile::from_bytes(std::move(bytes), name));
}

LoadedChunks loaded_chunks(const RoadMap& road_map) {
  const ChunkedFile* file = road_map.index().by_name.file();
  if (file == nullptr) return {};
  return {file->chunks_in_memory(), file->chunks()};
}

VerifiedMap verify_compiled_map(const std::filesystem::path& file) {
  return verify(ChunkedFile::open(file));
}

VerifiedMap verify_compiled_map(std::string bytes, const std::string& name) {
  return verify(ChunkedFile::from_bytes(std::move(bytes), name));
}

}  // namespace roadbed::map::compiled
