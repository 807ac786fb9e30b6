// polyMesh writer: five files, and cellZones if there are zones. Internal faces come first, ordered by their lower cell and then by the other cell; then the
// boundary, patch by patch. The writer also adds the minimum of case files without which no OpenFOAM tool starts.
#include <algorithm>
#include <cctype>
#include <iterator>
#include <limits>
#include <map>

#include "geom/base/error.h"
#include "geom/mesh/periodic.h"
#include "io/names/name_rules.h"
#include "io/output/atomic_folder.h"
#include "io/output/cell_sections.h"
#include "io/output/face_connectivity.h"
#include "io/output/section_output.h"
#include "io/volume/volume_foam.h"

namespace sterna::io {
namespace {

constexpr std::uint64_t k_max_label = std::numeric_limits<std::int32_t>::max();
constexpr std::size_t k_most_foam_faces = 6;
constexpr std::size_t k_max_label_text = 11;                             // with a blank or a line end
constexpr std::size_t k_max_face_text = 2 + 4 * k_max_label_text + 2;    // "4(1 2 3 4)\n"
constexpr std::size_t k_max_point_text = 3 * (k_max_real_text + 1) + 3;  // "(1 2 3)\n"

/// The second of two periodic sides in OpenFOAM's order. Its faces are in the order of the first side, and each begins with the partner of the first face's
/// first node.
struct CyclicSide {
  std::vector<std::uint32_t> triangles, quads;
  std::vector<std::uint8_t> triangle_begins, quad_begins;  ///< index of that node
};

/// Orders the second side.
/// \pre `match` belongs to these sides
CyclicSide order_cyclic(const HybridMesh& mesh, const FacesByPatch& faces, PatchId first, const PeriodicMatch& match) {
  const auto n_triangles = static_cast<std::uint32_t>(mesh.boundary_triangles.size());
  const auto nodes_of = [&](std::uint32_t face) {
    return face < n_triangles ? std::span<const NodeId>(mesh.boundary_triangles[face].nodes)
                              : std::span<const NodeId>(mesh.boundary_quads[face - n_triangles].nodes);
  };
  const auto node_partner = [&](NodeId node) { return std::ranges::lower_bound(match.nodes, node, {}, [](const auto& pair) { return pair[0]; })->at(1); };
  std::vector<std::array<std::uint32_t, 2>> pairs = match.faces;
  std::ranges::sort(pairs);
  CyclicSide side;
  const auto add = [&](std::uint32_t face, std::uint32_t offset, std::vector<std::uint32_t>& others, std::vector<std::uint8_t>& begins) {
    const std::uint32_t other = std::ranges::lower_bound(pairs, face, {}, [](const auto& pair) { return pair[0]; })->at(1);
    const std::span<const NodeId> nodes = nodes_of(other);
    others.push_back(other - offset);
    begins.push_back(static_cast<std::uint8_t>(std::ranges::find(nodes, node_partner(nodes_of(face)[0])) - nodes.begin()));
  };
  for (const std::uint32_t t : faces.triangles(first)) add(t, 0, side.triangles, side.triangle_begins);
  for (const std::uint32_t q : faces.quads(first)) add(n_triangles + q, n_triangles, side.quads, side.quad_begins);
  return side;
}

class FoamWriter {
 public:
  FoamWriter(const HybridMesh& mesh, const std::filesystem::path& path, const FoamMeshOptions& options, const RunContext& context)
      : mesh_(mesh),
        path_(path.string()),
        options_(options),
        is_binary_(options.is_binary),
        context_(context),
        faces_(mesh, context.part("faces", 0.0, 0.3)),
        by_patch_(mesh) {
    if (options.numbering != Numbering::lines) faces_.order_cells(options.numbering, context.part("numbering", 0.3, 0.3));
    const std::uint64_t n_boundary = mesh.boundary_triangles.size() + mesh.boundary_quads.size();
    n_internal_ = faces_.n_internal();
    n_faces_ = n_internal_ + n_boundary;
    n_face_nodes_ = faces_.n_internal_nodes() + 3 * mesh.boundary_triangles.size() + 4 * mesh.boundary_quads.size();
    require_count(mesh.points.size(), k_max_label, "points", "OpenFOAM with 32-bit labels", path_);
    require_count(n_faces_, k_max_label, "faces", "OpenFOAM with 32-bit labels", path_);
    require_count(is_binary_ ? n_face_nodes_ : 0, k_max_label, "nodes of faces", "OpenFOAM's binary list with 32-bit labels", path_);
    for (const PeriodicSides& sides : mesh.periodic) add_cyclic(sides);
    for (const PeriodicSides& sides : options.joined) add_cyclic(sides);
  }

  void write(const std::filesystem::path& folder) const {
    write_file(folder, "points", "vectorField", {points()}, mesh_.points.size(), 0.3, 0.45);
    if (is_binary_) write_faces_compact(folder);
    else write_file(folder, "faces", "faceList", face_texts(), n_faces_, 0.45, 0.7);
    write_file(folder, "owner", "labelList", owners(), n_faces_, 0.7, 0.85);
    write_file(folder, "neighbour", "labelList", {neighbours()}, n_internal_, 0.85, 1.0);
    write_boundary(folder);
    write_zones(folder);
  }

 private:
  void add_cyclic(const PeriodicSides& sides) {
    neighbour_[sides.first] = sides.second;
    neighbour_[sides.second] = sides.first;
    cyclic_.emplace(sides.second, order_cyclic(mesh_, by_patch_, sides.first, match_periodic(mesh_, sides.first, sides.second, periodic_tolerance(mesh_))));
  }

  std::string header(std::string_view object, std::string_view object_class, bool is_binary) const {
    std::string text = "FoamFile\n{\n    version 2.0;\n    format " + std::string(is_binary ? "binary" : "ascii") + ";\n";
    if (is_binary) text += "    arch \"LSB;label=32;scalar=64\";\n";
    text += "    class " + std::string(object_class) + ";\n";
    if (object == "owner" || object == "neighbour")
      text += "    note \"nPoints:" + std::to_string(mesh_.points.size()) + " nCells:" + std::to_string(faces_.n_cells()) +
              " nFaces:" + std::to_string(n_faces_) + " nInternalFaces:" + std::to_string(n_internal_) + "\";\n";
    return text + "    location \"constant/polyMesh\";\n    object " + std::string(object) + ";\n}\n\n";
  }

  /// Adds the brackets of a list; OpenFOAM's binary lists have none when empty.
  void add_list(std::vector<OutputSection>& file, std::vector<OutputSection> items, std::uint64_t n) const {
    if (is_binary_ && n == 0) {
      file.push_back(fixed_section("0\n"));
      return;
    }
    file.push_back(fixed_section(std::to_string(n) + (is_binary_ ? "\n(" : "\n(\n")));
    std::move(items.begin(), items.end(), std::back_inserter(file));
    file.push_back(fixed_section(")\n"));
  }

  void write_file(const std::filesystem::path& folder, std::string_view object, std::string_view object_class, std::vector<OutputSection> items,
                  std::uint64_t n, double from, double to) const {
    std::vector<OutputSection> sections{fixed_section(header(object, object_class, is_binary_))};
    add_list(sections, std::move(items), n);
    AtomicFile file(folder / object);
    write_sections(file, sections, context_.part(object, from, to));
    file.commit();
  }

  void write_faces_compact(const std::filesystem::path& folder) const {
    std::vector<OutputSection> sections{fixed_section(header("faces", "faceCompactList", true))};
    add_list(sections, face_locations(), n_faces_ + 1);
    add_list(sections, face_labels(), n_face_nodes_);
    AtomicFile file(folder / "faces");
    write_sections(file, sections, context_.part("faces", 0.45, 0.7));
    file.commit();
  }

  char* put_label(char* at, std::uint64_t value) const {
    if (is_binary_) return put_bytes(at, static_cast<std::int32_t>(value), std::endian::little);
    at = put_integer_text(at, static_cast<std::int64_t>(value));
    *at++ = '\n';
    return at;
  }

  OutputSection points() const {
    return {.n_items = mesh_.points.size(), .format = [this](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
              char* at = out.reserve((end - begin) * k_max_point_text);
              for (std::uint64_t i = begin; i < end; ++i) {
                const Point& p = mesh_.points.raw()[i];
                if (!is_finite(p)) throw_node_not_finite(i);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                  if (is_binary_) {
                    at = put_bytes(at, p[axis], std::endian::little);
                  } else {
                    *at++ = axis == 0 ? '(' : ' ';
                    at = put_real_text(at, p[axis]);
                  }
                }
                if (is_binary_) continue;
                *at++ = ')';
                *at++ = '\n';
              }
              out.end_at(at);
            }};
  }

  /// Returns sections written by put(at, cell, face) for the internal faces of cells [begin, end).
  template <class Put>
  OutputSection internal(std::size_t max_bytes, const Put& put) const {
    return {.n_items = faces_.n_cells(), .format = [this, max_bytes, put](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
              char* at = out.reserve((end - begin) * k_most_foam_faces * max_bytes);
              faces_.for_each_internal(begin, end, [&](std::uint64_t cell, const CellFace& face) { at = put(at, cell, face); });
              out.end_at(at);
            }};
  }

  /// Returns sections written by put(at, nodes, cell) for the faces of a patch, triangles before quads.
  template <class Put>
  void add_boundary(std::vector<OutputSection>& sections, std::size_t max_bytes, const Put& put) const {
    for (const PatchId patch : mesh_.patches.ids()) {
      const auto add = [&](std::span<const std::uint32_t> which, std::span<const std::uint8_t> begins, auto get) {
        sections.push_back({.n_items = which.size(), .format = [which, begins, get, put, max_bytes](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                              char* at = out.reserve((end - begin) * max_bytes);
                              for (std::uint64_t i = begin; i < end; ++i) at = get(at, which[i], begins.empty() ? 0u : begins[i], put);
                              out.end_at(at);
                            }});
      };
      const auto cyclic = cyclic_.find(patch);
      const bool is_plain = cyclic == cyclic_.end();
      const std::span<const std::uint8_t> none;
      add(is_plain ? by_patch_.triangles(patch) : std::span<const std::uint32_t>(cyclic->second.triangles),
          is_plain ? none : std::span<const std::uint8_t>(cyclic->second.triangle_begins),
          [this](char* at, std::uint32_t i, std::uint32_t first, const Put& p) {
            std::array<NodeId, 3> nodes = mesh_.boundary_triangles[i].nodes;
            std::rotate(nodes.begin(), nodes.begin() + first, nodes.end());
            return p(at, std::span<const NodeId>(nodes), faces_.cell_of_triangle(i));
          });
      add(is_plain ? by_patch_.quads(patch) : std::span<const std::uint32_t>(cyclic->second.quads),
          is_plain ? none : std::span<const std::uint8_t>(cyclic->second.quad_begins), [this](char* at, std::uint32_t i, std::uint32_t first, const Put& p) {
            std::array<NodeId, 4> nodes = mesh_.boundary_quads[i].nodes;
            std::rotate(nodes.begin(), nodes.begin() + first, nodes.end());
            return p(at, std::span<const NodeId>(nodes), faces_.cell_of_quad(i));
          });
    }
  }

  static char* put_face_text(char* at, std::span<const NodeId> nodes) {
    *at++ = static_cast<char>('0' + nodes.size());
    char separator = '(';
    for (const NodeId node : nodes) {
      *at++ = separator;
      at = put_integer_text(at, node.value());
      separator = ' ';
    }
    *at++ = ')';
    *at++ = '\n';
    return at;
  }

  std::vector<OutputSection> face_texts() const {
    std::vector<OutputSection> sections{
        internal(k_max_face_text, [](char* at, std::uint64_t, const CellFace& face) { return put_face_text(at, face.span()); })};
    add_boundary(sections, k_max_face_text, [](char* at, std::span<const NodeId> nodes, std::uint32_t) { return put_face_text(at, nodes); });
    return sections;
  }

  static char* put_face_labels(char* at, std::span<const NodeId> nodes) {
    for (const NodeId node : nodes) at = put_bytes(at, static_cast<std::int32_t>(node.value()), std::endian::little);
    return at;
  }

  std::vector<OutputSection> face_labels() const {
    constexpr std::size_t k_bytes = 4 * sizeof(std::int32_t);
    std::vector<OutputSection> sections{internal(k_bytes, [](char* at, std::uint64_t, const CellFace& face) { return put_face_labels(at, face.span()); })};
    add_boundary(sections, k_bytes, [](char* at, std::span<const NodeId> nodes, std::uint32_t) { return put_face_labels(at, nodes); });
    return sections;
  }

  /// Returns the offsets of the faces' nodes, and the end of the last.
  std::vector<OutputSection> face_locations() const {
    std::vector<OutputSection> sections{{.n_items = faces_.n_cells(), .format = [this](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                                           char* at = out.reserve((end - begin) * k_most_foam_faces * sizeof(std::int32_t));
                                           std::uint64_t position = faces_.internal_before(begin).nodes;
                                           faces_.for_each_internal(begin, end, [&](std::uint64_t, const CellFace& face) {
                                             at = put_label(at, position);
                                             position += face.size;
                                           });
                                           out.end_at(at);
                                         }}};
    std::uint64_t position = faces_.n_internal_nodes();
    const auto add = [&](std::uint64_t n, std::uint64_t size) {
      sections.push_back({.n_items = n, .format = [this, first = position, size](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                            char* at = out.reserve((end - begin) * sizeof(std::int32_t));
                            for (std::uint64_t i = begin; i < end; ++i) at = put_label(at, first + i * size);
                            out.end_at(at);
                          }});
      position += n * size;
    };
    for (const PatchId patch : mesh_.patches.ids()) {
      add(by_patch_.triangles(patch).size(), 3);
      add(by_patch_.quads(patch).size(), 4);
    }
    add(1, 0);
    return sections;
  }

  std::vector<OutputSection> owners() const {
    std::vector<OutputSection> sections{internal(k_max_label_text, [this](char* at, std::uint64_t cell, const CellFace&) { return put_label(at, cell); })};
    add_boundary(sections, k_max_label_text, [this](char* at, std::span<const NodeId>, std::uint32_t cell) { return put_label(at, cell); });
    return sections;
  }

  OutputSection neighbours() const {
    return internal(k_max_label_text, [this](char* at, std::uint64_t, const CellFace& face) { return put_label(at, face.neighbour); });
  }

  /// Returns the type, with a group for kinds that types cannot express.
  std::string type_of(PatchId patch) const {
    const std::string type = foam_patch_type(mesh_, patch);
    return type == "patch" ? type + ";\n        inGroups 1(" + std::string(to_string(mesh_.patches[patch].kind)) + ")" : type;
  }

  void write_boundary(const std::filesystem::path& folder) const {
    const std::vector<std::string> names = foam_patch_names(mesh_.patches, context_);
    std::string entries;
    std::uint64_t first = n_internal_;
    int n = 0;
    for (const PatchId patch : mesh_.patches.ids()) {
      const std::uint64_t n_faces = by_patch_.count(patch);
      if (n_faces == 0) continue;
      const auto neighbour = neighbour_.find(patch);
      const std::string type = neighbour == neighbour_.end() ? type_of(patch) : "cyclic;\n        neighbourPatch " + names[neighbour->second.index()];
      entries += "    " + names[patch.index()] + "\n    {\n        type " + type + ";\n        nFaces " + std::to_string(n_faces) + ";\n        startFace " +
                 std::to_string(first) + ";\n    }\n";
      first += n_faces;
      ++n;
    }
    AtomicFile file(folder / "boundary");
    file.append(header("boundary", "polyBoundaryMesh", false) + std::to_string(n) + "\n(\n" + entries + ")\n");
    file.commit();
  }

  /// Returns the cells of the layer; empty if the mesh has no columns.
  std::vector<std::uint32_t> layer_cells() const {
    std::vector<std::uint32_t> cells(faces_.n_column_cells());
    for (std::uint32_t i = 0; i < cells.size(); ++i) cells[i] = faces_.number_of(i);
    std::ranges::sort(cells);
    return cells;
  }

  void write_zones(const std::filesystem::path& folder) const {
    std::vector<FoamZone> zones;
    if (std::vector<std::uint32_t> cells = layer_cells(); !cells.empty()) zones.push_back({.name = "layers", .cells = std::move(cells)});
    for (const FoamZone& zone : options_.zones) {
      if (zone.cells.empty()) continue;
      zones.push_back(zone);
      for (std::uint32_t& cell : zones.back().cells) cell = faces_.number_of(cell);
      std::ranges::sort(zones.back().cells);
    }
    if (zones.empty()) return;
    std::vector<OutputSection> sections{fixed_section(header("cellZones", "regIOobject", is_binary_) + std::to_string(zones.size()) + "\n(\n")};
    for (const FoamZone& zone : zones) {
      sections.push_back(fixed_section(zone.name + "\n{\n    type cellZone;\n    cellLabels List<label> "));
      add_list(sections,
               {{.n_items = zone.cells.size(),
                 .format =
                     [this, &zone](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
                       char* at = out.reserve((end - begin) * k_max_label_text);
                       for (std::uint64_t i = begin; i < end; ++i) at = put_label(at, zone.cells[i]);
                       out.end_at(at);
                     }}},
               zone.cells.size());
      sections.push_back(fixed_section(";\n}\n"));
    }
    sections.push_back(fixed_section(")\n"));
    AtomicFile file(folder / "cellZones");
    write_sections(file, sections, context_.part("zones", 1.0, 1.0));
    file.commit();
  }

  const HybridMesh& mesh_;
  std::string path_;
  const FoamMeshOptions& options_;
  bool is_binary_;
  RunContext context_;
  MeshFaces faces_;
  FacesByPatch by_patch_;
  std::map<PatchId, PatchId> neighbour_;  ///< neighbours of periodic sides
  std::map<PatchId, CyclicSide> cyclic_;  ///< face order of the second sides
  std::uint64_t n_internal_ = 0, n_faces_ = 0, n_face_nodes_ = 0;
};

/// Returns the empty file by which ParaView opens a case; an empty path if `path` is a folder.
std::filesystem::path marker_of(const std::filesystem::path& path) {
  std::error_code status;
  if (!path.has_filename() || polymesh_folder(path) == path || std::filesystem::is_directory(path, status)) return {};
  return polymesh_folder(path) == path / "constant" / "polyMesh" ? std::filesystem::path() : path;
}

/// Returns true for "text.foam" and "case.text.foam"; all other names mean binary.
bool is_text_name(const std::filesystem::path& path) {
  std::string name = (path.has_filename() ? path : path.parent_path()).filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name.ends_with("text.foam");
}

/// Writes the minimum without which no OpenFOAM tool starts, including checkMesh; existing files are kept. mesh:foam_case writes a case that can be run.
void write_missing_settings(const std::filesystem::path& folder) {
  constexpr std::array<std::array<std::string_view, 2>, 3> k_settings = {{
      {"controlDict",
       "// Enough for checkMesh and other tools of the mesh; mesh:foam_case{} of sterna writes a case that can be run.\napplication none;\nstartFrom "
       "startTime;\nstartTime 0;\nstopAt endTime;\nendTime 1;\ndeltaT 1;\nwriteControl timeStep;\nwriteInterval 1;\nwriteFormat binary;\nwritePrecision "
       "12;\n"},
      {"fvSchemes",
       "// Least-squares gradients over point neighbours: with Gauss linear, or with face neighbours only, the drag error was 3 % or the run "
       "diverged.\nddtSchemes { default steadyState; }\ngradSchemes { default pointCellsLeastSquares; }\ndivSchemes { default none; }\nlaplacianSchemes { "
       "default Gauss linear corrected; }\ninterpolationSchemes { default linear; }\nsnGradSchemes { default corrected; }\n"},
      {"fvSolution", "solvers {}\n"},
  }};
  std::error_code status;  // if a path cannot be accessed; writing reports the error
  for (const auto& [name, text] : k_settings) {
    if (std::filesystem::exists(folder / name, status)) continue;
    std::filesystem::create_directories(folder, status);
    write_whole(folder / name, foam_header(name, "dictionary", "system") + std::string(text));
  }
}

}  // namespace

void require_foam_output(const std::filesystem::path& path) {
  const std::filesystem::path marker = marker_of(path);
  std::error_code status;  // if the path cannot be accessed; the writer reports the error
  if (marker.empty() || std::filesystem::exists(marker, status) || !std::filesystem::exists(polymesh_folder(path), status)) return;
  const std::filesystem::path folder = marker.has_parent_path() ? marker.parent_path() : ".";
  std::vector<std::string> others;
  for (const auto& entry : std::filesystem::directory_iterator(folder, status))
    if (entry.path().extension() == ".foam" && entry.is_regular_file(status)) others.push_back(entry.path().filename().string());
  if (others.empty()) return;
  throw Error(
      {.code = ErrorCode::write_failed,
       .attempted = "writing " + path.string(),
       .problem = "the existing mesh in this case, " + polymesh_folder(path).string() + ", belongs to " + *std::min_element(others.begin(), others.end()),
       .hint = "an OpenFOAM case has only one mesh: write each mesh to its own folder, or write to constant/polyMesh to replace the existing mesh"});
}

void require_foam_location(const std::filesystem::path& path) {
  require_foam_output(path);
  const std::filesystem::path folder = polymesh_folder(path).parent_path().parent_path();
  const std::filesystem::path above = path.extension() == ".foam" ? folder : folder.parent_path();
  std::error_code status;  // a path that cannot be accessed is treated as missing
  if (!above.empty() && !std::filesystem::is_directory(above, status))
    throw Error({.code = ErrorCode::write_failed, .attempted = "writing " + path.string(), .problem = "there is no folder " + above.string()});
}

std::vector<std::string> foam_patch_names(const Column<PatchId, Patch>& patches, const RunContext& context) {
  // OpenFOAM words: no blanks, quotes, slashes, semicolons, braces; brackets and '$', '#', ':' have a meaning in dictionaries.
  return names_by_rules(patches, {.format = "OpenFOAM", .forbidden = "\"'\\/;{}()[]<>$#:,|*?!", .may_begin_with_digit = false, .may_have_blanks = false},
                        context);
}

std::string foam_patch_type(const HybridMesh& mesh, PatchId patch) {
  const PatchKind kind = mesh.patches[patch].kind;
  if (kind == PatchKind::wall) return "wall";
  if (kind != PatchKind::symmetry) return "patch";
  Box box;
  const auto add = [&](const auto& faces) {
    for (const auto& face : faces)
      if (face.patch == patch)
        for (const NodeId node : face.nodes) box.add(mesh.points[node]);
  };
  add(mesh.boundary_triangles);
  add(mesh.boundary_quads);
  return box.min.x == box.max.x || box.min.y == box.max.y || box.min.z == box.max.z ? "symmetryPlane" : "symmetry";
}

void write_polymesh(const HybridMesh& mesh, const std::filesystem::path& folder, const FoamMeshOptions& options, const RunContext& context) {
  FoamWriter(mesh, folder, options, context).write(folder);
}

std::string foam_header(std::string_view object, std::string_view object_class, std::string_view location) {
  return "FoamFile\n{\n    version 2.0;\n    format ascii;\n    class " + std::string(object_class) + ";\n    location \"" + std::string(location) +
         "\";\n    object " + std::string(object) + ";\n}\n\n";
}

void write_volume_foam(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  write_numbered_foam(mesh, path, Numbering::lines, context);
}

void write_numbered_foam(const HybridMesh& mesh, const std::filesystem::path& path, Numbering numbering, const RunContext& context) {
  write_numbered_foam(mesh, path, numbering, {}, context);
}

void write_numbered_foam(const HybridMesh& mesh, const std::filesystem::path& path, Numbering numbering, std::vector<FoamZone> zones,
                         const RunContext& context) {
  require_foam_output(path);
  const std::filesystem::path folder_path = polymesh_folder(path), marker = marker_of(path);
  const FoamMeshOptions options{.is_binary = !is_text_name(path), .numbering = numbering, .zones = std::move(zones)};
  const FoamWriter writer(mesh, folder_path, options, context);
  AtomicFolder folder(folder_path, "faces");
  writer.write(folder.path());
  folder.commit();
  std::error_code status;
  if (!marker.empty() && !std::filesystem::exists(marker, status)) AtomicFile(marker).commit();
  if (path.has_filename() ? path.filename() != "polyMesh" : path.parent_path().filename() != "polyMesh")
    write_missing_settings(folder_path.parent_path().parent_path() / "system");
}

}  // namespace sterna::io
