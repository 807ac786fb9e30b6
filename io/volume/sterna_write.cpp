#include <algorithm>
#include <cstring>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "io/container/chunked_file.h"
#include "io/grammar/sterna_parts.h"
#include "io/output/cell_sections.h"
#include "io/output/section_output.h"
#include "io/volume/sterna_file.h"

namespace sterna::io {
namespace {

static_assert(sizeof(NodeId) == 4 && sizeof(Vec3) == 24 && sizeof(std::array<NodeId, 6>) == 24,
              "arrays are written as they are in memory, so these types must have no padding");

/// Joins strings, each terminated with NUL.
std::string joined(const std::vector<std::string>& strings) {
  std::string text;
  for (std::string s : strings) {
    std::replace(s.begin(), s.end(), '\0', '_');
    text += s;
    text += '\0';
  }
  return text;
}

std::string joined(const Column<PatchId, Patch>& patches) {
  std::vector<std::string> strings;
  for (const Patch& patch : patches) {
    strings.emplace_back(to_string(patch.kind));
    strings.push_back(patch.name);
  }
  return joined(strings);
}

class PartWriter {
 public:
  PartWriter(AtomicFile& file, const RunContext& context) : writer_(file), context_(context) {}

  void add_surface(const TriMesh& surface, const part::SurfaceNames& names) {
    require_finite(surface.points.raw());
    require_size(surface.triangle_patch.size(), surface.n_triangles(), "patches of triangles");
    reals(names.points, 3, surface.points.raw());
    ids(names.triangles, 3, surface.triangles.raw());
    ids(names.triangle_patch, 1, surface.triangle_patch.raw());
    text(names.patches, joined(surface.patches));
  }

  void add_envelope(const StoredEnvelope& envelope, const TriMesh& surface) {
    // The envelope belongs to walls with layers only. It has fewer vertices than the surface if that has other patches, more if actuator discs are cut into it.
    const std::size_t n_lines = envelope.height.size();
    for (const std::size_t n : {envelope.direction.size(), envelope.target.size(), envelope.eq1.size(), envelope.cap.size(), envelope.limit.size()})
      require_size(n, n_lines, "values of an envelope");
    reals(part::k_direction, 3, envelope.direction.raw());
    reals(part::k_height, 1, envelope.height.raw());
    reals(part::k_target, 1, envelope.target.raw());
    reals(part::k_eq1, 1, envelope.eq1.raw());
    reals(part::k_cap, 1, envelope.cap.raw());
    bytes(part::k_limit, envelope.limit.raw());
    if (envelope.first_height.empty()) return;
    require_size(envelope.first_height.size(), surface.n_vertices(), "first heights of an envelope");
    reals(part::k_first_height, 1, envelope.first_height);
  }

  void add_tetrahedra(const StoredTetrahedra& tetrahedra) {
    integer(part::k_boundary_points, static_cast<std::int64_t>(tetrahedra.n_boundary_points));
    require_finite(tetrahedra.new_points);
    reals(part::k_new_points, 3, tetrahedra.new_points);
    ids(part::k_engine_tetrahedra, 4, tetrahedra.tetrahedra);
    if (tetrahedra.moved_nodes.empty()) return;
    require_size(tetrahedra.moved_points.size(), tetrahedra.moved_nodes.size(), "locations of moved nodes");
    require_finite(tetrahedra.moved_points);
    ids(part::k_moved_nodes, 1, tetrahedra.moved_nodes);
    reals(part::k_moved_points, 3, tetrahedra.moved_points);
  }

  void add_mesh(const HybridMesh& mesh) {
    const FacesByPatch checked(mesh);  // rejects faces without patch
    require_finite(mesh.points.raw());
    require_size(mesh.layers.is_collapsed.size(), mesh.layers.n_lines(), "marks of collapsed lines");
    reals(part::k_points, 3, mesh.points.raw());
    if (mesh.layers.n_lines() > 0) add_layers(mesh);
    ids(part::k_prisms, 6, mesh.prisms);
    ids(part::k_pyramids, 5, mesh.pyramids);
    ids(part::k_hexahedra, 8, mesh.hexahedra);
    ids(part::k_tetrahedra, 4, mesh.tetrahedra);
    faces(part::k_triangles, part::k_triangle_patch, mesh.boundary_triangles);
    faces(part::k_quads, part::k_quad_patch, mesh.boundary_quads);
    text(part::k_patches, joined(mesh.patches));
    if (!mesh.periodic.empty()) add_periodic(mesh.periodic);
  }

  void add_opened(const HybridMesh& layers) {
    version_ = std::max(version_, part::k_opened_version);
    prefix_ = part::k_opened;
    add_mesh(layers);
    prefix_.clear();
  }

  void text(std::string_view name, std::string_view value) { writer_.add_memory(named(name), NumberType::u8, 1, value.size(), value.data(), context_); }
  void finish() { writer_.finish(version_); }

 private:
  std::string named(std::string_view name) const { return prefix_ + std::string(name); }

  void add_periodic(const std::vector<PeriodicSides>& periodic) {
    std::vector<std::array<PatchId, 2>> patches;
    std::vector<Vec3> translations;
    for (const PeriodicSides& sides : periodic) {
      patches.push_back({sides.first, sides.second});
      translations.push_back(sides.translation);
    }
    ids(part::k_periodic_patches, 2, patches);
    require_finite(translations);
    reals(part::k_periodic_translations, 3, translations);
  }

  void add_layers(const HybridMesh& mesh) {
    const LayerBlock& layers = mesh.layers;
    integer(part::k_n_layers, layers.n_layers);
    ids(part::k_base, 3, layers.base);
    ids(part::k_first_node, 1, layers.first_node);
    bytes(part::k_is_collapsed, layers.is_collapsed);
    if (!layers.is_uniform()) {
      require_size(layers.line_layers.size(), layers.n_lines(), "numbers of layers of lines");
      ids(part::k_line_layers, 1, std::vector<std::uint32_t>(layers.line_layers.begin(), layers.line_layers.end()));
      version_ = std::max(version_, is_truncated(layers) ? part::k_truncated_version : part::k_line_layers_version);
    }
    const LayerRequest& request = mesh.request;
    if (!request.is_known()) return;
    const std::array<double, 2> numbers = {request.first_height, request.max_growth};
    writer_.add_memory(named(part::k_request), NumberType::f64, 1, numbers.size(), numbers.data(), context_);
    reals(part::k_request_target, 1, request.target_height);
    bytes(part::k_request_reason, request.reason);
    text(part::k_request_reasons, joined(request.reasons));
    for (const auto& [name, values] :
         {std::pair(part::k_request_first_height, &request.line_first_height), std::pair(part::k_request_first_room, &request.line_first_room),
          std::pair(part::k_request_boundary_layer, &request.line_boundary_layer), std::pair(part::k_request_max_growth, &request.line_max_growth)}) {
      if (values->empty()) continue;
      require_size(values->size(), layers.n_lines(), "requests of lines");
      reals(name, 1, *values);
    }
    if (request.line_layers.empty()) return;
    require_size(request.line_layers.size(), layers.n_lines(), "requests of lines");
    ids(part::k_request_layers, 1, std::vector<std::uint32_t>(request.line_layers.begin(), request.line_layers.end()));
  }

  static bool is_truncated(const LayerBlock& layers) {
    return std::ranges::any_of(layers.base, [&](const auto& b) {
      return layers.layers_of_line(b[0]) != layers.layers_of_line(b[1]) || layers.layers_of_line(b[0]) != layers.layers_of_line(b[2]);
    });
  }

  template <class T>
  void reals(std::string_view name, std::uint32_t n_components, const std::vector<T>& values) {
    static_assert(sizeof(T) % sizeof(double) == 0);
    writer_.add_memory(named(name), NumberType::f64, n_components, values.size() * (sizeof(T) / sizeof(double)), values.data(), context_);
  }
  template <class T>
  void ids(std::string_view name, std::uint32_t n_components, const std::vector<T>& values) {
    static_assert(sizeof(T) % sizeof(std::uint32_t) == 0);
    writer_.add_memory(named(name), NumberType::u32, n_components, values.size() * (sizeof(T) / sizeof(std::uint32_t)), values.data(), context_);
  }
  void bytes(std::string_view name, const std::vector<std::uint8_t>& values) {
    writer_.add_memory(named(name), NumberType::u8, 1, values.size(), values.data(), context_);
  }
  void integer(std::string_view name, std::int64_t value) { writer_.add_memory(named(name), NumberType::i64, 1, 1, &value, context_); }

  template <class Face>
  void faces(std::string_view nodes_name, std::string_view patch_name, const std::vector<Face>& faces) {
    constexpr std::size_t k_n = std::tuple_size_v<decltype(Face{}.nodes)>;
    writer_.add(
        named(nodes_name), NumberType::u32, k_n, k_n * faces.size(),
        [&faces](std::uint64_t begin, std::uint64_t end, char* out) {
          for (std::uint64_t i = begin; i < end; ++i) out = put_bytes(out, faces[i / k_n].nodes[i % k_n].value(), std::endian::little);
        },
        context_);
    writer_.add(
        named(patch_name), NumberType::u32, 1, faces.size(),
        [&faces](std::uint64_t begin, std::uint64_t end, char* out) {
          for (std::uint64_t i = begin; i < end; ++i) out = put_bytes(out, faces[i].patch.value(), std::endian::little);
        },
        context_);
  }

  void require_finite(const std::vector<Vec3>& points) const {
    parallel_for(context_, points.size(), [&](std::size_t i) {
      if (!is_finite(points[i])) throw_node_not_finite(i);
    });
  }
  static void require_size(std::size_t found, std::size_t expected, const std::string& what) {
    if (found != expected)
      throw Error({.code = ErrorCode::mesh_invalid,
                   .attempted = "writing a .sterna file",
                   .problem = "found " + std::to_string(found) + " " + what + ", expected " + std::to_string(expected)});
  }

  ChunkedWriter writer_;
  std::string prefix_;  ///< prefix of all array names
  std::uint32_t version_ = k_first_chunked_version;
  RunContext context_;
};

}  // namespace

void write_sterna(const SternaParts& parts, const std::filesystem::path& path, const RunContext& context) {
  if (parts.envelope && !parts.surface)
    throw Error({.code = ErrorCode::bad_argument, .attempted = "writing " + path.string(), .problem = "an envelope without its surface"});
  AtomicFile file(path);
  PartWriter writer(file, context);
  if (parts.surface) writer.add_surface(*parts.surface, part::k_surface);
  if (parts.farfield) writer.add_surface(*parts.farfield, part::k_farfield);
  if (parts.envelope) writer.add_envelope(*parts.envelope, *parts.surface);
  if (parts.tetrahedra) writer.add_tetrahedra(*parts.tetrahedra);
  if (parts.mesh) writer.add_mesh(*parts.mesh);
  if (parts.opened) writer.add_opened(*parts.opened);
  if (!parts.manifest.empty()) writer.text(part::k_manifest, parts.manifest);
  if (!parts.certificate.empty()) writer.text(part::k_certificate, parts.certificate);
  if (!parts.quality.empty()) writer.text(part::k_quality, parts.quality);
  writer.finish();
  const StageTimer timer(context, "sync");
  file.commit();
}

void write_volume_sterna(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) { write_sterna({.mesh = &mesh}, path, context); }
void write_surface_sterna(const TriMesh& surface, const std::filesystem::path& path, const RunContext& context) {
  write_sterna({.surface = &surface}, path, context);
}

}  // namespace sterna::io
