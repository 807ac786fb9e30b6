// A file has a title; then for each object its name, its parameters and its points in free format, separated by blanks, commas, slashes or line ends.
#include "io/surface/surface_wgs.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "io/input/file_buffer.h"
#include "io/input/text_limits.h"
#include "io/input/text_scanner.h"
#include "io/mesh/surface_builder.h"
#include "io/mesh/surface_grid.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_min_point_bytes = 6;  // "0 0 0" and a separator

/// Transformation of an object into the global system. The order is: rotation about x, y, z (degrees), translation, scale.
struct Placement {
  Vec3 rotation, translation, scale;

  Vec3 placed(Vec3 p) const {
    const auto turn = [](double& a, double& b, double degrees) {
      if (degrees == 0.0) return;
      const double angle = degrees * std::numbers::pi / 180.0;
      const double c = std::cos(angle), s = std::sin(angle), a0 = a;
      a = c * a0 - s * b;
      b = s * a0 + c * b;
    };
    turn(p.y, p.z, rotation.x);
    turn(p.z, p.x, rotation.y);
    turn(p.x, p.y, rotation.z);
    p = p + translation;
    return {p.x * scale.x, p.y * scale.y, p.z * scale.z};
  }
};

constexpr std::array<std::string_view, 4> k_mirrors = {"", "y = 0", "z = 0", "x = 0"};

class WgsReader {
 public:
  /// \param buffer a copy whose separators have been replaced by blanks
  WgsReader(const FileBuffer& buffer, const RunContext& context) : scanner_(buffer), context_(context), builder_(buffer.source) {}

  SurfaceSoup read() {
    scanner_.rest_of_line();  // title
    while (!scanner_.at_end()) take_object();
    if (n_objects_ == 0) scanner_.fail("found the end of the file, expected the name of an object after the title");
    for (std::size_t i = 1; i < k_mirrors.size(); ++i)
      if (!mirrored_[i].empty())
        context_.warn(scanner_.source() + ": mirror images at " + std::string(k_mirrors[i]) + ", which the file implies, are not made for " + mirrored_[i]);
    SurfaceSoup soup = builder_.finish(context_);
    soup.has_names = true;
    return soup;
  }

 private:
  void take_object() {
    std::string_view name = scanner_.rest_of_line();
    if (name.size() < 2 || name.front() != '\'' || name.back() != '\'')
      scanner_.fail("found " + quoted_excerpt(name) + ", expected the name of an object in single quotes");
    name = name.substr(1, name.size() - 2);
    name = name.substr(0, name.find_last_not_of(' ') + 1);
    ++n_objects_;
    scanner_.integer("the number of the object");
    const std::size_t n_lines = scanner_.count("the number of lines", k_min_point_bytes);
    const std::size_t n_points = scanner_.count("the number of points of a line", k_min_point_bytes);
    if (n_lines < 2 || n_points < 2)
      scanner_.fail("found a network of " + std::to_string(n_lines) + " lines of " + std::to_string(n_points) + " points, expected 2 or more of each");
    note_mirror(name, "local symmetry");
    const Placement placement{.rotation = triple("a rotation"), .translation = triple("a translation"), .scale = triple("a scale factor")};
    note_mirror(name, "global symmetry");
    if (n_lines > (scanner_.remaining() + 1) / k_min_point_bytes / n_points)
      scanner_.fail("the file ends before " + std::to_string(n_lines) + " times " + std::to_string(n_points) + " points of object " + quoted_excerpt(name),
                    "the file may have been cut short: copy or write it again");
    const auto first = static_cast<std::uint32_t>(builder_.n_points());
    for (std::size_t i = 0; i < n_lines * n_points; ++i) {
      if (i % k_stop_interval == 0) context_.check_stop();
      const Vec3 p = placement.placed(triple("a coordinate"));
      builder_.add_point(p);
    }
    builder_.set_patch(name.empty() ? numbered_patch(static_cast<std::int64_t>(n_objects_)) : std::string(name));
    add_network(builder_, first, n_points, n_lines);
  }

  void note_mirror(std::string_view object, std::string_view what) {
    const std::int64_t plane = scanner_.integer(what);
    if (plane < 0 || plane > 3) scanner_.fail_expected("0, 1, 2 or 3: " + std::string(what));
    std::string& list = mirrored_[static_cast<std::size_t>(plane)];
    list += (list.empty() ? "\"" : ", \"") + std::string(object) + "\"";
  }

  Vec3 triple(std::string_view expected) {
    Vec3 p;
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = scanner_.coordinate(expected);
    return p;
  }

  TextScanner scanner_;
  const RunContext& context_;
  SurfaceBuilder builder_;
  std::size_t n_objects_ = 0;
  std::array<std::string, 4> mirrored_;  ///< names of objects with a mirror image, by plane; 0: none
};

/// Replaces commas and slashes, which separate like blanks, except in quotes and in the title.
void blank_separators(FileBuffer& buffer) {
  bool is_quoted = false;
  bool is_title = true;
  for (char& c : buffer.bytes) {
    if (c == '\n' || c == '\r') is_title = is_quoted = false;
    if (is_title) continue;
    if (c == '\'') is_quoted = !is_quoted;
    if (!is_quoted && (c == ',' || c == '/')) c = ' ';
  }
}

}  // namespace

SurfaceSoup read_wgs(const std::filesystem::path& path, const RunContext& context) {
  FileBuffer buffer = load_file(path, context);
  blank_separators(buffer);
  return WgsReader(buffer, context).read();
}

}  // namespace sterna::io
