// The file has plain numbers between the tags <Vertices>, <Faces> and <Tags> of each <Triangulation>. The <TagNameMap> with tag names comes last.
#include "io/surface/surface_dwfs.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "io/input/file_buffer.h"
#include "io/input/xml_tags.h"
#include "io/mesh/surface_builder.h"
#include "io/output/surface_output.h"

namespace sterna::io {
namespace {

/// The tags of one triangulation.
struct Triangulation {
  const XmlTag* vertices = nullptr;
  const XmlTag* faces = nullptr;
  const XmlTag* tags = nullptr;
  std::map<std::int64_t, std::string> names;
};

class DwfsReader {
 public:
  DwfsReader(const FileBuffer& buffer, const RunContext& context) : buffer_(buffer), context_(context), builder_(buffer.source) {}

  SurfaceSoup read() {
    const std::vector<XmlTag> tags = scan_xml_tags(buffer_.text(), "", buffer_.source);
    std::vector<Triangulation> parts;
    for (const XmlTag& tag : tags) {
      if (tag.name == "Triangulation") parts.emplace_back();
      if (parts.empty()) continue;
      if (tag.name == "Vertices") parts.back().vertices = &tag;
      if (tag.name == "Faces") parts.back().faces = &tag;
      if (tag.name == "Tags") parts.back().tags = &tag;
      if (tag.name == "TagName") parts.back().names[number_in(tag, "tag")] = tag.attribute("name");
    }
    if (parts.empty()) throw_malformed(buffer_.source, "byte 0", "found no <Triangulation>, expected a mesh of sumo (dwfs)");
    for (const Triangulation& part : parts) take(part);
    SurfaceSoup soup = builder_.finish(context_);
    soup.has_names = has_tags_;
    return soup;
  }

 private:
  void take(const Triangulation& part) {
    if (!part.vertices || !part.faces)
      throw_malformed(buffer_.source, "byte 0", "a <Triangulation> has no " + std::string(part.vertices ? "<Faces>" : "<Vertices>"));
    const std::vector<double> coordinates = numbers<double>(*part.vertices, 3);
    const std::vector<std::int64_t> corners = numbers<std::int64_t>(*part.faces, 3);
    const std::size_t n_points = coordinates.size() / 3, n_faces = corners.size() / 3, first = builder_.n_points();
    std::vector<std::int64_t> tags;
    if (part.tags) tags = numbers<std::int64_t>(*part.tags, 1);
    if (!tags.empty() && tags.size() != n_faces)
      fail(*part.tags, "found " + std::to_string(tags.size()) + " tags, expected " + std::to_string(n_faces) + ", one for each face");
    for (std::size_t i = 0; i < n_points; ++i) builder_.add_point({coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]});
    context_.check_stop();
    const auto corner = [&](std::size_t i) {
      if (corners[i] < 0 || static_cast<std::uint64_t>(corners[i]) >= n_points)
        fail(*part.faces,
             "face " + std::to_string(i / 3) + " has the corner " + std::to_string(corners[i]) + ", expected 0 to " + std::to_string(n_points) + " - 1");
      return static_cast<std::uint32_t>(first + static_cast<std::size_t>(corners[i]));
    };
    for (std::size_t i = 0; i < n_faces; ++i) {
      if (!tags.empty() && (i == 0 || tags[i] != tags[i - 1])) {
        const auto name = part.names.find(tags[i]);
        builder_.set_patch(name == part.names.end() || name->second.empty() ? numbered_patch(tags[i]) : name->second);
      }
      builder_.add_triangle(corner(3 * i), corner(3 * i + 1), corner(3 * i + 2));
    }
    has_tags_ = has_tags_ || !tags.empty();
  }

  /// Reads all numbers of a tag. "count" may be the number of values, or of items of `per_item` values.
  template <class T>
  std::vector<T> numbers(const XmlTag& tag, std::size_t per_item) const {
    std::vector<T> values;
    const char* at = tag.text.data();
    const char* const end = at + tag.text.size();
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
    for (;;) {
      at = std::find_if_not(at, end, is_blank);
      if (at == end) break;
      T value{};
      const auto [next, failure] = std::from_chars(at, end, value);
      const bool is_good = failure == std::errc{} && (next == end || is_blank(*next));
      if (!is_good)
        throw_malformed(
            buffer_.source, "byte " + std::to_string(at - buffer_.bytes.data()),
            "found " + quoted_excerpt({at, std::min<std::size_t>(static_cast<std::size_t>(end - at), 20)}) + " in <" + tag.name + ">, expected a number");
      values.push_back(value);
      at = next;
    }
    const std::string found = std::to_string(values.size());
    if (values.size() % per_item != 0) fail(tag, "found " + found + " numbers, not a multiple of " + std::to_string(per_item));
    if (!tag.attribute("count").empty()) {
      const std::int64_t count = number_in(tag, "count");
      if (count < 0 || (static_cast<std::uint64_t>(count) != values.size() && static_cast<std::uint64_t>(count) != values.size() / per_item))
        fail(tag, "found " + found + " numbers, expected " + std::to_string(count) + " (count) times " + std::to_string(per_item),
             "the file may have been cut short: copy or write it again");
    }
    return values;
  }

  std::int64_t number_in(const XmlTag& tag, std::string_view key) const {
    const std::string_view text = tag.attribute(key);
    std::int64_t value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || failure != std::errc{} || end != text.data() + text.size())
      fail(tag, "found " + quoted_excerpt(text) + " as \"" + std::string(key) + "\", expected an integer");
    return value;
  }

  [[noreturn]] void fail(const XmlTag& tag, const std::string& problem, std::string_view hint = {}) const {
    throw_malformed(buffer_.source, "byte " + std::to_string(tag.offset), "<" + tag.name + ">: " + problem, hint);
  }

  const FileBuffer& buffer_;
  const RunContext& context_;
  SurfaceBuilder builder_;
  bool has_tags_ = false;
};

}  // namespace

SurfaceSoup read_dwfs(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  return DwfsReader(buffer, context).read();
}

void write_dwfs(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const auto begin = [](const char* tag, std::size_t n) { return "<" + std::string(tag) + " count=\"" + std::to_string(n) + "\">\n"; };
  std::string names = "</Tags>\n<TagNameMap>\n";
  for (const PatchId patch : mesh.patches.ids())
    names += "<TagName tag=\"" + std::to_string(patch.value() + 1) + "\" name=\"" + xml_escaped(mesh.patches[patch].name) + "\"/>\n";
  names += "</TagNameMap>\n</Triangulation>\n</Mesh>\n";
  write_file(path,
             {fixed_section("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Mesh>\n<Triangulation>\n" + begin("Vertices", mesh.n_vertices())),
              point_lines(mesh, ""), fixed_section("</Vertices>\n" + begin("Faces", mesh.n_triangles())), triangle_lines(mesh, "", 0),
              fixed_section("</Faces>\n" + begin("Tags", mesh.n_triangles())), patch_number_lines(mesh), fixed_section(std::move(names))},
             context);
}

}  // namespace sterna::io
