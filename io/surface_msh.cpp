// Gmsh MSH as a surface: triangles and quadrangles of any order by their corners; volume elements are passed over.
#include "io/surface_msh.h"

#include "io/msh_parser.h"
#include "io/surface_builder.h"

namespace sterna::io {
namespace {

class FaceSink final : public MshSink {
 public:
  explicit FaceSink(const std::string& source) : builder_(source) {}
  void reserve_points(std::size_t n) override { builder_.reserve_points(n); }
  void add_point(const Vec3& p) override { builder_.add_point(p); }
  void set_patch(std::string_view name) override { builder_.set_patch(name); }
  void add_face(std::span<const std::uint32_t> corners) override { builder_.add_polygon(corners); }
  void add_cell(std::int64_t, std::span<const std::uint32_t>) override {}
  void add_curved_cell() override {}
  SurfaceSoup finish() { return builder_.finish(true); }

 private:
  SurfaceBuilder builder_;
};

}  // namespace

SurfaceSoup read_msh(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  FaceSink sink(buffer.source);
  const bool has_names = parse_msh(buffer, context, sink);
  SurfaceSoup soup = sink.finish();
  soup.has_names = has_names || soup.patch_names.size() > 1;
  return soup;
}

}  // namespace sterna::io
