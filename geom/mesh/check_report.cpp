#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/print_text.h"
#include "geom/math/constants.h"
#include "geom/mesh/check_parts.h"

namespace sterna {
namespace {

/// Gates of the verdict VALID.
constexpr std::array<std::string_view, 6> k_valid_gates = {"G1", "G2", "G3", "G4", "G20", "tiling"};

bool is_checked(const CheckReport& report, std::string_view gate) {
  if (gate == "G1") return true;
  return report.is_complete && (gate != "G2" || report.intersections_checked) && (gate != "G4" || report.dual_checked);
}

std::int64_t count_of_gate(const CheckReport& report, std::string_view gate) {
  std::int64_t n = 0;
  for (const auto& [violation, count] : report.counts)
    if (gate_of(violation) == gate) n += count;
  return n;
}

std::string state_of_gate(const CheckReport& report, std::string_view gate) {
  if (!is_checked(report, gate)) return "not checked";
  const std::int64_t n = count_of_gate(report, gate);
  return n == 0 ? "pass" : "FAIL, " + std::to_string(n) + (n == 1 ? " violation" : " violations");
}

std::string gate_line(std::string_view gate, const std::string& state) {
  return print_text("  %-6s %-26s ", std::string(gate).c_str(), std::string(title_of_gate(gate)).c_str()) + state + "\n";
}

using Json = nlohmann::ordered_json;

Json to_array(const Point& p) { return {p.x, p.y, p.z}; }

std::string shown_text(const MeasureInfo& info, double value) { return print_text("%.4g", in_report_unit(info, value)) + (info.is_angle ? " deg" : ""); }

/// Returns "hard 5 deg, target 20 deg, 35 deg on 99.9 %".
std::string limits_text(const MeasureInfo& info, const GateLimits& limits) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  const auto limit = [&](double value) { return std::string(info.is_low_bad ? ">= " : "<= ") + shown_text(info, value); };
  const bool has_share = info.fail_share > 0.0 && limits.hard == info.limits.hard;
  if (!std::isnan(limits.hard)) add("hard " + limit(limits.hard) + (has_share ? print_text(" except on %g %%", 100.0 * info.fail_share) : ""));
  if (!std::isnan(limits.target)) add("target " + limit(limits.target));
  if (!std::isnan(limits.usual)) add(limit(limits.usual) + print_text(" on %g %%", 100.0 * limits.usual_share));
  return text;
}

/// Returns the name of the items, "prisms"; for area-weighted measures the items are lines of the layer.
std::string_view items_of(const MeasureInfo& info) { return info.counted == "area" ? "lines" : info.counted; }

/// Returns "12", "320 k", "3.2 M".
std::string rounded_count(std::int64_t n) {
  constexpr double k_thousand = 1e3, k_million = 1e6;
  const auto value = static_cast<double>(n);
  if (n >= 1'000'000) return number_text(value / k_million, 3) + " M";
  return n >= 10'000 ? number_text(value / k_thousand, 3) + " k" : std::to_string(n);
}

/// Returns "1 place", "3 places".
std::string locations_text(std::int64_t n) { return std::to_string(n) + (n == 1 ? " place" : " places"); }

/// Returns "; 12 prisms beyond the hard limit, 0.0004 % of the volume, at 3 places, 9 too large, 3 too small; 830 beyond the target".
std::string counts_text(const GateResult& gate) {
  const MeasureInfo& info = info_of(gate.measure);
  const std::int64_t n = gate.n_too_small + gate.n_too_large;
  if (n == 0) return {};
  const bool is_hard = gate.n_beyond_hard > gate.n_forced;
  const std::string soft_limit = std::isnan(gate.limits.target) ? "the usual limit" : "the target";
  std::string_view items = items_of(info);
  if (n == 1) items.remove_suffix(1);  // "1 prism"
  std::string text = "; " + std::to_string(n) + " " + std::string(items) + " beyond " + (is_hard ? "the hard limit" : soft_limit);
  if (gate.share_beyond > 0.0) text += print_text(", %.2g %% of the ", 100.0 * gate.share_beyond) + (info.counted == "area" ? "area" : "volume");
  if (gate.n_locations) text += ", at " + locations_text(*gate.n_locations);
  if (gate.n_too_large > 0) text += gate.n_too_small > 0 ? ", " + std::to_string(gate.n_too_large) + " too large" : ", too large";
  if (gate.n_too_small > 0) text += gate.n_too_large > 0 ? ", " + std::to_string(gate.n_too_small) + " too small" : ", too small";
  if (is_hard && gate.n_beyond_target > gate.n_beyond_hard) text += "; " + std::to_string(gate.n_beyond_target) + " beyond " + soft_limit;
  return text;
}

std::string gate_text(const GateResult& gate) {
  const MeasureInfo& info = info_of(gate.measure);
  const std::string head = print_text("  %-4s %-32s ", std::string(info.gate).c_str(), std::string(info.title).c_str());
  if (gate.state == GateState::not_checked) return head + "not checked: " + gate.reason + "\n";
  std::string text = head + print_text("%-5s worst ", std::string(to_string(gate.state)).c_str()) + shown_text(info, gate.worst);
  if (!std::isnan(gate.limits.usual))
    text += print_text("; %.4g %% of %s ", 100.0 * gate.share_within, std::string(info.counted).c_str()) + (info.is_low_bad ? ">= " : "<= ") +
            shown_text(info, gate.limits.usual);
  if (const std::string limits = limits_text(info, gate.limits); !limits.empty()) text += " (" + limits + ")";
  text += counts_text(gate);
  if (gate.n_forced > 0)
    text += "; " + std::to_string(gate.n_forced) + " of " + std::to_string(gate.n_beyond_hard) + " beyond the hard limit are forced by the input surface";
  text += "\n";
  for (const GateLocation& location : gate.forced)
    text += "         forced: " + shown_text(info, location.value) + " at " + format_point(location.position) + ": " + location.what + ": " +
            location.forcing.why + "; " + location.forcing.remedy + "\n";
  if (gate.state == GateState::pass) return text;
  for (const GateLocation& location : gate.locations)
    text += "         " + shown_text(info, location.value) + " at " + format_point(location.position) + ": " + location.what + "\n";
  return text;
}

/// Returns a JSON number; null for infinity and NaN, which JSON does not have.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Returns the classes from the first to the last non-empty one.
Json histogram_json(const GateResult& gate, const MeasureInfo& info) {
  const auto is_filled = [](double count) { return count > 0.0; };
  const auto first = std::find_if(gate.histogram.begin(), gate.histogram.end(), is_filled);
  if (first == gate.histogram.end()) return nullptr;
  const auto last = std::find_if(gate.histogram.rbegin(), gate.histogram.rend(), is_filled).base();
  const std::vector<double> edges = info.classes.edges();
  Json json = {{"is_log", info.classes.per_octave > 0}, {"edges", Json::array()}, {"counts", Json(std::vector<double>(first, last))}};
  for (auto i = first - gate.histogram.begin(); i <= last - gate.histogram.begin(); ++i)
    json["edges"].push_back(in_report_unit(info, edges[static_cast<std::size_t>(i)]));
  return json;
}

/// Returns the JSON spelling: "fail".
std::string_view state_name(GateState state) { return state == GateState::fail ? "fail" : to_string(state); }

/// Returns the evidence of the hard limit, by consumer; null if there is no hard limit.
Json evidence_json(const MeasureInfo& info) {
  Json json = Json::object();
  for (const Consumer consumer : k_consumers)
    if (const Evidence evidence = info.evidence.of(consumer); evidence != Evidence::none) json[std::string(to_string(consumer))] = to_string(evidence);
  if (json.empty()) return nullptr;
  json["source"] = info.evidence.source;
  return json;
}

Json to_json(const GateResult& gate) {
  const MeasureInfo& info = info_of(gate.measure);
  Json json = {
      {"gate", info.gate}, {"measure", info.name}, {"title", info.title}, {"unit", info.is_angle ? "deg" : ""}, {"bound", info.is_low_bad ? "lower" : "upper"}};
  json["state"] = state_name(gate.state);
  json["states"] = Json::object();
  for (const Consumer consumer : k_consumers)
    if (info.consumers.has(consumer)) json["states"][std::string(to_string(consumer))] = state_name(state_for(gate, consumer));
  json["limits"] = {{"hard", number(in_report_unit(info, gate.limits.hard))},
                    {"target", number(in_report_unit(info, gate.limits.target))},
                    {"usual", number(in_report_unit(info, gate.limits.usual))},
                    {"usual_share", std::isnan(gate.limits.usual) ? Json(nullptr) : Json(gate.limits.usual_share)},
                    {"fail_share", std::isnan(gate.limits.hard) ? Json(nullptr) : Json(info.fail_share)}};
  json["evidence"] = evidence_json(info);
  if (gate.state == GateState::not_checked) {
    json["reason"] = gate.reason;
    return json;
  }
  json["worst"] = number(in_report_unit(info, gate.worst));
  json["counted"] = info.counted;
  json["total"] = gate.total;
  json["share_within"] = gate.share_within;
  json["beyond_hard"] = gate.n_beyond_hard;
  json["share_beyond_hard"] = gate.share_beyond_hard;
  json["forced"] = gate.n_forced;
  json["beyond_target"] = gate.n_beyond_target;
  json["too_small"] = gate.n_too_small;
  json["too_large"] = gate.n_too_large;
  json["separate_places"] = gate.n_locations ? Json(*gate.n_locations) : Json(nullptr);
  json["share_beyond"] = gate.share_beyond;
  json["share_of"] = info.counted == "area" ? "area" : "volume";
  json["histogram"] = histogram_json(gate, info);
  json["places"] = Json::array();
  for (const GateLocation& location : gate.locations)
    json["places"].push_back({{"value", number(in_report_unit(info, location.value))}, {"position", to_array(location.position)}, {"what", location.what}});
  json["forced_places"] = Json::array();
  for (const GateLocation& location : gate.forced)
    json["forced_places"].push_back({{"value", number(in_report_unit(info, location.value))},
                                     {"position", to_array(location.position)},
                                     {"what", location.what},
                                     {"why", location.forcing.why},
                                     {"remedy", location.forcing.remedy}});
  return json;
}

Json to_json(const PatchCoverage& patch) {
  Json json = {{"patch", patch.patch},
               {"area", patch.area},
               {"full", patch.full},
               {"reduced", patch.reduced},
               {"compressed", patch.compressed},
               {"collapsed", patch.collapsed},
               {"attainable", patch.attainable},
               {"attained", patch.attained}};
  json["lost"] = Json::object();
  for (const auto& [reason, share] : patch.lost) json["lost"][reason] = share;
  return json;
}

std::string coverage_text(const PatchCoverage& patch) {
  std::string text = "         patch " + patch.patch +
                     print_text(": %.2f %% full (the geometry permits %.2f %%), %.2f %% reduced, %.2f %% compressed, %.2f %% collapsed", 100.0 * patch.full,
                                100.0 * patch.attainable, 100.0 * patch.reduced, 100.0 * patch.compressed, 100.0 * patch.collapsed);
  for (const auto& [reason, share] : patch.lost) text += print_text("; %.2f %% ", 100.0 * share) + reason;
  return text + "\n";
}

}  // namespace

std::string_view to_string(Violation v) {
  switch (v) {
    case Violation::unmatched_face: return "unmatched_face";
    case Violation::overmatched_face: return "overmatched_face";
    case Violation::same_sense_face: return "same_sense_face";
    case Violation::stray_boundary_face: return "stray_boundary_face";
    case Violation::duplicate_marker: return "duplicate_marker";
    case Violation::bad_index: return "bad_index";
    case Violation::bad_point: return "bad_point";
    case Violation::unused_node: return "unused_node";
    case Violation::boundary_intersection: return "boundary_intersection";
    case Violation::envelope_intersection: return "envelope_intersection";
    case Violation::invalid_cell: return "invalid_cell";
    case Violation::volume_mismatch: return "volume_mismatch";
    case Violation::broken_line: return "broken_line";
    case Violation::overlapping_parts: return "overlapping_parts";
    case Violation::no_cells: return "no_cells";
    case Violation::cell_within_rounding: return "cell_within_rounding";
    case Violation::negative_sub_volume: return "negative_sub_volume";
    case Violation::sub_volume_within_rounding: return "sub_volume_within_rounding";
    case Violation::open_dual_cell: return "open_dual_cell";
    case Violation::off_symmetry_plane: return "off_symmetry_plane";
    case Violation::periodic_mismatch: return "periodic_mismatch";
  }
  return "";
}

std::string_view title_of_gate(std::string_view gate) {
  if (gate == "G1") return "conformity";
  if (gate == "G2") return "no intersections";
  if (gate == "G3") return "valid cells";
  if (gate == "G4") return "dual sub-volumes, closure";
  if (gate == "G20") return "symmetry, periodic sides";
  return "volumes and cover";
}

std::string_view gate_of(Violation v) {
  switch (v) {
    case Violation::boundary_intersection:
    case Violation::envelope_intersection: return "G2";
    case Violation::invalid_cell:
    case Violation::cell_within_rounding: return "G3";
    case Violation::negative_sub_volume:
    case Violation::sub_volume_within_rounding:
    case Violation::open_dual_cell: return "G4";
    case Violation::off_symmetry_plane:
    case Violation::periodic_mismatch: return "G20";
    case Violation::volume_mismatch:
    case Violation::overlapping_parts:
    case Violation::no_cells: return "tiling";
    default: return "G1";
  }
}

std::int64_t CheckReport::count(Violation v) const {
  for (const auto& [violation, n] : counts)
    if (violation == v) return n;
  return 0;
}

void CheckReport::put(GateResult gate) {
  if (const auto i = static_cast<std::size_t>(gate.measure); i < gates.size()) gates[i] = std::move(gate);
}

GateState CheckReport::quality_state() const {
  GateState worst = GateState::not_checked;
  for (const GateState state : {GateState::pass, GateState::warn, GateState::fail})
    for (const GateResult& gate : gates)
      if (gate.state == state) worst = state;
  return worst;
}

GateState CheckReport::quality_state(Consumer consumer) const {
  GateState worst = GateState::not_checked;
  for (const GateState state : {GateState::pass, GateState::warn, GateState::fail})
    for (const GateResult& gate : gates)
      if (state_for(gate, consumer) == state) worst = state;
  return worst;
}

void CheckReport::restrict_to(Consumers requested) {
  consumers = requested;
  for (GateResult& gate : gates) {
    if (gate.state == GateState::not_checked) continue;
    if (!is_shown(gate)) {
      gate.state = GateState::not_checked;
      gate.reason = "no selected solver uses this measure";
      continue;
    }
    gate.state = GateState::pass;
    for (const Consumer consumer : k_consumers)
      if (const GateState state = state_for(gate, consumer); requested.has(consumer) && state != GateState::not_checked)
        gate.state = std::max(gate.state, state);
  }
}

std::int64_t CheckReport::n_forced() const {
  std::int64_t n = 0;
  for (const GateResult& gate : gates) n += gate.n_forced;
  return n;
}

std::string to_text(const GateResult& gate) { return gate_text(gate); }

std::string verdict_of(const CheckReport& report, Consumer consumer) {
  const GateState state = report.quality_state(consumer);
  std::string text(to_string(state));
  const auto known =
      std::find_if(report.verdict_locations.begin(), report.verdict_locations.end(), [&](const ConsumerLocations& p) { return p.consumer == consumer; });
  if ((state == GateState::warn || state == GateState::fail) && known != report.verdict_locations.end() && known->n_locations && *known->n_locations > 0) {
    const bool is_of_cells = consumer == Consumer::cell_centred;
    text += " at " + locations_text(*known->n_locations);
    if (known->n_beyond > 0)
      text += " (" + rounded_count(known->n_beyond) + " of " + rounded_count(is_of_cells ? report.cells.total() : report.n_nodes) +
              (is_of_cells ? " cells)" : " nodes)");
  }
  std::int64_t n_forced = 0;
  for (const GateResult& gate : report.gates)
    if (info_of(gate.measure).consumers.has(consumer)) n_forced += gate.n_forced;
  return n_forced > 0 ? text + ", " + std::to_string(n_forced) + " forced" : text;
}

std::string verdict_line(const CheckReport& report) {
  std::string text = report.is_valid() ? "VALID" : "INVALID";
  if (!report.quality_measured) return text;
  for (const Consumer consumer : k_consumers)
    if (report.consumers.has(consumer)) text += "; " + std::string(to_string(consumer)) + ": " + verdict_of(report, consumer);
  return text;
}

std::string to_text(const CheckReport& report) {
  const auto n = [](std::int64_t value) { return std::to_string(value); };
  std::string text = verdict_line(report) + "\n";
  text += "  cells: " + n(report.cells.prisms) + " prisms, " + n(report.cells.pyramids) + " pyramids, " + n(report.cells.hexahedra) + " hexahedra, " +
          n(report.cells.tetrahedra) + " tetrahedra; " + n(report.n_nodes) + " nodes; boundary: " + n(report.n_boundary_triangles) + " triangles, " +
          n(report.n_boundary_quads) + " quads\n";
  if (!report.is_complete) text += "  Indices or points are invalid, so nothing else could be checked.\n";
  for (const std::string_view gate : k_valid_gates) text += gate_line(gate, state_of_gate(report, gate));
  if (report.is_complete) {
    text += print_text("  volume: layer %.9g m^3 (error %.1e), tetrahedra %.9g m^3 (error %.1e), total %.9g m^3\n", report.layer_volume,
                       report.layer_volume_error, report.tet_volume, report.tet_volume_error, report.total_volume);
  }
  for (const PeriodicMatchReport& sides : report.periodic)
    text += "  periodic: " + sides.first + " and " + sides.second + ", " + n(sides.n_nodes) + " nodes, " + n(sides.n_faces) + " faces, " +
            format_point(sides.translation) + " m apart, within " + number_text(sides.worst, 3) + " m\n";
  if (report.quality_measured) {
    const Quality& q = report.quality;
    text += print_text("  prisms: worst scaled Jacobian %.3g at ", q.min_wedge_quality) + format_point(q.worst_prism) +
            print_text("; skew below 6 deg %.1f %%, below 18 deg %.1f %%, above 60 deg %.2f %%\n", 100.0 * q.skew_below_6, 100.0 * q.skew_below_18,
                       100.0 * q.skew_above_60);
    text += print_text("  tetrahedra: dihedral angles %.2f deg at ", q.min_dihedral * k_degrees) + format_point(q.worst_tet) +
            print_text(" to %.2f deg at ", q.max_dihedral * k_degrees) + format_point(q.most_obtuse_tet) + "\n";
  }
  for (const GateResult& gate : report.gates) {
    if (!report.is_shown(gate)) continue;
    text += gate_text(gate);
    if (gate.measure != Measure::coverage) continue;
    for (const PatchCoverage& patch : report.coverage) text += coverage_text(patch);
  }
  for (const auto& [violation, count] : report.counts) {
    text += "  " + std::string(gate_of(violation)) + " " + std::string(to_string(violation)) + ": " + n(count) + "\n";
    std::int64_t n_shown = 0;
    for (const CheckFinding& finding : report.findings) {
      if (finding.violation != violation) continue;
      text += "    at " + format_point(finding.position) + ": " + finding.what + "\n";
      ++n_shown;
    }
    if (count > n_shown) text += "    and " + n(count - n_shown) + " more\n";
  }
  return text;
}

std::string to_json(const CheckReport& report) {
  Json json;
  json["schema"] = "sterna-check-2";
  json["verdict"] = report.is_valid() ? "VALID" : "INVALID";
  json["verdict_line"] = verdict_line(report);
  json["verdicts"] = Json::array();
  for (const ConsumerLocations& locations : report.verdict_locations) {
    if (!report.consumers.has(locations.consumer)) continue;
    const bool is_of_cells = locations.consumer == Consumer::cell_centred;
    json["verdicts"].push_back({{"consumer", to_string(locations.consumer)},
                                {"state", state_name(report.quality_state(locations.consumer))},
                                {"separate_places", locations.n_locations ? Json(*locations.n_locations) : Json(nullptr)},
                                {"beyond", locations.n_locations ? Json(locations.n_beyond) : Json(nullptr)},
                                {"total", is_of_cells ? report.cells.total() : report.n_nodes},
                                {"items", is_of_cells ? "cells" : "nodes"}});
  }
  json["quality_verdict"] = report.quality_measured ? to_string(report.quality_state()) : "not checked";
  json["forced"] = report.n_forced();
  json["is_complete"] = report.is_complete;
  json["cells"] = {{"prisms", report.cells.prisms},
                   {"pyramids", report.cells.pyramids},
                   {"hexahedra", report.cells.hexahedra},
                   {"tetrahedra", report.cells.tetrahedra},
                   {"total", report.cells.total()}};
  json["nodes"] = report.n_nodes;
  json["boundary"] = {{"triangles", report.n_boundary_triangles}, {"quads", report.n_boundary_quads}};
  Json& gates = json["gates"];
  for (const std::string_view gate : k_valid_gates) {
    const std::int64_t n = count_of_gate(report, gate);
    gates[std::string(gate)] = is_checked(report, gate) ? Json{{"state", n == 0 ? "pass" : "fail"}, {"violations", n}} : Json{{"state", "not checked"}};
  }
  json["violations"] = Json::object();
  for (const auto& [violation, count] : report.counts) json["violations"][std::string(to_string(violation))] = count;
  json["findings"] = Json::array();
  for (const CheckFinding& finding : report.findings)
    json["findings"].push_back(
        {{"violation", to_string(finding.violation)}, {"gate", gate_of(finding.violation)}, {"position", to_array(finding.position)}, {"what", finding.what}});
  json["volume"] = {{"layer", report.layer_volume},    {"layer_error", report.layer_volume_error},
                    {"tetrahedra", report.tet_volume}, {"tetrahedra_error", report.tet_volume_error},
                    {"total", report.total_volume},    {"dual", report.dual_checked ? Json(report.dual_volume) : Json(nullptr)}};
  json["periodic"] = Json::array();
  for (const PeriodicMatchReport& sides : report.periodic)
    json["periodic"].push_back({{"first", sides.first},
                                {"second", sides.second},
                                {"translation", to_array(sides.translation)},
                                {"nodes", sides.n_nodes},
                                {"faces", sides.n_faces},
                                {"worst_distance", sides.worst}});
  json["measures"] = Json::array();
  for (const GateResult& gate : report.gates) json["measures"].push_back(to_json(gate));
  json["coverage"] = Json::array();
  for (const PatchCoverage& patch : report.coverage) json["coverage"].push_back(to_json(patch));
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
