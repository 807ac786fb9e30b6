// SU2: keys at the beginning of a line, blocks of lines behind them, in any order. Markers are patches; a file without markers gives its own triangles and
// quads. Lines may carry trailing indices (formats.md §2.2).
#include "io/surface_su2.h"

#include <algorithm>
#include <array>
#include <string>

#include "io/file_buffer.h"
#include "io/surface_builder.h"
#include "io/text_scanner.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_stop_interval = 1 << 16;
constexpr std::size_t k_min_line_bytes = 4;

struct Face {
  std::array<std::uint32_t, 4> nodes{};
  std::uint8_t size = 0;
  std::size_t offset = 0;  ///< in the file, for messages
};

struct Marker {
  std::string name;
  std::vector<Face> faces;
};

std::size_t nodes_of_type(std::int64_t type) {
  switch (type) {
    case 3: return 2;
    case 5: return 3;
    case 9: return 4;
    case 10: return 4;
    case 12: return 8;
    case 13: return 6;
    case 14: return 5;
    default: return 0;
  }
}

class Su2Reader {
 public:
  Su2Reader(const FileBuffer& buffer, const RunContext& context) : scanner_(buffer, {.comment = '%', .line_bound = true}), builder_(buffer.source), context_(context) {}

  SurfaceSoup read() {
    while (!scanner_.at_end()) {
      const std::string key = read_key();
      if (key == "NDIME") {
        if (scanner_.integer("the dimension") != 3) scanner_.fail_expected("3: sterna meshes in three dimensions");
        scanner_.next_line();
      } else if (key == "NZONE") {
        if (scanner_.integer("the number of zones") != 1) throw_unsupported(scanner_.source(), "several zones in one SU2 file", "give each zone a file of its own");
        scanner_.next_line();
      } else if (key == "NPOIN") read_points();
      else if (key == "NELEM") read_elements();
      else if (key == "NMARK") {
        scanner_.integer("the number of markers");
        scanner_.next_line();
      } else if (key == "MARKER_TAG") read_marker();
      else scanner_.next_line();
    }
    for (const Marker& marker : markers_) add_faces(marker);
    if (markers_.empty()) add_faces(elements_);
    SurfaceSoup soup = builder_.finish(true);
    soup.has_names = !markers_.empty();
    return soup;
  }

 private:
  /// "NPOIN=", "NPOIN=7" or "NPOIN =": the word before '='; what follows is left to be read.
  std::string read_key() {
    const std::string_view token = scanner_.peek();
    const std::size_t equals = token.find('=');
    std::string key(token.substr(0, equals));
    scanner_.token("a key such as NPOIN=");
    if (equals == std::string_view::npos) {
      if (scanner_.peek() == "=") scanner_.token("=");
      pending_.clear();
    } else {
      pending_ = std::string(token.substr(equals + 1));
    }
    return key;
  }

  std::size_t read_count(std::string_view expected) {
    if (pending_.empty()) return scanner_.count(expected, k_min_line_bytes);
    std::size_t n = 0;
    for (const char c : pending_) {
      if (c < '0' || c > '9' || n > scanner_.remaining()) scanner_.fail_expected(expected);
      n = 10 * n + static_cast<std::size_t>(c - '0');
    }
    if (n > scanner_.remaining() / k_min_line_bytes) scanner_.fail("found " + pending_ + ", more than the rest of the file can hold", "the file may have been cut short");
    return n;
  }

  void read_points() {
    const std::size_t n = read_count("the number of points");
    scanner_.next_line();
    builder_.reserve_points(n);
    for (std::size_t i = 0; i < n; ++i) {
      if (i % k_stop_interval == 0) context_.check_stop();
      Vec3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = scanner_.real("a coordinate of a point");
      builder_.add_point(p);
      scanner_.next_line();
    }
  }

  Face read_face(std::size_t n_nodes) {
    Face face;
    face.size = static_cast<std::uint8_t>(n_nodes);
    for (std::size_t k = 0; k < n_nodes; ++k) face.nodes[k] = scanner_.index("a point of a face", 0, 0xffffffffu);
    face.offset = scanner_.offset();
    return face;
  }

  void read_faces(std::size_t n, std::vector<Face>& faces) {
    scanner_.next_line();
    for (std::size_t i = 0; i < n; ++i) {
      if (i % k_stop_interval == 0) context_.check_stop();
      const std::int64_t type = scanner_.integer("an element type");
      const std::size_t n_nodes = nodes_of_type(type);
      if (n_nodes == 0 && type != 1) scanner_.fail_expected("an element type: 5, 9, 10, 12, 13 or 14");
      if (type == 5 || type == 9) faces.push_back(read_face(n_nodes));
      scanner_.next_line();
    }
  }

  void read_elements() { read_faces(read_count("the number of elements"), elements_.faces); }

  void read_marker() {
    Marker marker;
    marker.name = pending_.empty() ? std::string(scanner_.rest_of_line()) : pending_ + std::string(scanner_.peek());
    if (!pending_.empty()) scanner_.next_line();
    if (scanner_.at_end() || read_key() != "MARKER_ELEMS") scanner_.fail_expected("MARKER_ELEMS= behind MARKER_TAG=");
    const std::size_t n = read_count("the number of faces of the marker");
    if (marker.name == "SEND_RECEIVE") {  // legacy partitions: SEND_TO line, then n lines
      for (std::size_t i = 0; i < n + 2; ++i) scanner_.next_line();
      return;
    }
    read_faces(n, marker.faces);
    markers_.push_back(std::move(marker));
  }

  void add_faces(const Marker& marker) {
    builder_.set_patch(marker.name);
    for (const Face& face : marker.faces) {
      for (std::size_t k = 0; k < face.size; ++k) {
        if (face.nodes[k] < builder_.n_points()) continue;
        throw_malformed(scanner_.source(), "line " + std::to_string(scanner_.line_at(face.offset)),
                        "found point " + std::to_string(face.nodes[k]) + ", but the file has " + std::to_string(builder_.n_points()) + " points (numbered from 0)");
      }
      builder_.add_polygon(std::span(face.nodes).first(face.size));
    }
  }

  TextScanner scanner_;
  SurfaceBuilder builder_;
  const RunContext& context_;
  std::string pending_;  ///< what stood behind '=' without a blank
  Marker elements_;
  std::vector<Marker> markers_;
};

}  // namespace

SurfaceSoup read_su2(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  return Su2Reader(buffer, context).read();
}

}  // namespace sterna::io
