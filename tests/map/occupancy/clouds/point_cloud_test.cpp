#include "roadbed/map/occupancy/clouds/point_cloud.h"
#include "roadbed/map/occupancy/clouds/read_point_cloud.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& bytes, const std::string& name) {
  return tests::refusal_of([&] { parse_point_cloud(bytes, name); });
}

template <typename Number>
void append(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

template <typename Number>
void put(std::string& bytes, std::size_t offset, Number value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

void expect_point(const PointCloud& cloud, std::size_t i, double x, double y, double z,
                  double within) {
  ASSERT_LT(i, cloud.points.size());
  EXPECT_NEAR(cloud.in_source(i).x(), x, within);
  EXPECT_NEAR(cloud.in_source(i).y(), y, within);
  EXPECT_NEAR(cloud.in_source(i).z(), z, within);
}

std::string pcd(const std::string& fields, const std::string& counts, const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\n" + fields + counts + "DATA " + data;
}
const std::string kFloats = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
const std::string kTwo = "WIDTH 2\nHEIGHT 1\nPOINTS 2\n";

TEST(Pcd, ReadsAsciiWithFieldsInAnyOrderAndCaseAndDropsWhatIsNotFinite) {
  const PointCloud cloud =
      parse_point_cloud(pcd("FIELDS rgb Z y X\nSIZE 4 4 8 4\nTYPE F F F F\nCOUNT 2 1 1 1\n",
                            "WIDTH 4\nHEIGHT 1\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS 4\n",
                            "ascii\n9 9 3 2 1\n9 9 nan 2 1\n\n9 9 6 -5 4.5\r\n9 9 1e400 0 0\n"),
                        "a.pcd");
  ASSERT_EQ(cloud.points.size(), 2u);
  expect_point(cloud, 0, 1, 2, 3, 0.0);
  expect_point(cloud, 1, 4.5, -5, 6, 0.0);
  EXPECT_EQ(cloud.dropped_not_finite, 2u);
  ASSERT_TRUE(cloud.sensor_in_source);
  EXPECT_EQ(*cloud.sensor_in_source, Eigen::Vector3d(1, 2, 3));
}

TEST(Pcd, KeepsMillimetresOfDoublesAtUtmMagnitude) {
  std::string body;
  for (const double value : {443210.125, 5400000.456, 120.5, 443211.250, 5400001.457, 121.5}) {
    append(body, value);
  }
  const PointCloud cloud = parse_point_cloud(
      pcd("FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\n", kTwo, "binary\n" + body), "a.pcd");
  expect_point(cloud, 0, 443210.125, 5400000.456, 120.5, 1e-6);
  expect_point(cloud, 1, 443211.250, 5400001.457, 121.5, 1e-6);
  EXPECT_EQ(cloud.origin_in_source.z(), 0.0);
}

TEST(Pcd, ReadsCompressedColumnsByALiteralRunAndAReference) {
  std::string plain;
  for (const float value : {1.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f}) append(plain, value);
  std::string packed;  // x of both points by a reference 4 bytes back, the rest as they are
  packed += std::string("\x03", 1) + plain.substr(0, 4) + std::string("\x40\x03", 2);
  packed += std::string("\x0f", 1) + plain.substr(8);
  std::string body;
  append(body, static_cast<std::uint32_t>(packed.size()));
  append(body, static_cast<std::uint32_t>(plain.size()));
  body += packed;
  const PointCloud cloud =
      parse_point_cloud(pcd(kFloats, kTwo, "binary_compressed\n" + body), "a.pcd");
  expect_point(cloud, 0, 1, 2, 4, 0.0);
  expect_point(cloud, 1, 1, 3, 5, 0.0);
}

TEST(Pcd, RefusesHeadersThatTheBodyDoesNotBearOut) {
  const std::string line = "ascii\n1 2 3\n";
  EXPECT_THAT(
      refusal(pcd(kFloats, "WIDTH 1000000000\nHEIGHT 1\nPOINTS 1000000000\n", line), "a.pcd"),
      HasSubstr("do not fit"));
  EXPECT_THAT(refusal(pcd(kFloats, "WIDTH 65537\nHEIGHT 65537\nPOINTS 131073\n", line), "a.pcd"),
              HasSubstr("WIDTH times HEIGHT"));
  EXPECT_THAT(
      refusal(pcd(kFloats, "WIDTH 1099511627776\nHEIGHT 1099511627776\nPOINTS 0\n", line), "a.pcd"),
      HasSubstr("at most 2^40"));
  EXPECT_THAT(
      refusal(pcd(kFloats, "WIDTH -1\nHEIGHT 1\nPOINTS 2000000000\n", "binary\nxx"), "a.pcd"),
      HasSubstr("\"-1\""));
  EXPECT_THAT(
      refusal(pcd("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1000000000\n", kTwo, line),
              "a.pcd"),
      HasSubstr("COUNT"));
  EXPECT_THAT(refusal(pcd(kFloats, kTwo, "binary\n123456789012345678901"), "a.pcd"),
              HasSubstr("get the whole file"));
  EXPECT_THAT(refusal(pcd(kFloats, kTwo, "ascii\n1 2 3\n"), "a.pcd"), HasSubstr("POINTS"));
  EXPECT_THAT(
      refusal(pcd(kFloats, "POINTS 3\n", "ascii\n1 2 3\n1 2 3\n\n\n\n\n\n\n\n\n\n"), "a.pcd"),
      HasSubstr("only 2 lines"));
}

TEST(Pcd, RefusesCompressedSizesThatAreNotThere) {
  std::string body;
  append(body, std::uint32_t{100});
  append(body, std::uint32_t{4000000000u});
  EXPECT_THAT(refusal(pcd(kFloats, kTwo, "binary_compressed\n" + body), "a.pcd"),
              HasSubstr("0 of 100"));
  put(body, 0, std::uint32_t{0});
  EXPECT_THAT(refusal(pcd(kFloats, kTwo, "binary_compressed\n" + body), "a.pcd"),
              HasSubstr("2 points of 12 bytes"));
  put(body, 4, std::uint32_t{24});
  EXPECT_THAT(refusal(pcd(kFloats, kTwo, "binary_compressed\n" + body), "a.pcd"), HasSubstr("LZF"));
}

TEST(Pcd, RefusesLzfWithReferencesBeforeTheStartAndSizesThatDoNotFit) {
  const auto refusal_of = [](const std::string& packed) {
    std::string body;
    append(body, static_cast<std::uint32_t>(packed.size()));
    append(body, std::uint32_t{24});
    return refusal(pcd(kFloats, kTwo, "binary_compressed\n" + body + packed), "a.pcd");
  };
  const std::string literals = "\x16" + std::string(23, '\0');  // 23 bytes as they are
  EXPECT_EQ(refusal_of(literals + std::string("\0q", 2)), "accepted");
  EXPECT_THAT(refusal_of(literals), HasSubstr("LZF"));
  EXPECT_THAT(refusal_of(literals + std::string("\x20\x00", 2)), HasSubstr("LZF"));  // 26 bytes
  EXPECT_THAT(refusal_of(std::string("\x20\x00", 2)), HasSubstr("LZF"));
  EXPECT_THAT(refusal_of(std::string("\x00q\x20\x05", 4)), HasSubstr("LZF"));
  EXPECT_THAT(refusal_of(std::string("\x00q\xe0", 3)), HasSubstr("LZF"));
  EXPECT_THAT(refusal_of("\x16q"), HasSubstr("LZF"));
}

TEST(Pcd, RefusesWhatIsNotACloudInOneLine) {
  EXPECT_THAT(refusal("garbage\n", "a.pcd"), HasSubstr("unknown word \"garbage\""));
  EXPECT_THAT(refusal("VERSION 0.7\n", "a.pcd"), HasSubstr("without a DATA line"));
  EXPECT_THAT(refusal(pcd(kFloats, "", "ascii\n1 2 3\n"), "a.pcd"), HasSubstr("number of points"));
  EXPECT_THAT(
      refusal(pcd("FIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\n", kTwo, "ascii\n1 2\n1 2\n"), "a"),
      HasSubstr("no field z"));
  EXPECT_THAT(
      refusal(pcd("FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\n", kTwo, "ascii\n1 2 3\n1 2 3\n"), "a"),
      HasSubstr("F 3 of field z"));
  EXPECT_THAT(refusal(pcd(kFloats, kTwo, "ascii\n1 2 3\n1 abc 3\n"), "a.pcd"),
              HasSubstr("a.pcd:12: point: \"abc\" is not a number"));
  EXPECT_THAT(refusal(pcd(kFloats, kTwo, "ascii\n1 2 3\n1 2    \n"), "a.pcd"),
              HasSubstr("has 2 values"));
  EXPECT_THAT(refusal(pcd(kFloats, kTwo, "zip\n1 2 3\n"), "a.pcd"), HasSubstr("\"zip\""));
  EXPECT_THAT(refusal(pcd(kFloats, kTwo, "ascii\nnan 0 0\n0 inf 0\n"), "a.pcd"),
              HasSubstr("none of its 2 points is finite"));
  EXPECT_THAT(refusal(pcd(kFloats, "POINTS 0\n", "ascii\n"), "a.pcd"), HasSubstr("holds no point"));
  EXPECT_THROW(read_point_cloud("no-such.pcd"), InputError);
}

TEST(Ply, ReadsDoublesOfEitherByteOrderPastListsOfAnEarlierElement) {
  const std::string header =
      "element face 2\nproperty list uchar int vertex_indices\nelement vertex 2\n"
      "property uchar red\nproperty double x\nproperty double y\nproperty float z\nend_header\n";
  for (const bool big_endian : {false, true}) {
    std::string body;
    const auto number = [&](auto value) {
      std::string raw;
      append(raw, value);
      body += big_endian ? std::string(raw.rbegin(), raw.rend()) : raw;
    };
    number(std::uint8_t{3});
    for (const std::int32_t index : {0, 1, 2}) number(index);
    number(std::uint8_t{0});
    for (const double x : {5400000.125, 5400002.375}) {
      number(std::uint8_t{200});
      number(x);
      number(-2.5);
      number(0.75f);
    }
    const std::string order = big_endian ? "binary_big_endian" : "binary_little_endian";
    const PointCloud cloud =
        parse_point_cloud("ply\nformat " + order + " 1.0\ncomment c\n" + header + body, "a.ply");
    ASSERT_EQ(cloud.points.size(), 2u) << order;
    expect_point(cloud, 0, 5400000.125, -2.5, 0.75, 1e-6);
    expect_point(cloud, 1, 5400002.375, -2.5, 0.75, 1e-6);
  }
}

TEST(Ply, ReadsAsciiAndRefusesCountsTypesAndEnds) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 2\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\nend_header\n";
  expect_point(parse_point_cloud(head + xyz + "1 2 3\n\n4 5 6\n", "a"), 1, 4, 5, 6, 0.0);
  EXPECT_THAT(refusal(head + xyz + "1 2 3\n", "a.ply"), HasSubstr("a.ply"));
  EXPECT_THAT(refusal(head + xyz + "1 2 3\n1 two 3\n", "a.ply"), HasSubstr("\"two\""));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 2000000000\n" + xyz, "a.ply"),
              HasSubstr("do not fit"));
  EXPECT_THAT(
      refusal("ply\nformat binary_little_endian 1.0\nelement vertex 2\n" + xyz + "12345678901",
              "a.ply"),
      HasSubstr("do not fit"));
  EXPECT_THAT(refusal(head + "property float128 x\n", "a.ply"), HasSubstr("float128"));
  EXPECT_THAT(refusal(head + "property float x\nend_header\n1\n2\n", "a.ply"),
              HasSubstr("no property y"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nend_header\n", "a.ply"),
              HasSubstr("no element vertex"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\n", "a.ply"), HasSubstr("without end_header"));
  EXPECT_THAT(refusal("ply\nelement vertex 1\n" + xyz, "a.ply"), HasSubstr("no format line"));
}

std::string las(std::uint8_t minor, std::uint32_t points) {
  std::string bytes(minor == 4 ? 375 : 227, '\0');
  bytes.replace(0, 4, "LASF");
  put(bytes, 24, std::uint8_t{1});
  put(bytes, 25, minor);
  put(bytes, 94, static_cast<std::uint16_t>(bytes.size()));
  put(bytes, 96, static_cast<std::uint32_t>(bytes.size()));
  put(bytes, 105, std::uint16_t{20});
  if (minor == 4) {
    put(bytes, 247, std::uint64_t{points});
  } else {
    put(bytes, 107, points);
  }
  const double scale[] = {0.001, 0.01, 0.1}, offset[] = {500000.0, 5400000.0, -10.0};
  std::memcpy(bytes.data() + 131, scale, sizeof scale);
  std::memcpy(bytes.data() + 155, offset, sizeof offset);
  for (std::uint32_t i = 0; i < points; ++i) {
    for (const std::int32_t steps : {123456, -7, 50}) append(bytes, steps + static_cast<int>(i));
    bytes.append(8, '\0');
  }
  return bytes;
}

TEST(Las, AppliesScaleAndOffsetInEveryVersion) {
  for (std::uint8_t minor = 0; minor <= 4; ++minor) {
    const PointCloud cloud = parse_point_cloud(las(minor, 3), "a.las");
    ASSERT_EQ(cloud.points.size(), 3u);
    expect_point(cloud, 0, 500123.456, 5399999.93, -5.0, 1e-5);
    expect_point(cloud, 2, 500123.458, 5399999.95, -4.8, 1e-5);
  }
}

TEST(Las, RefusesPointsPackedWithoutARecordOfItAndCutFiles) {
  std::string laz = las(2, 1);
  put(laz, 104, std::uint8_t{0x80});
  EXPECT_THAT(refusal(laz, "a.laz"), HasSubstr("laszip encoded"));
  EXPECT_THAT(refusal(las(2, 3).substr(0, 270), "a.las"), HasSubstr("ends after 2"));
  EXPECT_THAT(refusal("LASF", "a.las"), HasSubstr("header"));
  std::string wild = las(2, 1);
  put(wild, 107, std::uint32_t{4000000000u});
  EXPECT_THAT(refusal(wild, "a.las"), HasSubstr("4000000000, but the file ends after 1"));
  std::string short_record = las(2, 1);
  put(short_record, 105, std::uint16_t{0});
  EXPECT_THAT(refusal(short_record, "a.las"), HasSubstr("records of 0 bytes"));
  std::string flat = las(2, 1);
  put(flat, 131, 0.0);
  EXPECT_THAT(refusal(flat, "a.las"), HasSubstr("scale"));
}

TEST(Xyz, ReadsCommasSpacesCommentsCountsAndNamedColumns) {
  const PointCloud spaces = parse_point_cloud("3\n# c\n1 2 3 255\n-1\t2.5 1e1\n", "a.xyz");
  ASSERT_EQ(spaces.points.size(), 2u);
  expect_point(spaces, 1, -1, 2.5, 10, 0.0);
  const PointCloud named = parse_point_cloud("i;\"Z\";x_m; y\n7;3;1;2\n7;nan;1;2\n", "a.csv");
  ASSERT_EQ(named.points.size(), 1u);
  expect_point(named, 0, 1, 2, 3, 0.0);
  EXPECT_EQ(named.dropped_not_finite, 1u);
  EXPECT_THAT(refusal("1 2 3\n1 2\n", "a.xyz"), HasSubstr("a.xyz:2: point: has 2 values"));
  EXPECT_THAT(refusal("1,2,3\n1,,3\n", "a.xyz"), HasSubstr("not a number"));
  EXPECT_THAT(refusal("hello world again\n", "a.xyz"), HasSubstr("\"hello\""));
  EXPECT_THAT(refusal("\x7f\x45\x4c\x46", "a.out"), HasSubstr("no known point cloud format"));
}

TEST(Kitti, ReadsFourFloatsAPointAndFiveOfNuScenes) {
  for (const bool has_ring : {false, true}) {
    std::string bytes;
    for (const float value : {1.5f, -2.25f, 0.1f, 0.9f}) append(bytes, value);
    if (has_ring) append(bytes, 7.0f);
    for (const float value : {-80.0f, NAN, 3.0f, 0.0f}) append(bytes, value);
    if (has_ring) append(bytes, 8.0f);
    const PointCloud cloud = parse_point_cloud(bytes, has_ring ? "a.pcd.bin" : "a.bin");
    ASSERT_EQ(cloud.points.size(), 1u);
    EXPECT_EQ(cloud.in_source(0), Eigen::Vector3d(1.5, -2.25, 0.1f));
    EXPECT_EQ(cloud.dropped_not_finite, 1u);
  }
}

TEST(Kitti, RefusesWhatIsNoScan) {
  EXPECT_THAT(refusal(std::string(15, '\0'), "a.bin"), HasSubstr("15 bytes, needs 16"));
  EXPECT_THAT(refusal(std::string(64, 'A') + std::string(64, 'z'), "a.bin"), HasSubstr("km"));
}

}  // namespace
}  // namespace roadbed::map
