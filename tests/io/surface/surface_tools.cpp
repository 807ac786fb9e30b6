#include "tests/io/surface/surface_tools.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "tests/support/data.h"

namespace sterna::test {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string small_text(const char* name) { return bytes_of(corpus() / "io" / name); }

void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  ASSERT_TRUE(file.flush()) << path;
}

SurfaceSoup read_surface(const std::filesystem::path& path, std::vector<std::string>* warnings) {
  const RunContext context({.threads = 2, .log = [warnings](LogLevel level, std::string_view text) {
                              if (warnings && level == LogLevel::warning) warnings->emplace_back(text);
                            }});
  SurfaceSoup soup = io::read_surface_file(path, context);
  expect_sound(soup);
  return soup;
}

SurfaceSoup read_surface_text(const std::string& name, std::string_view content, std::vector<std::string>* warnings) {
  const std::filesystem::path path = scratch() / name;
  write_bytes(path, content);
  return read_surface(path, warnings);
}

void expect_sound(const SurfaceSoup& soup) {
  ASSERT_EQ(soup.patch.size(), soup.triangles.size());
  ASSERT_TRUE(soup.triangles.empty() || !soup.patch_names.empty());
  for (const auto& triangle : soup.triangles)
    for (const std::uint32_t corner : triangle) ASSERT_LT(corner, soup.points.size());
  for (const std::uint32_t patch : soup.patch) ASSERT_LT(patch, soup.patch_names.size());
  for (const Vec3& p : soup.points) ASSERT_TRUE(is_finite(p));
}

void expect_same_soup(const SurfaceSoup& a, const SurfaceSoup& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.patch, b.patch);
  EXPECT_EQ(a.patch_names, b.patch_names);
  EXPECT_EQ(a.has_names, b.has_names);
  EXPECT_EQ(a.single_precision, b.single_precision);
}

double volume_of(const SurfaceSoup& soup) {
  double volume = 0.0;
  for (const auto& t : soup.triangles) volume += dot(soup.points[t[0]], cross(soup.points[t[1]], soup.points[t[2]])) / 6.0;
  return volume;
}

std::map<std::string, int> triangles_by_patch(const SurfaceSoup& soup) {
  std::map<std::string, int> n;
  for (const std::uint32_t patch : soup.patch) ++n[soup.patch_names[patch]];
  return n;
}

std::string packed(std::string_view content) {
  const auto number = [](std::uint32_t value, int n_bytes) {
    std::string bytes;
    for (int i = 0; i < n_bytes; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xffu);
    return bytes;
  };
  std::uint32_t crc = 0xffffffffu;
  for (const char c : content) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) ? 0xedb88320u : 0u);
  }
  const auto size = static_cast<std::uint32_t>(content.size());
  EXPECT_LT(size, 65536u);
  return std::string("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10) + '\x01' + number(size, 2) + number(~size, 2) + std::string(content) + number(~crc, 4) +
         number(size, 4);
}

std::string with_crlf(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\n') result += '\r';
    result += c;
  }
  return result;
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

void expect_refused(const std::string& name, std::string_view content, ErrorCode code, const std::vector<std::string>& texts) {
  try {
    read_surface_text(name, content);
    ADD_FAILURE() << name << " was read, expected " << to_string(code) << "\n" << content.substr(0, 400);
  } catch (const Error& error) {
    EXPECT_EQ(to_string(error.code()), to_string(code)) << error.what();
    for (const std::string& text : texts) EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << "expected " << text << " in: " << error.what();
  }
}

}  // namespace sterna::test
