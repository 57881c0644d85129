#include "roadbed/map/logs/foxglove_schemas.h"

#include <algorithm>
#include <set>
#include <span>
#include <stdexcept>

#include "roadbed/map/logs/protobuf.h"

namespace roadbed::map::inline logs {
namespace {

/// A field as a .proto has it; the type is a scalar's, or the full name of a message or an enum.
struct SchemaField {
  std::uint32_t number;
  std::string_view name, type;
  bool is_repeated = false;
};
struct EnumValue {
  std::string_view name;
  std::uint64_t number;
};
struct SchemaEnum {
  std::string_view name;  ///< within its message
  std::span<const EnumValue> values;
};
struct SchemaMessage {
  std::string_view package, name;
  std::span<const SchemaField> fields;
  std::span<const SchemaEnum> enums = {};

  std::string full_name() const { return std::string(package) + "." + std::string(name); }
};

constexpr std::string_view kTimeType = "google.protobuf.Timestamp",
                           kDurationType = "google.protobuf.Duration",
                           kVectorType = "foxglove.Vector3",
                           kQuaternionType = "foxglove.Quaternion", kPointType = "foxglove.Point3",
                           kPoseType = "foxglove.Pose", kColorType = "foxglove.Color",
                           kPairType = "foxglove.KeyValuePair";

constexpr SchemaField kSecondsFields[] = {{1, "seconds", "int64"}, {2, "nanos", "int32"}};
constexpr SchemaField kXyzFields[] = {{1, "x", "double"}, {2, "y", "double"}, {3, "z", "double"}};
constexpr SchemaField kXyzwFields[] = {
    {1, "x", "double"}, {2, "y", "double"}, {3, "z", "double"}, {4, "w", "double"}};
constexpr SchemaField kRgbaFields[] = {
    {1, "r", "double"}, {2, "g", "double"}, {3, "b", "double"}, {4, "a", "double"}};
constexpr SchemaField kPoseFields[] = {{1, "position", kVectorType},
                                       {2, "orientation", kQuaternionType}};
constexpr SchemaField kPairFields[] = {{1, "key", "string"}, {2, "value", "string"}};

constexpr SchemaField kFrameTransformFields[] = {{1, "timestamp", kTimeType},
                                                 {2, "parent_frame_id", "string"},
                                                 {3, "child_frame_id", "string"},
                                                 {4, "translation", kVectorType},
                                                 {5, "rotation", kQuaternionType}};
constexpr SchemaField kPosesInFrameFields[] = {
    {1, "timestamp", kTimeType}, {2, "frame_id", "string"}, {3, "poses", kPoseType, true}};

constexpr SchemaField kArrowFields[] = {
    {1, "pose", kPoseType},       {2, "shaft_length", "double"},  {3, "shaft_diameter", "double"},
    {4, "head_length", "double"}, {5, "head_diameter", "double"}, {6, "color", kColorType}};
constexpr SchemaField kCubeFields[] = {
    {1, "pose", kPoseType}, {2, "size", kVectorType}, {3, "color", kColorType}};
constexpr SchemaField kCylinderFields[] = {{1, "pose", kPoseType},
                                           {2, "size", kVectorType},
                                           {3, "bottom_scale", "double"},
                                           {4, "top_scale", "double"},
                                           {5, "color", kColorType}};
constexpr SchemaField kLineFields[] = {{1, "type", "foxglove.LinePrimitive.Type"},
                                       {2, "pose", kPoseType},
                                       {3, "thickness", "double"},
                                       {4, "scale_invariant", "bool"},
                                       {5, "points", kPointType, true},
                                       {6, "color", kColorType},
                                       {7, "colors", kColorType, true},
                                       {8, "indices", "fixed32", true}};
constexpr EnumValue kLineTypes[] = {{"LINE_STRIP", 0}, {"LINE_LOOP", 1}, {"LINE_LIST", 2}};
constexpr SchemaEnum kLineEnums[] = {{"Type", kLineTypes}};
constexpr SchemaField kTrianglesFields[] = {{1, "pose", kPoseType},
                                            {2, "points", kPointType, true},
                                            {3, "color", kColorType},
                                            {4, "colors", kColorType, true},
                                            {5, "indices", "fixed32", true}};
constexpr SchemaField kTextFields[] = {{1, "pose", kPoseType},     {2, "billboard", "bool"},
                                       {3, "font_size", "double"}, {4, "scale_invariant", "bool"},
                                       {5, "color", kColorType},   {6, "text", "string"}};
constexpr SchemaField kModelFields[] = {{1, "pose", kPoseType},   {2, "scale", kVectorType},
                                        {3, "color", kColorType}, {4, "override_color", "bool"},
                                        {5, "url", "string"},     {6, "media_type", "string"},
                                        {7, "data", "bytes"}};
constexpr SchemaField kEntityFields[] = {{1, "timestamp", kTimeType},
                                         {2, "frame_id", "string"},
                                         {3, "id", "string"},
                                         {4, "lifetime", kDurationType},
                                         {5, "frame_locked", "bool"},
                                         {6, "metadata", kPairType, true},
                                         {7, "arrows", "foxglove.ArrowPrimitive", true},
                                         {8, "cubes", "foxglove.CubePrimitive", true},
                                         {9, "spheres", "foxglove.SpherePrimitive", true},
                                         {10, "cylinders", "foxglove.CylinderPrimitive", true},
                                         {11, "lines", "foxglove.LinePrimitive", true},
                                         {12, "triangles", "foxglove.TriangleListPrimitive", true},
                                         {13, "texts", "foxglove.TextPrimitive", true},
                                         {14, "models", "foxglove.ModelPrimitive", true}};
constexpr SchemaField kDeletionFields[] = {{1, "timestamp", kTimeType},
                                           {2, "type", "foxglove.SceneEntityDeletion.Type"},
                                           {3, "id", "string"}};
constexpr EnumValue kDeletionTypes[] = {{"MATCHING_ID", 0}, {"ALL", 1}};
constexpr SchemaEnum kDeletionEnums[] = {{"Type", kDeletionTypes}};
constexpr SchemaField kSceneUpdateFields[] = {
    {1, "deletions", "foxglove.SceneEntityDeletion", true},
    {2, "entities", "foxglove.SceneEntity", true}};

constexpr SchemaField kElementFields[] = {{1, "name", "string"},
                                          {2, "offset", "fixed32"},
                                          {3, "type", "foxglove.PackedElementField.NumericType"}};
constexpr EnumValue kElementTypes[] = {{"UNKNOWN", 0}, {"UINT8", 1},   {"INT8", 2},
                                       {"UINT16", 3},  {"INT16", 4},   {"UINT32", 5},
                                       {"INT32", 6},   {"FLOAT32", 7}, {"FLOAT64", 8}};
constexpr SchemaEnum kElementEnums[] = {{"NumericType", kElementTypes}};
constexpr SchemaField kPointCloudFields[] = {{1, "timestamp", kTimeType},
                                             {2, "frame_id", "string"},
                                             {3, "pose", kPoseType},
                                             {4, "point_stride", "fixed32"},
                                             {5, "fields", "foxglove.PackedElementField", true},
                                             {6, "data", "bytes"}};

constexpr SchemaField kLocationFixFields[] = {
    {6, "timestamp", kTimeType},
    {7, "frame_id", "string"},
    {1, "latitude", "double"},
    {2, "longitude", "double"},
    {3, "altitude", "double"},
    {4, "position_covariance", "double", true},
    {5, "position_covariance_type", "foxglove.LocationFix.PositionCovarianceType"},
    {8, "color", kColorType},
    {9, "metadata", kPairType, true}};
constexpr EnumValue kCovarianceTypes[] = {
    {"UNKNOWN", 0}, {"APPROXIMATED", 1}, {"DIAGONAL_KNOWN", 2}, {"KNOWN", 3}};
constexpr SchemaEnum kCovarianceEnums[] = {{"PositionCovarianceType", kCovarianceTypes}};

constexpr SchemaField kLogFields[] = {
    {1, "timestamp", kTimeType}, {2, "level", "foxglove.Log.Level"},
    {3, "message", "string"},    {4, "name", "string"},
    {5, "file", "string"},       {6, "line", "fixed32"}};
constexpr EnumValue kLevels[] = {{"UNKNOWN", 0}, {"DEBUG", 1}, {"INFO", 2},
                                 {"WARNING", 3}, {"ERROR", 4}, {"FATAL", 5}};
constexpr SchemaEnum kLogEnums[] = {{"Level", kLevels}};

constexpr SchemaField kDriveStateFields[] = {{1, "timestamp", kTimeType},
                                             {2, "t_s", "double"},
                                             {3, "x_m", "double"},
                                             {4, "y_m", "double"},
                                             {5, "heading_rad", "double"},
                                             {6, "speed_mps", "double"},
                                             {7, "acceleration_mps2", "double"},
                                             {8, "steering_rad", "double"},
                                             {9, "curvature_per_m", "double"}};
constexpr SchemaField kClearanceFields[] = {{1, "timestamp", kTimeType},
                                            {2, "clearance_m", "double"}};

constexpr SchemaField kHypothesisFields[] = {
    {1, "maneuver", "string"},  {2, "end_d_m", "double"},    {3, "end_l_m", "double"},
    {4, "path_cost", "double"}, {5, "drive_cost", "double"}, {6, "is_driven", "bool"},
    {7, "reason", "string"}};
constexpr SchemaField kHypothesesFields[] = {{1, "timestamp", kTimeType},
                                             {2, "hypotheses", "roadbed.Hypothesis", true}};
constexpr SchemaField kCandidatesFields[] = {{1, "timestamp", kTimeType},
                                             {2, "start_s_m", "double"},
                                             {3, "start_d_m", "double"},
                                             {4, "start_d_slope", "double"},
                                             {5, "start_d_curvature_per_m", "double"},
                                             {6, "end_d_m", "double", true},
                                             {7, "end_l_m", "double", true},
                                             {8, "causes", "bytes"},
                                             {9, "cause_names", "string", true}};

constexpr SchemaMessage kSchemaMessages[] = {
    {"google.protobuf", "Timestamp", kSecondsFields},
    {"google.protobuf", "Duration", kSecondsFields},
    {"foxglove", "Vector3", kXyzFields},
    {"foxglove", "Point3", kXyzFields},
    {"foxglove", "Quaternion", kXyzwFields},
    {"foxglove", "Color", kRgbaFields},
    {"foxglove", "Pose", kPoseFields},
    {"foxglove", "KeyValuePair", kPairFields},
    {"foxglove", "FrameTransform", kFrameTransformFields},
    {"foxglove", "PosesInFrame", kPosesInFrameFields},
    {"foxglove", "ArrowPrimitive", kArrowFields},
    {"foxglove", "CubePrimitive", kCubeFields},
    {"foxglove", "SpherePrimitive", kCubeFields},
    {"foxglove", "CylinderPrimitive", kCylinderFields},
    {"foxglove", "LinePrimitive", kLineFields, kLineEnums},
    {"foxglove", "TriangleListPrimitive", kTrianglesFields},
    {"foxglove", "TextPrimitive", kTextFields},
    {"foxglove", "ModelPrimitive", kModelFields},
    {"foxglove", "SceneEntity", kEntityFields},
    {"foxglove", "SceneEntityDeletion", kDeletionFields, kDeletionEnums},
    {"foxglove", "SceneUpdate", kSceneUpdateFields},
    {"foxglove", "PackedElementField", kElementFields, kElementEnums},
    {"foxglove", "PointCloud", kPointCloudFields},
    {"foxglove", "LocationFix", kLocationFixFields, kCovarianceEnums},
    {"foxglove", "Log", kLogFields, kLogEnums},
    {"roadbed", "DriveState", kDriveStateFields},
    {"roadbed", "Clearance", kClearanceFields},
    {"roadbed", "Hypothesis", kHypothesisFields},
    {"roadbed", "Hypotheses", kHypothesesFields},
    {"roadbed", "Candidates", kCandidatesFields},
};

const SchemaMessage* find_message(std::string_view type) {
  const auto found = std::ranges::find(kSchemaMessages, type, &SchemaMessage::full_name);
  return found == std::end(kSchemaMessages) ? nullptr : found;
}

// descriptor.proto: FieldDescriptorProto.Type and .Label
constexpr EnumValue kScalarTypes[] = {{"double", 1}, {"int64", 3},  {"int32", 5}, {"fixed32", 7},
                                      {"bool", 8},   {"string", 9}, {"bytes", 12}};
constexpr std::uint64_t kTypeMessage = 11, kTypeEnum = 14, kLabelOptional = 1, kLabelRepeated = 3;

ProtoWriter proto_of(const SchemaField& field) {
  ProtoWriter proto;
  proto.bytes(1, field.name)
      .whole(3, field.number)
      .whole(4, field.is_repeated ? kLabelRepeated : kLabelOptional);
  const auto scalar = std::ranges::find(kScalarTypes, field.type, &EnumValue::name);
  if (scalar != std::end(kScalarTypes)) return proto.whole(5, scalar->number);
  return proto.whole(5, find_message(field.type) != nullptr ? kTypeMessage : kTypeEnum)
      .bytes(6, "." + std::string(field.type));
}

ProtoWriter proto_of(const SchemaEnum& type) {
  ProtoWriter proto;
  proto.bytes(1, type.name);
  for (const EnumValue& value : type.values) {
    proto.message(2, ProtoWriter().bytes(1, value.name).whole(2, value.number));
  }
  return proto;
}

ProtoWriter proto_of(const SchemaMessage& message) {
  ProtoWriter proto;
  proto.bytes(1, message.name);
  for (const SchemaField& field : message.fields) proto.message(2, proto_of(field));
  for (const SchemaEnum& type : message.enums) proto.message(4, proto_of(type));
  return proto;
}

void add_with_parts(const SchemaMessage& message, std::set<const SchemaMessage*>& all) {
  if (!all.insert(&message).second) return;
  for (const SchemaField& field : message.fields) {
    if (const SchemaMessage* part = find_message(field.type)) add_with_parts(*part, all);
  }
}

/// A file that holds one message, as a FileDescriptorProto: "foxglove/Pose.proto".
std::string file_of(const SchemaMessage& message) {
  std::string folder(message.package), name(message.name);
  std::ranges::replace(folder, '.', '/');
  if (folder == "google/protobuf")
    std::ranges::transform(name, name.begin(), [](char letter) {
      return static_cast<char>(letter >= 'A' && letter <= 'Z' ? letter + ('a' - 'A') : letter);
    });
  return folder + "/" + name + ".proto";
}

ProtoWriter file_proto(const SchemaMessage& message) {
  ProtoWriter file;
  file.bytes(1, file_of(message)).bytes(2, message.package);
  std::set<std::string> needed;
  for (const SchemaField& field : message.fields) {
    if (const SchemaMessage* part = find_message(field.type)) needed.insert(file_of(*part));
  }
  for (const std::string& name : needed) file.bytes(3, name);
  return file.message(4, proto_of(message)).bytes(12, "proto3");
}

}  // namespace

McapSchema foxglove_schema(std::string_view type) {
  const SchemaMessage* message = find_message(type);
  if (message == nullptr) {
    throw std::invalid_argument("foxglove_schema: no message " + std::string(type));
  }
  std::set<const SchemaMessage*> all;
  add_with_parts(*message, all);
  ProtoWriter files;
  for (const SchemaMessage& part : kSchemaMessages) {  // those that others need come first
    if (all.contains(&part)) files.message(1, file_proto(part));
  }
  return {"protobuf", files.bytes()};
}

}  // namespace roadbed::map::logs
