#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "geom/base/error.h"
#include "geom/mesh/check_parts.h"

namespace sterna {
namespace {

constexpr double k_degrees = 180.0 / std::numbers::pi;
constexpr std::array<std::string_view, 4> k_checked_gates = {"G1", "G2", "G3", "tiling"};
constexpr std::array<std::string_view, 2> k_unchecked_gates = {"G4", "G20"};

std::string_view title_of(std::string_view gate) {
  if (gate == "G1") return "conformity";
  if (gate == "G2") return "no intersections";
  if (gate == "G3") return "valid cells";
  if (gate == "G4") return "positive dual sub-volumes";
  if (gate == "G20") return "symmetry planes";
  return "volumes and cover";
}

bool is_checked(const CheckReport& report, std::string_view gate) {
  if (gate == "G1") return true;
  return report.is_complete && (gate != "G2" || report.intersections_checked);
}

std::int64_t count_of_gate(const CheckReport& report, std::string_view gate) {
  std::int64_t n = 0;
  for (const auto& [violation, count] : report.counts)
    if (gate_of(violation) == gate) n += count;
  return n;
}

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, pattern, values...);
  return buffer;
}

std::string state_of_gate(const CheckReport& report, std::string_view gate) {
  if (!is_checked(report, gate)) return "not checked";
  const std::int64_t n = count_of_gate(report, gate);
  return n == 0 ? "pass" : "FAIL, " + std::to_string(n) + (n == 1 ? " violation" : " violations");
}

std::string gate_line(std::string_view gate, const std::string& state) {
  return format("  %-6s %-26s ", std::string(gate).c_str(), std::string(title_of(gate)).c_str()) + state + "\n";
}

nlohmann::ordered_json to_array(const Point& p) { return {p.x, p.y, p.z}; }

}  // namespace

std::string_view to_string(Violation v) {
  switch (v) {
    case Violation::unmatched_face:
      return "unmatched_face";
    case Violation::overmatched_face:
      return "overmatched_face";
    case Violation::same_sense_face:
      return "same_sense_face";
    case Violation::stray_boundary_face:
      return "stray_boundary_face";
    case Violation::duplicate_marker:
      return "duplicate_marker";
    case Violation::bad_index:
      return "bad_index";
    case Violation::bad_point:
      return "bad_point";
    case Violation::unused_node:
      return "unused_node";
    case Violation::boundary_intersection:
      return "boundary_intersection";
    case Violation::envelope_intersection:
      return "envelope_intersection";
    case Violation::invalid_cell:
      return "invalid_cell";
    case Violation::volume_mismatch:
      return "volume_mismatch";
    case Violation::broken_line:
      return "broken_line";
    case Violation::overlapping_parts:
      return "overlapping_parts";
    case Violation::no_cells:
      return "no_cells";
  }
  return "";
}

std::string_view gate_of(Violation v) {
  switch (v) {
    case Violation::boundary_intersection:
    case Violation::envelope_intersection:
      return "G2";
    case Violation::invalid_cell:
      return "G3";
    case Violation::volume_mismatch:
    case Violation::overlapping_parts:
    case Violation::no_cells:
      return "tiling";
    default:
      return "G1";
  }
}

std::int64_t CheckReport::count(Violation v) const {
  for (const auto& [violation, n] : counts)
    if (violation == v) return n;
  return 0;
}

std::string to_text(const CheckReport& report) {
  const auto n = [](std::int64_t value) { return std::to_string(value); };
  std::string text = report.is_valid() ? "VALID\n" : "INVALID\n";
  text += "  cells: " + n(report.cells.prisms) + " prisms, " + n(report.cells.pyramids) + " pyramids, " + n(report.cells.hexahedra) + " hexahedra, " +
          n(report.cells.tetrahedra) + " tetrahedra; " + n(report.n_nodes) + " nodes; boundary: " + n(report.n_boundary_triangles) + " triangles, " +
          n(report.n_boundary_quads) + " quads\n";
  if (!report.is_complete) text += "  Indices or points are unusable, so nothing else could be checked.\n";
  for (const std::string_view gate : k_checked_gates) text += gate_line(gate, state_of_gate(report, gate));
  for (const std::string_view gate : k_unchecked_gates) text += gate_line(gate, "not checked");
  if (report.is_complete) {
    text += format("  volume: layer %.9g m^3 (error %.1e), tetrahedra %.9g m^3 (error %.1e), total %.9g m^3\n", report.layer_volume, report.layer_volume_error,
                   report.tet_volume, report.tet_volume_error, report.total_volume);
  }
  if (report.quality_measured) {
    const Quality& q = report.quality;
    text += format("  prisms: worst scaled Jacobian %.3g at ", q.min_wedge_quality) + format_point(q.worst_prism) +
            format("; skew below 6 deg %.1f %%, below 18 deg %.1f %%, above 60 deg %.2f %%\n", 100.0 * q.skew_below_6, 100.0 * q.skew_below_18,
                   100.0 * q.skew_above_60);
    text += format("  tetrahedra: dihedral angles %.2f deg at ", q.min_dihedral * k_degrees) + format_point(q.worst_tet) +
            format(" to %.2f deg at ", q.max_dihedral * k_degrees) + format_point(q.most_obtuse_tet) + "\n";
  }
  for (const auto& [violation, count] : report.counts) {
    text += "  " + std::string(gate_of(violation)) + " " + std::string(to_string(violation)) + ": " + n(count) + "\n";
    std::int64_t n_shown = 0;
    for (const Finding& finding : report.findings) {
      if (finding.violation != violation) continue;
      text += "    at " + format_point(finding.position) + ": " + finding.what + "\n";
      ++n_shown;
    }
    if (count > n_shown) text += "    and " + n(count - n_shown) + " more\n";
  }
  return text;
}

std::string to_json(const CheckReport& report) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["schema"] = "sterna-check-1";
  json["verdict"] = report.is_valid() ? "VALID" : "INVALID";
  json["is_complete"] = report.is_complete;
  json["cells"] = {{"prisms", report.cells.prisms},
                   {"pyramids", report.cells.pyramids},
                   {"hexahedra", report.cells.hexahedra},
                   {"tetrahedra", report.cells.tetrahedra},
                   {"total", report.cells.total()}};
  json["nodes"] = report.n_nodes;
  json["boundary"] = {{"triangles", report.n_boundary_triangles}, {"quads", report.n_boundary_quads}};
  Json& gates = json["gates"];
  for (const std::string_view gate : k_checked_gates) {
    const std::int64_t n = count_of_gate(report, gate);
    gates[std::string(gate)] = is_checked(report, gate) ? Json{{"state", n == 0 ? "pass" : "fail"}, {"violations", n}} : Json{{"state", "not checked"}};
  }
  for (const std::string_view gate : k_unchecked_gates) gates[std::string(gate)] = {{"state", "not checked"}};
  json["violations"] = Json::object();
  for (const auto& [violation, count] : report.counts) json["violations"][std::string(to_string(violation))] = count;
  json["findings"] = Json::array();
  for (const Finding& finding : report.findings)
    json["findings"].push_back(
        {{"violation", to_string(finding.violation)}, {"gate", gate_of(finding.violation)}, {"position", to_array(finding.position)}, {"what", finding.what}});
  json["volume"] = {{"layer", report.layer_volume},
                    {"layer_error", report.layer_volume_error},
                    {"tetrahedra", report.tet_volume},
                    {"tetrahedra_error", report.tet_volume_error},
                    {"total", report.total_volume}};
  if (!report.quality_measured) {
    json["quality"] = nullptr;
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
  }
  const Quality& q = report.quality;
  json["quality"] = {{"min_wedge_quality", q.min_wedge_quality},
                     {"worst_prism", to_array(q.worst_prism)},
                     {"min_dihedral_deg", q.min_dihedral * k_degrees},
                     {"worst_tet", to_array(q.worst_tet)},
                     {"max_dihedral_deg", q.max_dihedral * k_degrees},
                     {"most_obtuse_tet", to_array(q.most_obtuse_tet)},
                     {"skew_below_6", q.skew_below_6},
                     {"skew_below_18", q.skew_below_18},
                     {"skew_above_60", q.skew_above_60}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace sterna
