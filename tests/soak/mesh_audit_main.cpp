// Checks a volume mesh in SU2 format independently: shares no code with `sterna check`, nor with any of our readers. Prints the results as JSON.
//
// usage: soak_mesh_audit MESH.su2 [--wall NAME]... [--near X,Y,Z]... [--pair NAME NAME]...
//   --wall    a marker with layers: measures its first heights and numbers of layers
//   --near    measures the distance of this point from the walls
//   --pair    two markers that should match after a translation: counts nodes and faces without partner
// Exit status: 0 valid mesh, 3 invalid mesh, 2 unreadable file.
//
// Checks: numbers in range and finite, no unused node, each face shared by two cells in opposite senses or by one cell and one marker, each marker face a face
// of a cell, boundary closed edge by edge, volumes and corner volumes positive (in 113 bits), one outermost boundary, and no overlapping cells (for a sample of
// cells).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

__extension__ using Real = __float128;  // exact for differences of doubles of similar size, nearly exact for triple products
using Point = std::array<double, 3>;
using Wide = std::array<Real, 3>;

struct Cell {
  int kind = 0;  // VTK cell type: 10 tetrahedron, 12 hexahedron, 13 prism, 14 pyramid
  std::vector<std::int64_t> nodes;
};

struct Marker {
  std::string name;
  std::vector<std::vector<std::int64_t>> faces;
};

struct Mesh {
  std::vector<Point> points;
  std::vector<Cell> cells;
  std::vector<Marker> markers;
};

int nodes_of(int kind) {
  switch (kind) {
    case 3: return 2;
    case 5: return 3;
    case 9: return 4;
    case 10: return 4;
    case 12: return 8;
    case 13: return 6;
    case 14: return 5;
    default: throw std::runtime_error("element of kind " + std::to_string(kind));
  }
}

// ---- Reading -------------------------------------------------------------------------------------------------------------------------------

std::vector<std::int64_t> indices(const char*& at, int n) {
  std::vector<std::int64_t> made(n);
  for (auto& value : made) {
    char* end = nullptr;
    value = std::strtoll(at, &end, 10);
    if (end == at) throw std::runtime_error("an element line is too short");
    at = end;
  }
  return made;
}

Mesh read(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot open " + path);
  Mesh mesh;
  std::string line;
  const auto next = [&] {
    while (std::getline(in, line))
      if (const auto first = line.find_first_not_of(" \t\r"); first != std::string::npos && line[first] != '%') return true;
    return false;
  };
  const auto value = [&] { return line.substr(line.find('=') + 1); };
  while (next()) {
    if (line.rfind("NDIME", 0) == 0) {
      if (std::atoi(value().c_str()) != 3) throw std::runtime_error("not in three dimensions");
    } else if (line.rfind("NELEM", 0) == 0) {
      const auto n = std::atoll(value().c_str());
      for (long long i = 0; i < n; ++i) {
        if (!next()) throw std::runtime_error("ends within the elements");
        const char* at = line.c_str();
        const int kind = static_cast<int>(indices(at, 1)[0]);
        mesh.cells.push_back({kind, indices(at, nodes_of(kind))});
      }
    } else if (line.rfind("NPOIN", 0) == 0) {
      const auto n = std::atoll(value().c_str());
      for (long long i = 0; i < n; ++i) {
        if (!next()) throw std::runtime_error("ends within the points");
        const char* at = line.c_str();
        Point p;
        for (double& x : p) {
          char* end = nullptr;
          x = std::strtod(at, &end);
          if (end == at) throw std::runtime_error("a point line is too short");
          at = end;
        }
        mesh.points.push_back(p);
      }
    } else if (line.rfind("MARKER_TAG", 0) == 0) {
      std::string name = value();
      name.erase(0, name.find_first_not_of(" \t"));
      name.erase(name.find_last_not_of(" \t\r") + 1);
      mesh.markers.push_back({name, {}});
    } else if (line.rfind("MARKER_ELEMS", 0) == 0) {
      if (mesh.markers.empty()) throw std::runtime_error("MARKER_ELEMS without a tag");
      const auto n = std::atoll(value().c_str());
      for (long long i = 0; i < n; ++i) {
        if (!next()) throw std::runtime_error("ends within a marker");
        const char* at = line.c_str();
        const int kind = static_cast<int>(indices(at, 1)[0]);
        if (kind != 5 && kind != 9) throw std::runtime_error("a marker's element is neither triangle nor quadrilateral");
        mesh.markers.back().faces.push_back(indices(at, nodes_of(kind)));
      }
    }
  }
  if (mesh.cells.empty() || mesh.points.empty()) throw std::runtime_error("no cells or no points");
  return mesh;
}

// ---- Findings ------------------------------------------------------------------------------------------------------------------------------

class Findings {
 public:
  void add(const std::string& kind, const std::string& what) {
    auto& entry = kinds_[kind];
    if (++entry.first == 1) entry.second = what;
  }
  bool empty() const { return kinds_.empty(); }
  std::string json() const {
    std::string made = "{";
    for (const auto& [kind, entry] : kinds_)
      made += (made.size() > 1 ? ", " : "") + ("\"" + kind) + "\": {\"n\": " + std::to_string(entry.first) + ", \"first\": \"" + entry.second + "\"}";
    return made + "}";
  }

 private:
  std::map<std::string, std::pair<std::int64_t, std::string>> kinds_;
};

// ---- Geometry ------------------------------------------------------------------------------------------------------------------------------

Wide minus(const Point& a, const Point& b) { return {Real(a[0]) - b[0], Real(a[1]) - b[1], Real(a[2]) - b[2]}; }

/// Six times the volume of the tetrahedron; positive if d lies on the side from which the triangle a, b, c is counter-clockwise.
Real six_volumes(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Wide u = minus(b, a), v = minus(c, a), w = minus(d, a);
  return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
}

Point mean_of(const Mesh& mesh, const std::vector<std::int64_t>& nodes) {
  Point sum{};
  for (const auto node : nodes)
    for (int k = 0; k < 3; ++k) sum[k] += mesh.points[node][k];
  for (double& x : sum) x /= static_cast<double>(nodes.size());
  return sum;
}

std::string location(const Point& p) {
  char text[100];
  std::snprintf(text, sizeof text, "(%.9g, %.9g, %.9g)", p[0], p[1], p[2]);
  return text;
}

/// Returns the faces, with normals out of the cell.
std::vector<std::vector<int>> faces_of(int kind) {
  switch (kind) {
    case 10: return {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    case 13: return {{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}};  // VTK numbering; the normal of the first triangle points outwards
    case 14: return {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    default: return {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  }
}

/// SU2 files number prisms in either sense (VTK's figure and VTK's text differ). The sense of the first prism is applied to the whole mesh.
void turn_prisms(Mesh& mesh) {
  for (const Cell& cell : mesh.cells) {
    if (cell.kind != 13) continue;
    const auto& n = cell.nodes;
    const auto& p = mesh.points;
    const Real volume =
        six_volumes(p[n[0]], p[n[1]], p[n[2]], p[n[3]]) + six_volumes(p[n[1]], p[n[2]], p[n[0]], p[n[4]]) + six_volumes(p[n[2]], p[n[0]], p[n[1]], p[n[5]]);
    if (volume < 0) return;  // 0, 1, 2 has its normal outwards already
    break;
  }
  for (Cell& cell : mesh.cells)
    if (cell.kind == 13) {
      std::swap(cell.nodes[1], cell.nodes[2]);
      std::swap(cell.nodes[4], cell.nodes[5]);
    }
}

/// Flux of (x, y, z) about `origin` through a face, divided by 3. Bilinear quadrilaterals use the mean of both triangulations, which is exact.
Real flux(const Mesh& mesh, const std::vector<std::int64_t>& n, const Point& origin) {
  const auto& p = mesh.points;
  if (n.size() == 3) return six_volumes(origin, p[n[0]], p[n[1]], p[n[2]]) / 6;
  return (six_volumes(origin, p[n[0]], p[n[1]], p[n[2]]) + six_volumes(origin, p[n[0]], p[n[2]], p[n[3]]) + six_volumes(origin, p[n[0]], p[n[1]], p[n[3]]) +
          six_volumes(origin, p[n[1]], p[n[2]], p[n[3]])) /
         12;
}

double area_of(const Mesh& mesh, const std::vector<std::int64_t>& n) {
  const auto cross = [&](std::int64_t a, std::int64_t b, std::int64_t c) {
    const Wide u = minus(mesh.points[b], mesh.points[a]), v = minus(mesh.points[c], mesh.points[a]);
    const double x = static_cast<double>(u[1] * v[2] - u[2] * v[1]), y = static_cast<double>(u[2] * v[0] - u[0] * v[2]),
                 z = static_cast<double>(u[0] * v[1] - u[1] * v[0]);
    return std::sqrt(x * x + y * y + z * z) / 2;
  };
  return n.size() == 3 ? cross(n[0], n[1], n[2]) : (cross(n[0], n[1], n[2]) + cross(n[0], n[2], n[3]) + cross(n[0], n[1], n[3]) + cross(n[1], n[2], n[3])) / 2;
}

// ---- Checks of a mesh ----------------------------------------------------------------------------------------------------------------------

bool indices_are_good(const Mesh& mesh, Findings& findings) {
  const auto n_points = static_cast<std::int64_t>(mesh.points.size());
  std::vector<char> used(mesh.points.size(), 0);
  bool good = true;
  const auto look = [&](const std::vector<std::int64_t>& nodes, const char* what, bool counts) {
    auto sorted = nodes;
    std::sort(sorted.begin(), sorted.end());
    if (sorted.front() < 0 || sorted.back() >= n_points) {
      findings.add("index", std::string(what) + " with a node out of range");
      good = false;
      return;
    }
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
      findings.add("repeated_node", std::string(what) + " at " + location(mesh.points[sorted.front()]));
      good = false;
    }
    if (counts)
      for (const auto node : nodes) used[node] = 1;
  };
  for (const Cell& cell : mesh.cells) look(cell.nodes, "cell", true);
  for (const Marker& marker : mesh.markers)
    for (const auto& face : marker.faces) look(face, "marker face", false);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    if (!std::isfinite(mesh.points[i][0]) || !std::isfinite(mesh.points[i][1]) || !std::isfinite(mesh.points[i][2])) {
      findings.add("not_finite", "point " + std::to_string(i));
      good = false;
    } else if (used[i] == 0) {
      findings.add("unused_node", location(mesh.points[i]));
    }
  }
  return good;
}

struct Face {
  std::array<std::int64_t, 4> key;  // sorted node numbers, -1 as fourth node of a triangle
  bool is_even;                     // sense: in the cycle from the smallest node, true if the second node is below the last
  std::int32_t owner;               // cell, or -1 - marker
  std::int32_t index;               // of the face in the cell or marker
};

Face face_of(const std::vector<std::int64_t>& nodes, std::int32_t owner, std::int32_t index) {
  Face face{{-1, -1, -1, -1}, false, owner, index};
  const auto n = nodes.size();
  auto sorted = nodes;
  std::sort(sorted.begin(), sorted.end());
  std::copy(sorted.begin(), sorted.end(), face.key.begin());
  const std::size_t first = static_cast<std::size_t>(std::min_element(nodes.begin(), nodes.end()) - nodes.begin());
  face.is_even = nodes[(first + 1) % n] < nodes[(first + n - 1) % n];
  return face;
}

std::vector<std::int64_t> cell_face(const Cell& cell, const std::vector<int>& corners) {
  std::vector<std::int64_t> nodes;
  for (const int corner : corners) nodes.push_back(cell.nodes[corner]);
  return nodes;
}

/// The faces of a cell that lie in a marker, oriented outwards.
struct BoundaryFace {
  std::int32_t marker;
  std::int32_t cell;
  std::vector<std::int64_t> nodes;
};

std::vector<BoundaryFace> match_faces(const Mesh& mesh, std::vector<std::array<std::int32_t, 6>>& across, Findings& findings) {
  std::vector<Face> faces;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto corners = faces_of(mesh.cells[c].kind);
    for (std::size_t f = 0; f < corners.size(); ++f)
      faces.push_back(face_of(cell_face(mesh.cells[c], corners[f]), static_cast<std::int32_t>(c), static_cast<std::int32_t>(f)));
  }
  for (std::size_t m = 0; m < mesh.markers.size(); ++m)
    for (std::size_t f = 0; f < mesh.markers[m].faces.size(); ++f)
      faces.push_back(face_of(mesh.markers[m].faces[f], -1 - static_cast<std::int32_t>(m), static_cast<std::int32_t>(f)));
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.key != b.key ? a.key < b.key : a.owner > b.owner; });
  across.assign(mesh.cells.size(), {-1, -1, -1, -1, -1, -1});
  std::vector<BoundaryFace> boundary;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i;
    while (end < faces.size() && faces[end].key == faces[i].key) ++end;
    const Face &a = faces[i], &b = faces[std::min(i + 1, end - 1)];
    const std::string where = location(mesh.points[faces[i].key[0]]);
    if (end - i != 2) {
      findings.add(end - i == 1 ? (a.owner < 0 ? "marker_face_of_no_cell" : "face_without_neighbour_or_marker") : "face_of_more_than_two", where);
    } else if (a.owner < 0) {
      findings.add("marker_faces_twice", where);
    } else if (b.owner < 0) {
      boundary.push_back({-1 - b.owner, a.owner, cell_face(mesh.cells[a.owner], faces_of(mesh.cells[a.owner].kind)[a.index])});
    } else {
      if (a.is_even == b.is_even) findings.add("cells_on_one_side_of_a_face", where);
      across[a.owner][a.index] = b.owner;
      across[b.owner][b.index] = a.owner;
    }
    i = end;
  }
  return boundary;
}

Real volume_of(const Mesh& mesh, const Cell& cell) {
  const Point& origin = mesh.points[cell.nodes[0]];
  Real sum = 0;
  for (const auto& corners : faces_of(cell.kind)) sum += flux(mesh, cell_face(cell, corners), origin);
  return sum;
}

/// Checks cell volumes and, at each corner with three edges, the volume spanned by these edges.
void look_at_volumes(const Mesh& mesh, Real& total, Findings& findings) {
  static const std::map<int, std::vector<std::array<int, 4>>> k_corners = {
      {10, {}},
      {13, {{0, 2, 1, 3}, {1, 0, 2, 4}, {2, 1, 0, 5}, {3, 4, 5, 0}, {4, 5, 3, 1}, {5, 3, 4, 2}}},
      {14, {{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}},
      {12, {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}}}};
  for (const Cell& cell : mesh.cells) {
    const Real volume = volume_of(mesh, cell);
    total += volume;
    const char* names = cell.kind == 10 ? "tetrahedron" : cell.kind == 13 ? "prism" : cell.kind == 14 ? "pyramid" : "hexahedron";
    if (!(volume > 0)) findings.add("volume_not_positive", std::string(names) + " at " + location(mean_of(mesh, cell.nodes)));
    for (const auto& corner : k_corners.at(cell.kind)) {
      const auto& n = cell.nodes;
      if (!(six_volumes(mesh.points[n[corner[0]]], mesh.points[n[corner[1]]], mesh.points[n[corner[2]]], mesh.points[n[corner[3]]]) > 0)) {
        findings.add("corner_not_positive", std::string(names) + " at " + location(mesh.points[n[corner[0]]]));
        break;
      }
    }
  }
}

/// Checks that the boundary is closed: each edge occurs equally often in both directions. Of the pieces connected by edges, the outermost encloses a positive
/// volume, all others (bodies) a negative one.
void look_at_boundary(const Mesh& mesh, const std::vector<BoundaryFace>& boundary, Real total, Findings& findings) {
  std::map<std::pair<std::int64_t, std::int64_t>, int> sense;
  std::vector<std::int64_t> root(mesh.points.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::int64_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto& face : boundary)
    for (std::size_t k = 0; k < face.nodes.size(); ++k) {
      const auto a = face.nodes[k], b = face.nodes[(k + 1) % face.nodes.size()];
      sense[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
      root[find(a)] = find(b);
    }
  for (const auto& [edge, balance] : sense)
    if (balance != 0) findings.add("boundary_open", location(mesh.points[edge.first]));
  if (boundary.empty()) return findings.add("no_boundary", "");
  std::map<std::int64_t, Real> pieces;
  const Point origin = mesh.points[boundary.front().nodes.front()];
  Real all = 0;
  for (const auto& face : boundary) {
    const Real part = flux(mesh, face.nodes, origin);
    pieces[find(face.nodes[0])] += part;
    all += part;
  }
  const Real difference = all > total ? all - total : total - all;
  if (!(difference <= total * Real(1e-9)))
    findings.add("volume_is_not_the_boundarys", std::to_string(static_cast<double>(total)) + " against " + std::to_string(static_cast<double>(all)));
  const auto n_outer = std::count_if(pieces.begin(), pieces.end(),
                                     [&](const auto& piece) { return piece.second > total * Real(1e-15); });  // both sides of a disc enclose no volume
  if (n_outer != 1) findings.add("outer_boundaries", std::to_string(n_outer) + " pieces of boundary that hold fluid");
}

/// Returns true if the point is certainly inside: on the inner side of every triangle in both triangulations of each face.
bool holds(const Mesh& mesh, const Cell& cell, const Point& at) {
  for (const auto& corners : faces_of(cell.kind)) {
    const auto n = cell_face(cell, corners);
    for (std::size_t k = 0; k < (n.size() == 3 ? 1 : 4); ++k)
      if (!(six_volumes(mesh.points[n[k]], mesh.points[n[(k + 1) % n.size()]], mesh.points[n[(k + 2) % n.size()]], at) < 0)) return false;
  }
  return true;
}

/// Checks that cell centres, sampled evenly over the mesh, lie in no other cell.
void look_for_overlaps(const Mesh& mesh, Findings& findings) {
  constexpr std::size_t k_samples = 200;
  const std::size_t step = std::max<std::size_t>(1, mesh.cells.size() / k_samples);
  std::vector<std::array<Point, 2>> boxes(mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    boxes[c] = {mesh.points[mesh.cells[c].nodes[0]], mesh.points[mesh.cells[c].nodes[0]]};
    for (const auto node : mesh.cells[c].nodes)
      for (int k = 0; k < 3; ++k) {
        boxes[c][0][k] = std::min(boxes[c][0][k], mesh.points[node][k]);
        boxes[c][1][k] = std::max(boxes[c][1][k], mesh.points[node][k]);
      }
  }
  for (std::size_t s = 0; s < mesh.cells.size(); s += step) {
    const Point at = mean_of(mesh, mesh.cells[s].nodes);
    if (!holds(mesh, mesh.cells[s], at)) continue;  // the centre of a thin twisted cell may lie outside the cell
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      bool may = c != s;
      for (int k = 0; k < 3 && may; ++k) may = boxes[c][0][k] < at[k] && at[k] < boxes[c][1][k];
      if (may && holds(mesh, mesh.cells[c], at)) findings.add("cells_overlap", location(at));
    }
  }
}

// ---- Measured layers -----------------------------------------------------------------------------------------------------------------------

struct Layers {
  std::vector<double> first;   // lengths of the first cells along their growth lines
  std::vector<double> height;  // heights of the same nodes above the wall triangle
  std::vector<int> numbers;    // numbers of cells in each column of prisms
};

/// Sets `in_column` to 1 for the prisms of columns that stand on boundary triangles.
std::vector<Layers> measure_layers(const Mesh& mesh, const std::vector<BoundaryFace>& boundary, const std::vector<std::array<std::int32_t, 6>>& across,
                                   std::vector<char>& in_column) {
  std::vector<Layers> made(mesh.markers.size());
  in_column.assign(mesh.cells.size(), 0);
  for (const auto& face : boundary) {
    const Cell& cell = mesh.cells[face.cell];
    if (cell.kind != 13 || face.nodes.size() != 3) continue;
    const bool is_lower = std::find(face.nodes.begin(), face.nodes.end(), cell.nodes[0]) != face.nodes.end();
    const int lower = is_lower ? 0 : 3;
    const double area = area_of(mesh, face.nodes);
    for (int k = 0; k < 3; ++k) {
      const Wide edge = minus(mesh.points[cell.nodes[k]], mesh.points[cell.nodes[k + 3]]);
      made[face.marker].first.push_back(std::sqrt(static_cast<double>(edge[0] * edge[0] + edge[1] * edge[1] + edge[2] * edge[2])));
      const Real six = six_volumes(mesh.points[cell.nodes[lower]], mesh.points[cell.nodes[lower + 1]], mesh.points[cell.nodes[lower + 2]],
                                   mesh.points[cell.nodes[k + 3 - lower]]);
      made[face.marker].height.push_back(std::fabs(static_cast<double>(six)) / (2 * area));
    }
    int n = 1;
    auto from = face.cell;
    in_column[from] = 1;
    auto at = across[from][is_lower ? 1 : 0];
    while (at >= 0 && mesh.cells[at].kind == 13 && n < 100000) {
      ++n;
      in_column[at] = 1;
      const auto back = across[at][0] == from ? 0 : across[at][1] == from ? 1 : -1;
      if (back < 0) break;
      from = at;
      at = across[at][back == 0 ? 1 : 0];
    }
    made[face.marker].numbers.push_back(n);
  }
  return made;
}

template <typename T>
std::string spread(std::vector<T> values) {
  if (values.empty()) return "null";
  std::sort(values.begin(), values.end());
  char text[120];
  std::snprintf(text, sizeof text, "{\"least\": %.17g, \"median\": %.17g, \"most\": %.17g}", static_cast<double>(values.front()),
                static_cast<double>(values[values.size() / 2]), static_cast<double>(values.back()));
  return text;
}

/// Prints the prisms that stand on no boundary triangle: those of wake sheets and opened ridges.
void print_free_prisms(const Mesh& mesh, const std::vector<char>& in_column) {
  std::int64_t n = 0;
  Point low = {1e300, 1e300, 1e300}, high = {-1e300, -1e300, -1e300};
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (mesh.cells[c].kind != 13 || in_column[c] != 0) continue;
    ++n;
    for (const auto node : mesh.cells[c].nodes)
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], mesh.points[node][k]);
        high[k] = std::max(high[k], mesh.points[node][k]);
      }
  }
  std::printf("\"free_prisms\": {\"n\": %lld", static_cast<long long>(n));
  if (n > 0) std::printf(", \"box\": [[%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g]]", low[0], low[1], low[2], high[0], high[1], high[2]);
  std::printf("}");
}

/// Compares two markers after a translation by the vector between the lower corners of their bounding boxes.
void print_pair(const Mesh& mesh, const std::string& first, const std::string& second) {
  const auto named = [&](const std::string& name) {
    const auto found = std::find_if(mesh.markers.begin(), mesh.markers.end(), [&](const Marker& marker) { return marker.name == name; });
    return found == mesh.markers.end() ? std::vector<std::vector<std::int64_t>>{} : found->faces;
  };
  const auto a = named(first), b = named(second);
  const auto nodes_in = [](const auto& faces) {
    std::set<std::int64_t> nodes;
    for (const auto& face : faces) nodes.insert(face.begin(), face.end());
    return nodes;
  };
  const auto low_of = [&](const std::set<std::int64_t>& nodes) {
    Point low = {1e300, 1e300, 1e300};
    for (const auto node : nodes)
      for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], mesh.points[node][k]);
    return low;
  };
  const auto a_nodes = nodes_in(a), b_nodes = nodes_in(b);
  const Point a_low = low_of(a_nodes), b_low = low_of(b_nodes);
  std::map<std::int64_t, std::int64_t> partner;
  double worst = 0.0;
  for (const auto node : a_nodes) {
    double least = HUGE_VAL;
    for (const auto other : b_nodes) {
      double off = 0.0;
      for (int k = 0; k < 3; ++k) off = std::max(off, std::fabs(mesh.points[node][k] + b_low[k] - a_low[k] - mesh.points[other][k]));
      if (off < least) {
        least = off;
        partner[node] = other;
      }
    }
    worst = std::max(worst, least);
  }
  std::set<std::vector<std::int64_t>> faces;
  for (auto face : b) {
    std::sort(face.begin(), face.end());
    faces.insert(face);
  }
  std::int64_t without = 0;
  for (auto face : a) {
    for (auto& node : face) node = partner.contains(node) ? partner[node] : -1;
    std::sort(face.begin(), face.end());
    without += faces.contains(face) ? 0 : 1;
  }
  std::printf("{\"nodes\": [%zu, %zu], \"faces\": [%zu, %zu], \"translation\": [%.17g, %.17g, %.17g], \"worst\": %.9g, \"faces_without_image\": %lld}",
              a_nodes.size(), b_nodes.size(), a.size(), b.size(), b_low[0] - a_low[0], b_low[1] - a_low[1], b_low[2] - a_low[2],
              std::isfinite(worst) ? worst : -1.0, static_cast<long long>(without));
}

double distance(const Point& at, const Point& a, const Point& b, const Point& c) {
  const auto dot = [](const Point& u, const Point& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
  const auto less = [](const Point& u, const Point& v) { return Point{u[0] - v[0], u[1] - v[1], u[2] - v[2]}; };
  const auto to_segment = [&](const Point& p, const Point& q) {
    const Point d = less(q, p), r = less(at, p);
    const double t = std::clamp(dot(d, d) > 0 ? dot(r, d) / dot(d, d) : 0.0, 0.0, 1.0);
    const Point off = {r[0] - t * d[0], r[1] - t * d[1], r[2] - t * d[2]};
    return std::sqrt(dot(off, off));
  };
  double least = std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
  const Point u = less(b, a), v = less(c, a), w = less(at, a);
  const Point n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double nn = dot(n, n);
  if (nn > 0) {
    const Point uw = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
    const Point wv = {w[1] * v[2] - w[2] * v[1], w[2] * v[0] - w[0] * v[2], w[0] * v[1] - w[1] * v[0]};
    const double beta = dot(wv, n) / nn, gamma = dot(uw, n) / nn;
    if (beta >= 0 && gamma >= 0 && beta + gamma <= 1) least = std::min(least, std::fabs(dot(w, n)) / std::sqrt(nn));
  }
  return least;
}

std::string quoted(const std::string& text) {
  std::string made = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') made += '\\';
    made += c;
  }
  return made + "\"";
}

/// Adds area times n n^T of the triangle a, b, c (the first half of a quadrilateral).
void add_normal(const Mesh& mesh, const std::vector<std::int64_t>& nodes, std::array<double, 6>& sum) {
  const Wide u = minus(mesh.points[nodes[1]], mesh.points[nodes[0]]), v = minus(mesh.points[nodes[2]], mesh.points[nodes[0]]);
  const Point n = {static_cast<double>(u[1] * v[2] - u[2] * v[1]), static_cast<double>(u[2] * v[0] - u[0] * v[2]),
                   static_cast<double>(u[0] * v[1] - u[1] * v[0])};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!(length > 0)) return;
  int at = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) sum[at++] += n[i] * n[j] / (2 * length);
}

void print_markers(const Mesh& mesh, const std::vector<BoundaryFace>& boundary, const std::vector<Layers>& layers) {
  std::vector<double> areas(mesh.markers.size(), 0.0);
  std::vector<Real> volumes(mesh.markers.size(), 0);
  std::vector<std::array<double, 6>> normals(mesh.markers.size(), {0, 0, 0, 0, 0, 0});  // area n n^T: xx, xy, xz, yy, yz, zz
  std::vector<std::array<Point, 2>> boxes(mesh.markers.size(), {Point{1e300, 1e300, 1e300}, Point{-1e300, -1e300, -1e300}});
  for (const auto& face : boundary) {
    areas[face.marker] += area_of(mesh, face.nodes);
    add_normal(mesh, face.nodes, normals[face.marker]);
    volumes[face.marker] += flux(mesh, face.nodes, mesh.points[boundary.front().nodes.front()]);
    for (const auto node : face.nodes)
      for (int k = 0; k < 3; ++k) {
        boxes[face.marker][0][k] = std::min(boxes[face.marker][0][k], mesh.points[node][k]);
        boxes[face.marker][1][k] = std::max(boxes[face.marker][1][k], mesh.points[node][k]);
      }
  }
  std::printf("\"markers\": {");
  for (std::size_t m = 0; m < mesh.markers.size(); ++m) {
    const auto& [low, high] = boxes[m];
    std::printf("%s%s: {\"faces\": %zu, \"area\": %.17g, \"flux\": %.17g, ", m == 0 ? "" : ", ", quoted(mesh.markers[m].name).c_str(),
                mesh.markers[m].faces.size(), areas[m], static_cast<double>(volumes[m]));
    if (areas[m] > 0) std::printf("\"box\": [[%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g]], ", low[0], low[1], low[2], high[0], high[1], high[2]);
    std::printf("\"normals\": [%.17g, %.17g, %.17g, %.17g, %.17g, %.17g], ", normals[m][0], normals[m][1], normals[m][2], normals[m][3], normals[m][4],
                normals[m][5]);
    std::printf("\"first_edge\": %s, \"first_height\": %s, \"layers\": %s}", spread(layers[m].first).c_str(), spread(layers[m].height).c_str(),
                spread(layers[m].numbers).c_str());
  }
  std::printf("}");
}

int audit(const std::string& path, const std::set<std::string>& walls, const std::vector<Point>& near, const std::vector<std::array<std::string, 2>>& pairs) {
  Mesh mesh = read(path);
  Findings findings;
  std::map<int, std::int64_t> kinds;
  for (const Cell& cell : mesh.cells) ++kinds[cell.kind];
  std::printf("{\"nodes\": %zu, \"tetrahedra\": %lld, \"prisms\": %lld, \"pyramids\": %lld, \"hexahedra\": %lld, ", mesh.points.size(),
              static_cast<long long>(kinds[10]), static_cast<long long>(kinds[13]), static_cast<long long>(kinds[14]), static_cast<long long>(kinds[12]));
  if (indices_are_good(mesh, findings)) {
    turn_prisms(mesh);
    std::vector<std::array<std::int32_t, 6>> across;
    const auto boundary = match_faces(mesh, across, findings);
    Real total = 0;
    look_at_volumes(mesh, total, findings);
    look_at_boundary(mesh, boundary, total, findings);
    look_for_overlaps(mesh, findings);
    std::printf("\"volume\": %.17g, ", static_cast<double>(total));
    std::vector<char> in_column;
    print_markers(mesh, boundary, measure_layers(mesh, boundary, across, in_column));
    std::printf(", ");
    print_free_prisms(mesh, in_column);
    std::printf(", \"pairs\": [");
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (i > 0) std::printf(", ");
      print_pair(mesh, pairs[i][0], pairs[i][1]);
    }
    std::printf("], \"near\": [");
    for (std::size_t i = 0; i < near.size(); ++i) {
      double least = HUGE_VAL;
      for (const auto& face : boundary)
        if (walls.contains(mesh.markers[face.marker].name) && face.nodes.size() == 3)
          least = std::min(least, distance(near[i], mesh.points[face.nodes[0]], mesh.points[face.nodes[1]], mesh.points[face.nodes[2]]));
      std::printf(std::isfinite(least) ? "%s%.9g" : "%snull", i == 0 ? "" : ", ", least);
    }
    std::printf("], ");
  }
  std::printf("\"findings\": %s}\n", findings.json().c_str());
  return findings.empty() ? 0 : 3;
}

}  // namespace

int main(int argc, char** argv) {
  std::string path;
  std::set<std::string> walls;
  std::vector<Point> near;
  std::vector<std::array<std::string, 2>> pairs;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--wall") == 0 && i + 1 < argc) {
      walls.insert(argv[++i]);
    } else if (std::strcmp(argv[i], "--near") == 0 && i + 1 < argc) {
      Point p;
      if (std::sscanf(argv[++i], "%lf,%lf,%lf", &p[0], &p[1], &p[2]) != 3) return std::fputs("--near X,Y,Z\n", stderr), 2;
      near.push_back(p);
    } else if (std::strcmp(argv[i], "--pair") == 0 && i + 2 < argc) {
      pairs.push_back({argv[i + 1], argv[i + 2]});
      i += 2;
    } else {
      path = argv[i];
    }
  }
  try {
    return audit(path, walls, near, pairs);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", path.c_str(), error.what());
    return 2;
  }
}
