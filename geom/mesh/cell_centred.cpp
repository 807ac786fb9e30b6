#include "geom/mesh/cell_centred.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/mesh/forced_layer.h"

namespace sterna::check_parts {
namespace {

/// Keeps quotients finite where a length, an area or a product of them vanishes (OpenFOAM's ROOTVSMALL).
constexpr double k_tiny = 1e-150;
/// Share of the distance between centres (for a boundary face of the distance to its plane) that counts as the face's reach where the face itself is smaller.
constexpr double k_inner_reach = 0.2, k_boundary_reach = 0.4;
/// A sphere's radius that is as good as none, for flat tets (OpenFOAM's GREAT).
constexpr double k_great = 1e15;
constexpr double k_least_power = 1e-250;  ///< powers of volumes below this have lost digits
/// Columns per chunk; each holds some 30 cells.
constexpr std::size_t k_cell_column_chunk = 64;
constexpr std::uint8_t k_top = 7;

struct Corners {
  std::array<Point, 4> points;
  std::size_t n = 0;
  void add(const Point& p) { points[n++] = p; }
  std::span<const Point> span() const { return {points.data(), n}; }
};

struct Place {
  Point centre;
  double volume = 0.0;
};

double reach(std::span<const Point> corners, const Point& centre, const Vec3& direction, double least) {
  double reach = least;
  for (const Point& p : corners) reach = std::max(reach, std::abs(dot(direction, p - centre)));
  return reach;
}

/// How far the line from a cell's centre along d passes a face's centre, over the reach.
double skewness_of(const FaceShape& face, std::span<const Point> corners, const Point& cell, const Vec3& d, double share) {
  const Vec3 to_face = face.centre - cell;
  const Vec3 miss = to_face - (dot(face.area, to_face) / (dot(face.area, d) + k_tiny)) * d;
  const double length = norm(miss);
  return length / reach(corners, face.centre, miss / (length + k_tiny), share * norm(d) + k_tiny);
}

/// OpenFOAM's quality of a tet: its signed volume over that of the regular one in the same sphere.
double tet_quality(const Point& p, const Point& q, const Point& r, const Point& s) {
  const Vec3 a = q - p, b = r - p, c = s - p;
  const double six_volumes = dot(cross(a, b), c);
  const Vec3 to_centre = norm2(c) * cross(a, b) + norm2(b) * cross(c, a) + norm2(a) * cross(b, c);
  const double radius = std::abs(six_volumes) < k_tiny ? k_great : std::min(k_great, norm(to_centre) / (2.0 * std::abs(six_volumes)));
  return six_volumes / 6.0 / (8.0 / (9.0 * std::numbers::sqrt3) * radius * radius * radius + k_tiny);
}

/// Worst of the tets on the face's edges and centre with a cell's centre on the side `sign` (1: that of the face's normal).
double worst_around_centre(const FaceShape& face, std::span<const Point> corners, const Point& cell, double sign) {
  double worst = 1.0;
  for (std::size_t k = 0; k < corners.size(); ++k)
    worst = std::min(worst, sign * tet_quality(corners[k], corners[(k + 1) % corners.size()], face.centre, cell));
  return worst;
}

/// Worst of the two tets that a quadrilateral cut at corner `base` makes with a cell's centre.
double worst_from_corner(std::span<const Point> corners, std::size_t base, const Point& cell, double sign) {
  const auto corner = [&](std::size_t k) { return corners[(base + k) % 4]; };
  return std::min(sign * tet_quality(corner(0), corner(1), corner(2), cell), sign * tet_quality(corner(0), corner(2), corner(3), cell));
}

/// checkMesh's decomposition of a face for tracking: all tets around its centre, and those of the best of its cuts into triangles, must be the right way round
/// on both sides. Of a triangle the second are as good as the first. `other`: null at the boundary.
double exact_face_tet_quality(const FaceShape& face, std::span<const Point> corners, const Point& cell, const Point* other) {
  double worst = worst_around_centre(face, corners, cell, -1.0);
  if (other != nullptr) worst = std::min(worst, worst_around_centre(face, corners, *other, 1.0));
  if (corners.size() == 3) return worst;
  double best = -k_great;
  for (std::size_t base = 0; base < 2; ++base) {  // from the opposite corner it is the same cut
    double cut = worst_from_corner(corners, base, cell, -1.0);
    if (other != nullptr) cut = std::min(cut, worst_from_corner(corners, base, *other, 1.0));
    best = std::max(best, cut);
  }
  return std::min(worst, best);
}

/// Of tets at one cell's centre: V^8 / N^6 with V six volumes and N tet_quality's `to_centre`; negative where one is the wrong way round.
struct TetPowers {
  double around = k_great;        ///< the least with the face's centre
  double cuts[2] = {-1.0, -1.0};  ///< the least of each of a quadrilateral's cuts
};

/// Crosses of neighbours among the corners serve all tets; `sign` as in worst_around_centre with its sense turned.
TetPowers tet_powers(const FaceShape& face, std::span<const Point> corners, const Point& cell, double sign) {
  std::array<Vec3, 4> a, side, to_centre;  // corners from the cell's centre; crosses with the next corner, with the face's centre
  std::array<double, 4> a2;
  const std::size_t n = corners.size();
  const Vec3 c = face.centre - cell;
  const double c2 = norm2(c);
  for (std::size_t k = 0; k < n; ++k) {
    a[k] = corners[k] - cell;
    a2[k] = norm2(a[k]);
    to_centre[k] = cross(c, a[k]);
  }
  const auto power = [](double volume, const Vec3& normal) {
    if (!(volume > 0.0)) return -1.0;
    const double share = 1.0 / norm2(normal), squared = volume * volume, first = squared * squared * share;
    return first * first * share;
  };
  TetPowers powers;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t next = k + 1 < n ? k + 1 : 0;
    side[k] = cross(a[k], a[next]);
    powers.around = std::min(powers.around, power(sign * dot(side[k], c), c2 * side[k] + a2[next] * to_centre[k] - a2[k] * to_centre[next]));
  }
  if (n != 4) return powers;
  for (std::size_t base = 0; base < 2; ++base) {
    const std::size_t next = base + 1, across = base + 2, last = (base + 3) % 4;
    const Vec3 diagonal = cross(a[base], a[across]);
    powers.cuts[base] = std::min(power(sign * dot(side[base], a[across]), a2[across] * side[base] - a2[next] * diagonal + a2[base] * side[next]),
                                 power(sign * dot(side[across], a[base]), a2[base] * side[across] + a2[across] * side[last] + a2[last] * diagonal));
  }
  return powers;
}

/// exact_face_tet_quality() at a third of its price where all tets are the right way round: a tet's quality is 1.5 sqrt(3) V^4 / N^3.
double face_tet_quality(const FaceShape& face, std::span<const Point> corners, const Point& cell, const Point* other) {
  TetPowers powers = tet_powers(face, corners, cell, 1.0);
  if (other != nullptr) {
    const TetPowers more = tet_powers(face, corners, *other, -1.0);
    powers.around = std::min(powers.around, more.around);
    for (std::size_t base = 0; base < 2; ++base) powers.cuts[base] = std::min(powers.cuts[base], more.cuts[base]);
  }
  const double least = corners.size() == 4 ? std::min(powers.around, std::max(powers.cuts[0], powers.cuts[1])) : powers.around;
  return least > k_least_power ? 1.5 * std::numbers::sqrt3 * std::sqrt(least) : exact_face_tet_quality(face, corners, cell, other);
}

void add_inner(CellCentredScan& scan, std::uint64_t id, std::span<const Point> corners, const Place& a, const Place& b) {
  const FaceShape face = face_shape(corners);
  const Vec3 d = b.centre - a.centre;
  const double cosine = dot(d, face.area) / (norm(d) * norm(face.area) + k_tiny);
  scan.non_orthogonality.add(std::acos(std::clamp(cosine, -1.0, 1.0)), id);
  scan.skewness.add(skewness_of(face, corners, a.centre, d, k_inner_reach), id);
  const double to_a = std::abs(dot(face.area, face.centre - a.centre)), to_b = std::abs(dot(face.area, b.centre - face.centre));
  scan.face_weight.add(std::min(to_a, to_b) / (to_a + to_b + k_tiny), id);
  scan.volume_ratio.add(std::min(a.volume, b.volume) / (std::max(a.volume, b.volume) + k_tiny), id);
  if (corners.size() == 4) scan.face_flatness.add(face.flatness, id);
  scan.face_tets.add(face_tet_quality(face, corners, a.centre, &b.centre), id);
}

void add_boundary(CellCentredScan& scan, std::uint64_t id, std::span<const Point> corners, const Place& cell) {
  const FaceShape face = face_shape(corners);
  const Vec3 normal = face.area / (norm(face.area) + k_tiny);
  scan.skewness.add(skewness_of(face, corners, cell.centre, dot(normal, face.centre - cell.centre) * normal, k_boundary_reach), id);
  if (corners.size() == 4) scan.face_flatness.add(face.flatness, id);
  scan.face_tets.add(face_tet_quality(face, corners, cell.centre, nullptr), id);
}

/// Which faces of cells are on the boundary; faces of periodic sides are not, flow goes through them.
class OuterFaces {
 public:
  OuterFaces(const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match)
      : slots_(slots), has_any_(cells.first_tetrahedron() + mesh.tetrahedra.size(), 0) {
    std::vector<std::uint8_t> is_periodic(mesh.patches.size(), 0);
    for (const PeriodicSides& sides : mesh.periodic) is_periodic[sides.first.index()] = is_periodic[sides.second.index()] = 1;
    for (std::size_t i = 0; i < match.outer.size(); ++i) {
      if (is_periodic[slots.patch(match.outer_boundary[i]).index()] != 0) continue;
      const std::uint64_t owner = slots.owner(match.outer[i]);
      faces_.push_back({owner, match.outer[i]});
      has_any_[owner] = 1;
    }
    std::sort(faces_.begin(), faces_.end());
  }

  /// Bit f: face f of the cell is no boundary face.
  unsigned inner(std::uint64_t number, const Cell& cell) const {
    unsigned bits = ~0u;
    if (has_any_[number] == 0) return bits;
    const auto local = cell_faces(cell.kind);
    for (auto own = std::lower_bound(faces_.begin(), faces_.end(), std::pair(number, std::uint32_t{0})); own != faces_.end() && own->first == number; ++own) {
      const Face outer = slots_.face(own->second);
      for (std::size_t f = 0; f < local.size(); ++f)
        if (is_same(cell, local[f], outer)) bits &= ~(1u << f);
    }
    return bits;
  }

 private:
  static bool is_same(const Cell& cell, const LocalFace& local, const Face& face) {
    // Faces of one cell share two nodes at most; a face of a degenerate cell repeats nodes, so the other way round.
    for (std::size_t k = 0; k < face.size; ++k) {
      const auto has = [&](std::uint8_t node) { return cell.nodes[node] == face.nodes[k]; };
      if (std::none_of(local.nodes.begin(), local.nodes.begin() + local.size, has)) return false;
    }
    return true;
  }

  const FaceSlots& slots_;
  std::vector<std::uint8_t> has_any_;                           ///< per cell number
  std::vector<std::pair<std::uint64_t, std::uint32_t>> faces_;  ///< cell and slot, ascending
};

/// Centres and volumes: of tetrahedra on demand, of all other cells once.
class Places {
 public:
  Places(const HybridMesh& mesh, const CellNumbers& cells) : mesh_(mesh), cells_(cells), kept_(cells.first_tetrahedron()) {}
  void keep(std::uint64_t number, const CellShape& shape) { kept_[number] = {shape.centre, shape.volume}; }
  Place of(std::uint64_t number) const {
    if (number < kept_.size()) return kept_[number];
    const auto& n = mesh_.tetrahedra[number - kept_.size()];
    const Point &a = mesh_.points[n[0]], &b = mesh_.points[n[1]], &c = mesh_.points[n[2]], &d = mesh_.points[n[3]];
    return {(a + b + c + d) * 0.25, dot(b - a, cross(c - a, d - a)) / 6.0};
  }

 private:
  const HybridMesh& mesh_;
  const CellNumbers& cells_;
  std::vector<Place> kept_;
};

/// Corners of a side of a column's cell, normal out of it; fewer than three where both lines are collapsed.
Corners side_of(const HybridMesh& mesh, std::size_t column, std::size_t corner, int layer) {
  const LayerBlock& layers = mesh.layers;
  const std::uint32_t u = layers.base[column][corner], v = layers.base[column][(corner + 1) % 3];
  Corners corners;
  corners.add(mesh.points[layers.node(u, layer)]);
  corners.add(mesh.points[layers.node(v, layer)]);
  if (!layers.is_collapsed[v]) corners.add(mesh.points[layers.node(v, layer + 1)]);
  if (!layers.is_collapsed[u]) corners.add(mesh.points[layers.node(u, layer + 1)]);
  return corners;
}

Corners top_of(const HybridMesh& mesh, std::size_t column, int layer) {
  Corners corners;
  for (const std::uint32_t line : mesh.layers.base[column]) corners.add(mesh.points[mesh.layers.node(line, layer + 1)]);
  return corners;
}

Corners corners_of(const HybridMesh& mesh, const Face& face) {
  Corners corners;
  for (std::size_t k = 0; k < face.size; ++k) corners.add(mesh.points[face.nodes[k]]);
  return corners;
}

class Scanner {
 public:
  Scanner(const HybridMesh& mesh, const CellNumbers& cells, const GateTable& limits, const RunContext& context)
      : mesh_(mesh), limits_(limits), context_(context), places_(mesh, cells) {}

  /// Cells, each by itself.
  void scan_cells(const CellNumbers& cells, const OuterFaces& outer, CellCentredScan& scan) {
    const auto n_layers = static_cast<std::uint64_t>(mesh_.layers.n_layers);
    const auto add = [&](CellCentredScan& part, std::uint64_t number, const Cell& cell) {
      const CellShape shape = cell_shape(mesh_, cell, outer.inner(number, cell));
      if (number < cells.first_tetrahedron()) places_.keep(number, shape);
      part.cell_aspect_ratio.add(shape.aspect_ratio, number);
      part.cell_openness.add(shape.openness, number);
      part.cell_determinant.add(shape.determinant, number);
    };
    gather(
        scan, mesh_.layers.n_columns(),
        [&](std::size_t c, CellCentredScan& part) {
          if (mesh_.layers.n_collapsed(c) == 3) return;
          for (int j = 0, n = mesh_.layers.layers_of_column(c); j < n; ++j) add(part, c * n_layers + static_cast<std::uint64_t>(j), mesh_.layers.cell(c, j));
        },
        k_cell_column_chunk);
    const std::uint64_t first = cells.first_prism(), last = cells.first_tetrahedron() + mesh_.tetrahedra.size();
    gather(scan, last - first, [&](std::size_t i, CellCentredScan& part) { add(part, first + i, cells.cell(first + i)); });
  }

  /// Faces between cells of columns.
  void scan_columns(std::span<const std::uint32_t> neighbours, CellCentredScan& scan) const {
    const LayerBlock& layers = mesh_.layers;
    const auto n_layers = static_cast<std::uint64_t>(layers.n_layers);
    const auto add_column = [&](std::size_t c, CellCentredScan& part) {
      if (layers.n_collapsed(c) == 3) return;
      const int n = layers.layers_of_column(c);
      for (int j = 0; j < n; ++j) {
        const std::uint64_t number = c * n_layers + static_cast<std::uint64_t>(j);
        const Place here = places_.of(number);
        if (j + 1 < n) add_inner(part, 8 * number + k_top, top_of(mesh_, c, j).span(), here, places_.of(number + 1));
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t other = neighbours[3 * c + k];
          if (other == k_no_slot || other < c) continue;
          const Corners side = side_of(mesh_, c, k, j);
          if (side.n >= 3) add_inner(part, 8 * number + k, side.span(), here, places_.of(other * n_layers + static_cast<std::uint64_t>(j)));
        }
      }
    };
    gather(scan, layers.n_columns(), add_column, k_cell_column_chunk);
  }

  /// All others.
  void scan_slots(const FaceSlots& slots, const FaceMatch& match, CellCentredScan& scan) const {
    gather(scan, match.pairs.size(), [&](std::size_t i, CellCentredScan& part) {
      const auto& [a, b] = match.pairs[i];
      add_inner(part, CellCentredScan::k_of_slot + a, corners_of(mesh_, slots.face(a)).span(), places_.of(slots.owner(a)), places_.of(slots.owner(b)));
    });
    gather(scan, match.outer.size(), [&](std::size_t i, CellCentredScan& part) {
      const std::uint32_t slot = match.outer[i];
      add_boundary(part, CellCentredScan::k_of_slot + slot, corners_of(mesh_, slots.face(slot)).span(), places_.of(slots.owner(slot)));
    });
  }

 private:
  template <class Add>
  void gather(CellCentredScan& scan, std::size_t n, const Add& add, std::size_t chunk = k_default_chunk) const {
    CellCentredScan empty(limits_);
    scan = parallel_reduce(
        context_, n, std::move(scan),
        [&](std::size_t begin, std::size_t end) {
          CellCentredScan part = empty;
          for (std::size_t i = begin; i < end; ++i) add(i, part);
          return part;
        },
        [](CellCentredScan all, const CellCentredScan& more) {
          all.merge(more);
          return all;
        },
        chunk);
  }

  const HybridMesh& mesh_;
  const GateTable& limits_;
  const RunContext& context_;
  Places places_;
};

double determinant_of(std::span<const FaceShape> faces, unsigned inner) {
  double mean = 0.0;
  int n = 0;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if ((inner >> f & 1u) != 0) {
      mean += norm(faces[f].area);
      ++n;
    }
  if (n == 0) return 0.0;
  mean /= n;
  double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if ((inner >> f & 1u) == 0) continue;
    const Vec3 a = faces[f].area / mean;
    xx += a.x * a.x, xy += a.x * a.y, xz += a.x * a.z, yy += a.y * a.y, yz += a.y * a.z, zz += a.z * a.z;
  }
  constexpr double k_of_cube = 8.0;
  return std::abs(xx * yy * zz + xy * yz * xz + xz * xy * yz - xx * yz * yz - xy * xy * zz - xz * yy * xz) / k_of_cube;
}

GateScan scan_of(Measure measure, const GateTable& limits) { return {info_of(measure), limits[measure]}; }

}  // namespace

FaceShape face_shape(std::span<const Point> corners) {
  if (corners.size() == 3) return {0.5 * cross(corners[1] - corners[0], corners[2] - corners[0]), (corners[0] + corners[1] + corners[2]) / 3.0, 1.0};
  const Point middle = (corners[0] + corners[1] + corners[2] + corners[3]) * 0.25;
  Vec3 normal{}, weighted{};
  double total = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Point &p = corners[k], &next = corners[(k + 1) % 4];
    const Vec3 twice_area = cross(next - p, middle - p);
    const double size = norm(twice_area);
    normal = normal + twice_area;
    total += size;
    weighted = weighted + size * (p + next + middle);
  }
  if (!(total > 0.0)) return {Vec3{}, middle, 1.0};
  const Point centre = weighted / (3.0 * total);
  double about_centre = 0.0;
  for (std::size_t k = 0; k < 4; ++k) about_centre += norm(cross(corners[(k + 1) % 4] - corners[k], centre - corners[k]));
  return {0.5 * normal, centre, norm(normal) / (about_centre + k_tiny)};
}

CellShape cell_shape(const HybridMesh& mesh, const Cell& cell, unsigned inner) {
  std::array<FaceShape, 6> faces;
  const auto local = cell_faces(cell.kind);
  Point guess{};
  for (std::size_t f = 0; f < local.size(); ++f) {
    Corners corners;
    for (std::size_t k = 0; k < local[f].size; ++k) corners.add(mesh.points[cell.nodes[local[f].nodes[k]]]);
    faces[f] = face_shape(corners.span());
    guess = guess + faces[f].centre;
  }
  guess = guess / static_cast<double>(local.size());
  CellShape shape;
  Vec3 weighted{}, sum{}, sizes{};
  double total = 0.0, area = 0.0;
  for (std::size_t f = 0; f < local.size(); ++f) {
    const FaceShape& face = faces[f];
    const double pyramid = dot(face.area, face.centre - guess);
    weighted = weighted + pyramid * (0.75 * face.centre + 0.25 * guess);
    total += pyramid;
    sum = sum + face.area;
    sizes = sizes + Vec3{std::abs(face.area.x), std::abs(face.area.y), std::abs(face.area.z)};
  }
  shape.centre = std::abs(total) > 0.0 ? weighted / total : guess;
  shape.volume = total / 3.0;
  const auto [low, high] = std::minmax({sizes.x, sizes.y, sizes.z});
  area = sizes.x + sizes.y + sizes.z;
  shape.aspect_ratio = std::max(high / (low + k_tiny), area / 6.0 / std::cbrt(shape.volume * shape.volume));
  shape.openness = std::max({std::abs(sum.x) / (sizes.x + k_tiny), std::abs(sum.y) / (sizes.y + k_tiny), std::abs(sum.z) / (sizes.z + k_tiny)});
  shape.determinant = determinant_of({faces.data(), local.size()}, inner);
  return shape;
}

CellCentredScan::CellCentredScan(const GateTable& limits)
    : non_orthogonality(scan_of(Measure::non_orthogonality, limits)),
      skewness(scan_of(Measure::skewness, limits)),
      face_weight(scan_of(Measure::face_weight, limits)),
      volume_ratio(scan_of(Measure::volume_ratio, limits)),
      face_flatness(scan_of(Measure::face_flatness, limits)),
      cell_aspect_ratio(scan_of(Measure::cell_aspect_ratio, limits)),
      cell_openness(scan_of(Measure::cell_openness, limits)),
      face_tets(scan_of(Measure::face_tets, limits)),
      cell_determinant(scan_of(Measure::cell_determinant, limits)) {}

void CellCentredScan::merge(const CellCentredScan& other) {
  non_orthogonality.merge(other.non_orthogonality);
  skewness.merge(other.skewness);
  face_weight.merge(other.face_weight);
  volume_ratio.merge(other.volume_ratio);
  face_flatness.merge(other.face_flatness);
  cell_aspect_ratio.merge(other.cell_aspect_ratio);
  cell_openness.merge(other.cell_openness);
  face_tets.merge(other.face_tets);
  cell_determinant.merge(other.cell_determinant);
}

CellCentredScan scan_cell_centred(const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match,
                                  std::span<const std::uint32_t> neighbours, const GateTable& limits, const RunContext& context) {
  CellCentredScan scan(limits);
  Scanner scanner(mesh, cells, limits, context);
  scanner.scan_cells(cells, OuterFaces(mesh, cells, slots, match), scan);
  scanner.scan_columns(neighbours, scan);
  scanner.scan_slots(slots, match, scan);
  return scan;
}

void judge_cell_centred(const CellCentredScan& scan, const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots,
                        std::span<const std::uint32_t> neighbours, const GateTable& limits, LazyGivenLayer& given, CheckReport& report) {
  const auto cell = [&](std::uint64_t id) { return std::pair(cells.center(id), cells.name(id)); };
  const auto face = [&](std::uint64_t id) {
    if (id >= CellCentredScan::k_of_slot) {
      const auto slot = static_cast<std::uint32_t>(id - CellCentredScan::k_of_slot);
      return std::pair(slots.center(slot), "face of " + slots.name(slot));
    }
    const std::uint64_t number = id / 8, n_layers = static_cast<std::uint64_t>(mesh.layers.n_layers);
    const std::size_t column = number / n_layers;
    const int layer = static_cast<int>(number % n_layers);
    const bool is_top = id % 8 == k_top;
    const Corners corners = is_top ? top_of(mesh, column, layer) : side_of(mesh, column, id % 8, layer);
    return std::pair(face_shape(corners.span()).centre, (is_top ? "top of " : "side of ") + cells.name(number));
  };
  const auto put = [&](const GateScan& measure, const auto& describe) {
    GateResult result = measure.result(describe);
    report.gates[static_cast<std::size_t>(result.measure)] = std::move(result);
  };
  const auto put_sides = [&](const GateScan& measure, Measure which, const auto& prove) {
    report.gates[static_cast<std::size_t>(which)] = measure.result(face, [&](std::uint64_t id, double value) {
      if (id >= CellCentredScan::k_of_slot || id % 8 == k_top) return std::optional<Forcing>();
      const std::uint64_t number = id / 8, n_layers = static_cast<std::uint64_t>(mesh.layers.n_layers);
      const std::size_t column = number / n_layers, corner = id % 8;
      return prove(ColumnSide{column, corner, neighbours[3 * column + corner], static_cast<int>(number % n_layers)}, limits[which].hard, value);
    });
  };
  put_sides(scan.face_weight, Measure::face_weight, [&](const ColumnSide& side, double limit, double) { return given.get().face_weight(side, limit); });
  put_sides(scan.volume_ratio, Measure::volume_ratio, [&](const ColumnSide& side, double limit, double) { return given.get().volume_ratio(side, limit); });
  put_sides(scan.skewness, Measure::skewness, [&](const ColumnSide& side, double limit, double value) {
    const std::optional<Forcing> any_direction = given.get().skewness(side, limit);
    return any_direction ? any_direction : given.get().skewness_of_edge(side, limit, value);
  });
  for (const GateScan* measure : {&scan.non_orthogonality, &scan.face_flatness, &scan.face_tets}) put(*measure, face);
  for (const GateScan* measure : {&scan.cell_aspect_ratio, &scan.cell_openness, &scan.cell_determinant}) put(*measure, cell);
}

}  // namespace sterna::check_parts
