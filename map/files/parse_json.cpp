#include "roadbed/map/files/parse_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline files {
namespace {

using Json = nlohmann::json;

// The library's own callback looks through all that a list holds at the end of each of its parts.
class DocumentBuilder final : public nlohmann::json_sax<Json> {
 public:
  DocumentBuilder(std::size_t document_bytes, const std::string& file, const JsonRules& rules)
      : DocumentBuilder(document_bytes, file, rules, 0, nullptr) {}

  /// @param take  takes the parts that stand at most `level` objects deep; null: none.
  DocumentBuilder(std::size_t document_bytes, const std::string& file, const JsonRules& rules,
                  std::size_t level, const TakeJsonPart* take)
      : file_(file),
        rules_(rules),
        level_(level),
        take_(take),
        most_(geometry::most_bytes_read(document_bytes)),
        left_(most_) {}

  Json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool binary(binary_t&) override { return false; }  // not in texts

  bool string(string_t& value) override {
    spend(kText + value.size());
    return add(std::move(value));
  }

  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& key) override {
    spend(kMember + key.size());
    if (take_ != nullptr && lists_ == 0 && open_.size() <= level_) {
      keys_.resize(open_.size() - 1);
      keys_.push_back({key, left_});
    }
    const auto [member, is_new] =
        open_.back()->get_ref<Json::object_t&>().try_emplace(std::move(key), nullptr);
    if (!is_new && rules_.keys_stand_once) {
      throw InputError({.file = file_,
                        .element = fmt::format("key \"{}\"", member->first),
                        .found = "stands twice in one object",
                        .remedy = "remove one of the two"});
    }
    member_ = &member->second;
    return true;
  }

  bool parse_error(std::size_t, const std::string&, const Json::exception& error) override {
    if (const auto* beyond = dynamic_cast<const Json::out_of_range*>(&error)) throw *beyond;
    throw dynamic_cast<const Json::parse_error&>(error);
  }

 private:
  // What the parts of a document take beside its texts [bytes]: lists grow by doubling, and all but
  // numbers lie in blocks of their own.
  static constexpr std::size_t kValue = 2 * sizeof(Json);
  static constexpr std::size_t kText = sizeof(std::string) + 16;
  static constexpr std::size_t kList = 64;
  static constexpr std::size_t kMember = 4 * sizeof(void*) + sizeof(std::string) + 16;

  void spend(std::size_t bytes) {
    if (bytes <= left_) {
      left_ -= bytes;
      return;
    }
    throw InputError(
        {.file = file_,
         .found = fmt::format("more values than {} MB of memory hold", most_ / 1'000'000),
         .needed = "a document with content of its size",
         .remedy = "check whether it is the right file, or split it"});
  }

  Json* put(Json value) {
    spend(kValue);
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    if (open_.back()->is_object()) {
      *member_ = std::move(value);
      return member_;
    }
    auto& list = open_.back()->get_ref<Json::array_t&>();
    list.push_back(std::move(value));
    return &list.back();
  }

  bool add(Json value) {
    hand_over(*put(std::move(value)));
    return true;
  }

  // A value that is whole.
  void hand_over(Json& value) {
    if (take_ == nullptr || lists_ > 0 || open_.size() > level_) return;
    const std::size_t keys = open_.size();
    std::vector<std::string> names;
    for (std::size_t i = 0; i < keys; ++i) names.push_back(keys_[i].name);
    (*take_)(names, std::exchange(value, nullptr));
    if (keys > 0) left_ = keys_[keys - 1].left;
  }

  bool open(Json value) {
    if (open_.size() >= rules_.most_levels) {
      throw InputError({.file = file_,
                        .found = "lists nested too deeply",
                        .needed = fmt::format("at most {} levels", rules_.most_levels),
                        .remedy = "flatten them"});
    }
    spend(kList);
    if (value.is_array()) ++lists_;
    open_.push_back(put(std::move(value)));
    return true;
  }

  bool close() {
    Json& closed = *open_.back();
    open_.pop_back();
    if (closed.is_array()) --lists_;
    hand_over(closed);
    return true;
  }

  const std::string& file_;
  const JsonRules& rules_;
  std::size_t level_;
  const TakeJsonPart* take_;
  std::size_t most_, left_;
  Json root_;
  std::vector<Json*> open_;  // a list does not grow while a part of it is open
  Json* member_ = nullptr;   // whose value comes next
  std::size_t lists_ = 0;    // that are open
  struct Key {
    std::string name;
    std::size_t left;  // bytes, before its value
  };
  std::vector<Key> keys_;  // that lead to the part that is read
};

}  // namespace

nlohmann::json parse_json(std::string_view bytes, const std::string& file, const JsonRules& rules) {
  DocumentBuilder builder(bytes.size(), file, rules);
  Json::sax_parse(bytes, &builder);
  return builder.take();
}

void parse_json_parts(std::string_view bytes, const std::string& file, const JsonRules& rules,
                      std::size_t level, const TakeJsonPart& take) {
  DocumentBuilder builder(bytes.size(), file, rules, level, &take);
  Json::sax_parse(bytes, &builder);
}

void refuse_json(const std::exception& error, const std::string& file) {
  const auto* at = dynamic_cast<const Json::parse_error*>(&error);
  if (at == nullptr) {
    throw InputError({.file = file,
                      .found = "a number beyond those of a computer",
                      .needed = "numbers below 1e308",
                      .remedy = "correct it"});
  }
  throw InputError({.file = file,
                    .place = fmt::format("byte {}", at->byte),
                    .found = "not JSON",
                    .needed = "a whole JSON document",
                    .remedy = "check whether the file was cut off"});
}

}  // namespace roadbed::map::files
