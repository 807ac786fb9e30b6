#include "scripting/cli/info_json.h"

#include <nlohmann/json.hpp>

#include "io/file/format_table.h"
#include "scripting/values/models.h"
#include "scripting/values/stored_stages.h"
#include "scripting/values/summary.h"
#include "scripting/values/verbs.h"
#include "scripting/values/wall_files.h"
#include "surfmesh/stitch/stitch_surface.h"

namespace sterna::scripting {
namespace {

using Json = nlohmann::ordered_json;

Json xyz(const Point& p) { return {p.x, p.y, p.z}; }
Json box_json(const Box& box) { return box.empty() ? Json(nullptr) : Json{{"min", xyz(box.min)}, {"max", xyz(box.max)}, {"longest_side", box.longest_side()}}; }

/// Sums for one patch.
struct PatchSum {
  std::int64_t n_triangles = 0, n_quads = 0;
  double area = 0.0;
};

Json patches_json(const Column<PatchId, Patch>& patches, const std::vector<PatchSum>& sums, const std::set<std::string>& unknown_kinds = {}) {
  Json list = Json::array();
  for (const PatchId p : patches.ids()) {
    const PatchSum& sum = sums[p.index()];
    list.push_back({{"name", patches[p].name},
                    {"kind", unknown_kinds.contains(patches[p].name) ? "unknown" : to_string(patches[p].kind)},
                    {"triangles", sum.n_triangles},
                    {"quads", sum.n_quads},
                    {"area", sum.area}});
  }
  return list;
}

double area_of(const Point& a, const Point& b, const Point& c) { return 0.5 * norm(cross(b - a, c - a)); }

Json of_volume(const MeshValue& value, double unit) {
  const HybridMesh& mesh = value.mesh;
  Box box;
  for (const Point& p : mesh.points) box.add(unit * p);
  std::vector<PatchSum> sums(mesh.patches.size());
  const auto at = [&](NodeId v) { return unit * mesh.points[v]; };
  for (const BoundaryTriangle& face : mesh.boundary_triangles) {
    ++sums[face.patch.index()].n_triangles;
    sums[face.patch.index()].area += area_of(at(face.nodes[0]), at(face.nodes[1]), at(face.nodes[2]));
  }
  for (const BoundaryQuad& face : mesh.boundary_quads) {
    ++sums[face.patch.index()].n_quads;
    sums[face.patch.index()].area +=
        area_of(at(face.nodes[0]), at(face.nodes[1]), at(face.nodes[2])) + area_of(at(face.nodes[0]), at(face.nodes[2]), at(face.nodes[3]));
  }
  const CellCounts cells = count_cells(mesh);
  return {
      {"kind", "volume mesh"},
      {"nodes", mesh.points.size()},
      {"cells",
       {{"total", cells.total()}, {"prisms", cells.prisms}, {"pyramids", cells.pyramids}, {"hexahedra", cells.hexahedra}, {"tetrahedra", cells.tetrahedra}}},
      {"box", box_json(box)},
      {"patches", patches_json(mesh.patches, sums, value.unknown_kinds)}};
}

Json of_surface(const std::filesystem::path& file, double unit, const CommandContext& context) {
  surfmesh::StitchOptions options;
  options.unit = unit;
  options.allow_open = true;
  options.check_intersections = false;
  const InputPath input{file.string(), file};
  const SurfaceValue wall = join_wall(read_wall_files(std::span(&input, 1), options, context.run.part("read", 0.0, 0.3)), context.run.part("stitch", 0.3, 1.0));
  std::vector<PatchSum> sums(wall.mesh.patches.size());
  for (const TriangleId t : wall.mesh.triangles.ids()) {
    PatchSum& sum = sums[wall.mesh.triangle_patch[t].index()];
    const std::array<Point, 3> p = corners(wall.mesh, t);
    ++sum.n_triangles;
    sum.area += area_of(p[0], p[1], p[2]);
  }
  return {{"kind", "surface"},
          {"triangles", wall.mesh.n_triangles()},
          {"vertices", wall.mesh.n_vertices()},
          {"is_closed", wall.report.is_closed},
          {"components", wall.report.n_components},
          {"box", box_json(bounding_box(wall.mesh))},
          {"patches", patches_json(wall.mesh.patches, sums)}};
}

Json part_json(const PartMeasures& part) {
  return {{"name", part.name},
          {"kind", part.kind},
          {"faces", part.n_faces},
          {"area", part.area},
          {"projected_area", part.projected_area},
          {"is_closed", part.is_closed},
          {"volume", part.is_closed ? Json(part.volume) : Json(nullptr)},
          {"box", box_json(part.box)}};
}

Json of_model(const std::string& file, std::optional<double> unit, const CommandContext& context) {
  const ModelValue value = read_model({file, file}, {.unit = unit.value_or(k_automatic)}, context.run.part("read", 0.0, 0.5));
  const ModelReport measures = measure_model(value, context.run.part("measure", 0.5, 1.0));
  Json json = {{"kind", "model"}};
  json["total"] = part_json(measures.total);
  json["box"] = box_json(measures.total.box);
  for (const char* name : {"components", "solids", "wings", "patches"}) json[name] = Json::array();
  for (const PartMeasures& part : measures.components) json["components"].push_back(part_json(part));
  for (const PartMeasures& part : measures.solids) json["solids"].push_back(part_json(part));
  for (const WingReference& wing : measures.wings)
    json["wings"].push_back({{"name", wing.name},
                             {"span", wing.span},
                             {"area", wing.area},
                             {"projected_area", wing.projected_area},
                             {"unrolled_area", wing.unrolled_area},
                             {"mean_geometric_chord", wing.mean_geometric_chord},
                             {"mean_aerodynamic_chord", wing.mean_aerodynamic_chord},
                             {"aerodynamic_chord_start", xyz(wing.aerodynamic_chord_start)},
                             {"aspect_ratio", wing.aspect_ratio}});
  std::vector<std::string> names;
  for (const ModelFace& face : value.model.faces)
    if (std::ranges::find(names, face.name) == names.end()) names.push_back(face.name);
  for (const std::string& name : names) json["patches"].push_back({{"name", name}});
  return json;
}

}  // namespace

std::string info_json(const std::string& file, std::optional<double> given_unit, const CommandContext& context) {
  Json json = {{"schema", "sterna-info-1"}, {"program", "sterna " STERNA_VERSION}, {"file", file}};
  if (is_model_file(file)) {
    json.update(of_model(file, given_unit, context));
    return json.dump(2) + "\n";
  }
  const io::Format& format = io::format_of(file);
  if (!std::filesystem::exists(file)) throw Error({.code = ErrorCode::file_not_found, .attempted = "reading " + file, .problem = "there is no such file"});
  json["format"] = format.name;
  const double unit = given_unit.value_or(1.0);
  json["unit"] = unit;
  if (format.read_volume) {
    const MeshValue mesh = read_mesh({file, file}, context.run);
    if (count_cells(mesh.mesh).total() > 0) {
      json.update(of_volume(mesh, unit));
      return json.dump(2) + "\n";
    }
  }
  json.update(of_surface(file, unit, context));
  return json.dump(2) + "\n";
}

}  // namespace sterna::scripting
