#include "roadbed/map/opendrive/furniture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace roadbed::map::opendrive {
namespace {

// Long bodies follow their road in steps of this length.
constexpr double kStepM = 1.0;

geometry::Ring in_plan(const std::vector<Eigen::Vector3d>& corners) {
  geometry::Ring ring;
  ring.reserve(corners.size());
  for (const Eigen::Vector3d& corner : corners) ring.emplace_back(corner.head<2>());
  return ring;
}

bool all_placeable(const std::vector<Eigen::Vector3d>& corners) {
  return std::all_of(corners.begin(), corners.end(), is_placeable);
}

// The outline that length and width, or a radius, give an object.
Outline usual_outline(const ObjectRecord& object) {
  Outline outline;
  if (object.radius_m > 0.0) {
    constexpr int corners = 16;
    for (int i = 0; i < corners; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * i / corners;
      outline.corners.push_back({false, object.radius_m * std::cos(angle_rad),
                                 object.radius_m * std::sin(angle_rad), 0.0});
    }
  } else if (object.length_m > 0.0 && object.width_m > 0.0) {
    const double u = 0.5 * object.length_m, v = 0.5 * object.width_m;
    outline.corners = {
        {false, -u, -v, 0.0}, {false, u, -v, 0.0}, {false, u, v, 0.0}, {false, -u, v, 0.0}};
  }
  return outline;
}

class ObjectPlacer {
 public:
  ObjectPlacer(const Document& document, std::span<const RoadFrame> frames, PointBudget& budget,
               std::vector<ImportDiagnostic>& remarks)
      : document_(document), frames_(frames), budget_(budget), remarks_(remarks) {
    for (const RoadRecord& road : document.roads) {
      for (const ObjectReference& reference : road.object_references) {
        references_.emplace(reference.object_id, fmt::format("road {}, s {}, t {}", road.id,
                                                             reference.s_m, reference.t_m));
      }
    }
  }

  std::vector<MapObject> place() {
    for (std::size_t road = 0; road < document_.roads.size(); ++road) {
      for (const ObjectRecord& record : document_.roads[road].objects) add(road, record);
      for (const Structure& record : document_.roads[road].structures) add(road, record);
    }
    return std::move(objects_);
  }

 private:
  void add(std::size_t road, const ObjectRecord& record) {
    if (record.repeats.empty()) {
      add_copy(road, record);
      return;
    }
    for (const Repeat& repeat : record.repeats) {
      if (repeat.distance_m > 0.0) {
        add_copies(road, record, repeat);
      } else {
        add_body(road, record, repeat);
      }
    }
  }

  void add_copies(std::size_t road, const ObjectRecord& record, const Repeat& repeat) {
    const double count = std::floor(std::max(0.0, repeat.length_m) / repeat.distance_m + 1e-9);
    for (double i = 0; i <= count; ++i) {
      const double fraction = repeat.length_m > 0.0 ? i * repeat.distance_m / repeat.length_m : 0.0;
      ObjectRecord copy = record;
      copy.s_m = repeat.s_m + i * repeat.distance_m;
      copy.t_m = std::lerp(repeat.t_start_m, repeat.t_end_m, fraction);
      copy.z_offset_m = std::lerp(repeat.z_start_m, repeat.z_end_m, fraction);
      copy.width_m = std::lerp(repeat.width_start_m, repeat.width_end_m, fraction);
      copy.height_m = repeat.height_m;
      if (!add_copy(road, copy)) return;
    }
  }

  // False: the budget is spent or the place is none, and so are all further ones.
  bool add_copy(std::size_t road, const ObjectRecord& record) {
    const std::vector<Outline>& own = record.outlines;
    const std::vector<Outline> outlines =
        own.empty() ? std::vector<Outline>{usual_outline(record)} : own;
    for (const Outline& outline : outlines) {
      MapObject object = described(road, record);
      const Eigen::Vector3d in_map = frames_[road].at(record.s_m, record.t_m, record.z_offset_m);
      const auto corners = outline_in_map(frames_[road], record, outline);
      if (!keep(road, record, in_map, corners)) return false;
      object.in_map = in_map.head<2>();
      object.z_m = in_map.z();
      if (outline.closed) object.outline_in_map = simple_ring(in_plan(corners));
      objects_.push_back(std::move(object));
    }
    return true;
  }

  // One body from the repeat's start to its end, as wide as it says.
  void add_body(std::size_t road, const ObjectRecord& record, const Repeat& repeat) {
    const double steps = std::ceil(std::max(0.0, repeat.length_m) / kStepM);
    if (!(steps < 1e6)) return remark_left_out(road, record, "is too long");
    std::vector<Eigen::Vector3d> left, right;
    for (double i = 0; i <= steps; ++i) {
      const double fraction = steps > 0.0 ? i / steps : 0.0;
      const double s_m = repeat.s_m + fraction * repeat.length_m;
      const double t_m = std::lerp(repeat.t_start_m, repeat.t_end_m, fraction);
      const double z_m = std::lerp(repeat.z_start_m, repeat.z_end_m, fraction);
      const double half_m = 0.5 * std::lerp(repeat.width_start_m, repeat.width_end_m, fraction);
      left.push_back(frames_[road].at(s_m, t_m + half_m, z_m));
      right.push_back(frames_[road].at(s_m, t_m - half_m, z_m));
    }
    right.insert(right.end(), left.rbegin(), left.rend());
    const Eigen::Vector3d in_map = frames_[road].at(repeat.s_m, repeat.t_start_m, repeat.z_start_m);
    if (!keep(road, record, in_map, right)) return;
    MapObject object = described(road, record);
    object.road_s_m = repeat.s_m;
    object.road_t_m = repeat.t_start_m;
    object.height_m = repeat.height_m;
    object.in_map = in_map.head<2>();
    object.z_m = in_map.z();
    object.outline_in_map = simple_ring(in_plan(right));
    objects_.push_back(std::move(object));
  }

  void add(std::size_t road, const Structure& structure) {
    const RoadFrame& frame = frames_[road];
    const double end_m = std::min(structure.s_m + structure.length_m, frame.road().length_m);
    const double start_m = std::max(0.0, structure.s_m);
    const double steps = std::ceil(std::max(0.0, end_m - start_m) / kStepM);
    std::vector<Eigen::Vector3d> left, right;
    for (double i = 0; i <= steps; ++i) {
      const double s_m = std::min(end_m, start_m + i * kStepM);
      const auto [least_m, greatest_m] = frame.reach_m(s_m);
      left.push_back(frame.at(s_m, greatest_m, 0.0));
      right.push_back(frame.at(s_m, least_m, 0.0));
    }
    right.insert(right.end(), left.rbegin(), left.rend());
    ObjectRecord record;
    record.id = structure.id;
    record.name = structure.name;
    record.type = structure.kind;
    record.s_m = structure.s_m;
    record.line = document_.roads[road].line;
    const Eigen::Vector3d in_map = frame.at(start_m, 0.0, 0.0);
    if (!keep(road, record, in_map, right)) return;
    MapObject object = described(road, record);
    object.in_map = in_map.head<2>();
    object.z_m = in_map.z();
    object.outline_in_map = simple_ring(in_plan(right));
    object.attributes.emplace_back("type", structure.type);
    object.attributes.emplace_back("length", fmt::format("{}", structure.length_m));
    objects_.push_back(std::move(object));
  }

  MapObject described(std::size_t road, const ObjectRecord& record) const {
    MapObject object;
    object.source_id = record.id;
    object.name = record.name;
    object.type = record.type;
    object.road = RoadId{static_cast<std::uint32_t>(road)};
    object.road_s_m = record.s_m;
    object.road_t_m = record.t_m;
    object.height_m = record.height_m;
    object.attributes = record.attributes;
    const auto [from, to] = references_.equal_range(record.id);
    for (auto reference = from; reference != to; ++reference) {
      object.attributes.emplace_back("objectReference", reference->second);
    }
    return object;
  }

  // Whether the place is one and the budget holds; says so if not.
  bool keep(std::size_t road, const ObjectRecord& record, const Eigen::Vector3d& in_map,
            const std::vector<Eigen::Vector3d>& corners) {
    if (!is_placeable(in_map) || !all_placeable(corners)) {
      remark_left_out(road, record, "stands where no map reaches");
      return false;
    }
    const std::size_t words = record.attributes.size() + references_.count(record.id);
    if (!budget_.try_to_spend(PointBudget::kPerThing + corners.size() + words)) {
      remark_left_out(road, record, "and its copies are more than a map of this size can hold");
      return false;
    }
    return true;
  }

  void remark_left_out(std::size_t road, const ObjectRecord& record, const char* why) {
    remarks_.push_back({"import.object", true,
                        fmt::format("object {} of road {}", record.id, document_.roads[road].id),
                        record.line, fmt::format("{}; it is left out, correct its values", why)});
  }

  const Document& document_;
  std::span<const RoadFrame> frames_;
  PointBudget& budget_;
  std::vector<ImportDiagnostic>& remarks_;
  std::multimap<std::string, std::string> references_;
  std::vector<MapObject> objects_;
};

}  // namespace

std::vector<Eigen::Vector3d> outline_in_map(const RoadFrame& frame, const ObjectRecord& object,
                                            const Outline& outline) {
  const Eigen::Vector3d origin = frame.at(object.s_m, object.t_m, object.z_offset_m);
  const double heading_rad = frame.heading_rad(object.s_m) + object.heading_rad;
  const double cosine = std::cos(heading_rad), sine = std::sin(heading_rad);
  std::vector<Eigen::Vector3d> corners;
  corners.reserve(outline.corners.size());
  for (const Corner& corner : outline.corners) {
    corners.push_back(corner.on_road
                          ? frame.at(corner.a, corner.b, corner.z_m)
                          : Eigen::Vector3d(origin.x() + cosine * corner.a - sine * corner.b,
                                            origin.y() + sine * corner.a + cosine * corner.b,
                                            origin.z() + corner.z_m));
  }
  return corners;
}

std::vector<MapObject> place_objects(const Document& document, std::span<const RoadFrame> frames,
                                     PointBudget& budget, std::vector<ImportDiagnostic>& remarks) {
  return ObjectPlacer(document, frames, budget, remarks).place();
}

}  // namespace roadbed::map::opendrive
