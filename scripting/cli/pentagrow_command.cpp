// `sterna pentagrow wall.stl case.cfg`, also started under the program name pentagrow.
#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <numbers>

#include <fmt/format.h>

#include "geom/base/error.h"
#include "geom/mesh/half.h"
#include "geom/mesh/quality.h"
#include "io/file/surface_file.h"
#include "io/output/atomic_file.h"
#include "scripting/cli/commands.h"
#include "scripting/cli/pentagrow_config.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/consumers.h"
#include "scripting/values/stored_stages.h"
#include "scripting/values/summary.h"
#include "scripting/values/verbs.h"
#include "scripting/verbs/half_verbs.h"

namespace sterna::scripting {
namespace {

// Fractions of the progress, as in `sterna mesh`.
constexpr double k_pentagrow_read_end = 0.05, k_pentagrow_mesh_end = 0.9;
constexpr std::size_t k_skew_classes = 15;
constexpr double k_class_degrees = 90.0 / k_skew_classes;

std::string contents_of(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error({.code = ErrorCode::file_not_found, .attempted = "reading " + file, .problem = "there is no such file, or it cannot be read"});
  return {std::istreambuf_iterator<char>(stream), {}};
}

SurfaceValue read_pentagrow_wall(const std::string& file, const PentagrowCase& given, const RunContext& context) {
  const std::filesystem::path path = file;
  if (!given.input_extension.empty() && path.extension() != given.input_extension)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "reading " + file,
                 .problem = "InputFormat is " + given.input_extension.substr(1) + ", but the name of the file has another format",
                 .hint = "leave InputFormat out, or rename the file"});
  surfmesh::StitchOptions reading;
  reading.allow_open = given.is_half;
  const std::array files = {InputPath{file, file}};
  SurfaceValue wall = read_wall(files, reading, context);
  if (!given.is_half || !wall.report.is_closed) return wall;
  HalfOptions half;
  half.at = given.cut;
  return half_surface(wall, half, context);
}

/// Returns the top faces of the layer with the patches of the wall triangles below.
/// \pre the wall triangles of the columns are the first boundary triangles, in the same order
TriMesh envelope_of(const HybridMesh& mesh) {
  TriMesh envelope;
  const LayerBlock& layers = mesh.layers;
  for (std::uint32_t line = 0; line < layers.n_lines(); ++line) envelope.points.push_back(mesh.points[layers.top(line)]);
  envelope.patches = mesh.patches;
  for (std::size_t c = 0; c < layers.n_columns(); ++c) {
    envelope.triangles.push_back({VertexId(layers.base[c][0]), VertexId(layers.base[c][1]), VertexId(layers.base[c][2])});
    envelope.triangle_patch.push_back(mesh.boundary_triangles[c].patch);
  }
  return envelope;
}

/// Returns the boundary of the tetrahedra: the envelope, and all boundary triangles after those of the wall.
TriMesh tetrahedra_boundary(const HybridMesh& mesh) {
  TriMesh boundary = envelope_of(mesh);
  std::vector<std::int64_t> vertex_of(mesh.points.size(), -1);
  for (std::uint32_t line = 0; line < mesh.layers.n_lines(); ++line) vertex_of[mesh.layers.top(line).index()] = line;
  for (std::size_t t = mesh.layers.n_columns(); t < mesh.boundary_triangles.size(); ++t) {
    std::array<VertexId, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const NodeId node = mesh.boundary_triangles[t].nodes[k];
      if (vertex_of[node.index()] < 0) {
        vertex_of[node.index()] = static_cast<std::int64_t>(boundary.points.size());
        boundary.points.push_back(mesh.points[node]);
      }
      corners[k] = VertexId(static_cast<std::uint64_t>(vertex_of[node.index()]));
    }
    boundary.triangles.push_back({corners[0], corners[2], corners[1]});  // boundary faces have normals out of the fluid, surfaces have normals into it
    boundary.triangle_patch.push_back(mesh.boundary_triangles[t].patch);
  }
  return boundary;
}

std::string skew_text(const HybridMesh& mesh) {
  std::array<std::int64_t, k_skew_classes> counts{};
  std::int64_t n = 0;
  const LayerBlock& layers = mesh.layers;
  for (std::size_t c = 0; c < layers.n_columns(); ++c) {
    for (int j = 0, n_prisms = layers.ends_of_column(c)[0]; j < n_prisms; ++j) {
      const Cell cell = layers.cell(c, j);
      WedgePoints corners;
      for (std::size_t k = 0; k < 6; ++k) corners[k] = mesh.points[cell.nodes[k]];
      const double degrees = skew_angle(corners) * 180.0 / std::numbers::pi;
      ++counts[std::min(k_skew_classes - 1, static_cast<std::size_t>(degrees / k_class_degrees))];
      ++n;
    }
  }
  std::string text = "# skew angle of the prisms, degrees: from, to, number, share\n";
  for (std::size_t i = 0; i < k_skew_classes; ++i)
    text += fmt::format("{:g} {:g} {} {:.6f}\n", static_cast<double>(i) * k_class_degrees, static_cast<double>(i + 1) * k_class_degrees, counts[i],
                        n > 0 ? static_cast<double>(counts[i]) / static_cast<double>(n) : 0.0);
  return text;
}

}  // namespace

int pentagrow_command(const CommandLine& line, const CommandContext& context) {
  const std::string config = line.word("config");
  PentagrowCase given = read_pentagrow_config(config.empty() ? std::string() : contents_of(config), config);
  for (const std::string& note : given.notes) context.run.warn(note);
  for (const auto& output : given.outputs) require_mesh_output(output);
  const SurfaceValue wall = read_pentagrow_wall(line.word("surface"), given, context.run.part("surface", 0.0, k_pentagrow_read_end));
  for (const volmesh::SizeSource& source : nearfield_sources(given, wall.mesh)) given.options.sources.push_back(source);

  const MeshValue mesh = make_volume_mesh(wall, given.options, {}, context.run.part("volume_mesh", k_pentagrow_read_end, k_pentagrow_mesh_end));
  const RunContext write_part = context.run.part("write", k_pentagrow_mesh_end, 1.0);
  for (const auto& output : given.outputs) write_mesh(mesh, output, {}, write_part);
  io::write_surface_file(envelope_of(mesh.mesh), "outermost.vtu", write_part);
  io::write_surface_file(tetrahedra_boundary(mesh.mesh), "boundaries.smesh", write_part);
  io::write_whole("sumcos.txt", skew_text(mesh.mesh));
  io::write_whole("diagnose.txt", "0 elements are tangled\n0 elements will fail the preprocessing test\n");
  context.console.end_progress();
  context.run.info(wrote_text(given.outputs));
  context.run.info("wrote outermost.vtu, boundaries.smesh, sumcos.txt and diagnose.txt");
  context.run.info(summary_text(mesh, consumers_of_files(given.outputs)));
  return k_exit_success;
}

}  // namespace sterna::scripting
