#include "roadbed/tools/commands/occupancy/filter_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace roadbed::tools::inline commands::inline occupancy {
namespace {

std::optional<map::ValueRange> range_of(const std::vector<double>& ends) {
  if (ends.empty()) return std::nullopt;
  return map::ValueRange{ends[0], ends[1]};
}

std::vector<int> whole(const std::vector<double>& numbers) {
  std::vector<int> wholes;
  for (const double number : numbers) wholes.push_back(static_cast<int>(number));
  return wholes;
}

// Empty: last. None: neither that nor numbers.
std::optional<std::vector<int>> returns_of(const std::string& words) {
  std::vector<int> returns;
  if (words == "last") return returns;
  for (std::size_t at = 0; at <= words.size();) {
    const std::size_t end = std::min(words.find(',', at), words.size());
    const std::string word = words.substr(at, end - at);
    const bool is_number = word.size() == 1 || word == "10" || word == "11" || word == "12" ||
                           word == "13" || word == "14" || word == "15";
    if (word == "first") {
      returns.push_back(1);
    } else if (is_number && word[0] >= '1' && word[0] <= '9') {
      returns.push_back(std::stoi(word));
    } else {
      return std::nullopt;
    }
    at = end + 1;
  }
  return returns;
}

std::string order_fault(const char* option, const std::vector<double>& ends) {
  if (ends.empty() || ends[0] <= ends[1]) return {};
  return std::string(option) + ": the first is not the smaller one";
}

std::string class_fault(const char* option, const std::vector<double>& classes) {
  const bool are_classes = std::ranges::all_of(classes, [](double number) {
    return number >= 0.0 && number <= 255.0 && number == std::floor(number);
  });
  return are_classes ? "" : std::string(option) + ": classes are whole numbers from 0 to 255";
}

}  // namespace

void FilterArguments::declare(Arguments& arguments) {
  const std::string heading = arguments.heading("Points that count");
  arguments.add("--classes", classes_, "Only points of these classes, as LAS numbers them: 2,6")
      .separated_by(',');
  arguments
      .add("--without-classes", left_out_classes_,
           "No points of these classes; 7,18 is what LAS calls noise")
      .separated_by(',');
  arguments
      .add("--returns", returns_, "Only these returns of each pulse: first, last or numbers: 1,2")
      .checked([](const std::string& words) -> std::string {
        return returns_of(words) ? "" : "is neither first, last nor numbers from 1 to 15";
      });
  arguments
      .add("--intensity", intensity_, "Only intensities from MIN,MAX, as the file measures them")
      .separated_by(',')
      .values(2);
  arguments
      .add("--range", range_m_,
           "Only points at MIN,MAX from where they were measured [m], of a scan in a frame of its "
           "own from 0,0,0; 0.5,inf leaves out what came from no distance")
      .separated_by(',')
      .values(2);
  arguments
      .add("--vehicle-box", vehicle_box_,
           "No points on the vehicle itself: X,Y,Z,X,Y,Z of two corners [m] in base_link of a "
           "log, else in the frame of the file, before it is placed")
      .separated_by(',')
      .values(6);
  arguments.add("--height", height_m_, "Only points with z from MIN,MAX, where they are placed [m]")
      .separated_by(',')
      .values(2);
  arguments.heading(heading);
  arguments.require([this]() -> std::string {
    for (const std::string& fault :
         {class_fault("--classes", classes_), class_fault("--without-classes", left_out_classes_),
          order_fault("--intensity", intensity_), order_fault("--range", range_m_),
          order_fault("--height", height_m_)}) {
      if (!fault.empty()) return fault;
    }
    return {};
  });
}

std::string FilterArguments::words() const {
  std::string words;
  const auto add = [&](const char* option, const std::vector<double>& numbers) {
    if (numbers.empty()) return;
    words += fmt::format("{}{}={}", words.empty() ? "" : " ", option, fmt::join(numbers, ","));
  };
  add("--classes", classes_);
  add("--without-classes", left_out_classes_);
  if (!returns_.empty()) words += (words.empty() ? "--returns=" : " --returns=") + returns_;
  add("--intensity", intensity_);
  add("--range", range_m_);
  add("--vehicle-box", vehicle_box_);
  add("--height", height_m_);
  return words;
}

map::CloudFilter FilterArguments::filter() const {
  map::CloudFilter filter;
  filter.classes = whole(classes_);
  filter.left_out_classes = whole(left_out_classes_);
  filter.last_returns = returns_ == "last";
  if (!returns_.empty()) filter.returns = *returns_of(returns_);
  filter.intensity = range_of(intensity_);
  filter.range_m = range_of(range_m_);
  filter.height_m = range_of(height_m_);
  if (!vehicle_box_.empty()) {
    const Eigen::Vector3d a(vehicle_box_[0], vehicle_box_[1], vehicle_box_[2]);
    const Eigen::Vector3d b(vehicle_box_[3], vehicle_box_[4], vehicle_box_[5]);
    filter.vehicle_box = map::Box3{a.cwiseMin(b), a.cwiseMax(b)};
  }
  return filter;
}

}  // namespace roadbed::tools::commands::occupancy
