#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/mesh/compare_geometry.h"

namespace sterna {
namespace {

using Json = nlohmann::ordered_json;

constexpr int k_digits = 4;
constexpr std::size_t k_worst = 3;           ///< names per sentence
constexpr std::size_t k_most_in_json = 100;  ///< entries per list

std::string percent(double before, double after) {
  const double share = 100.0 * (after - before) / before;
  return (share > 0.0 ? "+" : "") + number_text(share, 3) + " %";
}

std::string from_to(double before, double after, const char* unit) {
  return number_text(before, k_digits) + " -> " + number_text(after, k_digits) + " " + unit + (before > 0.0 ? " (" + percent(before, after) + ")" : "");
}

template <class List, class Words>
std::string worst_of(const List& list, const Words& words) {
  std::string text;
  for (std::size_t i = 0; i < std::min(k_worst, list.size()); ++i) text += (i > 0 ? ", " : "") + words(list[i]);
  if (list.size() > k_worst) text += " and " + std::to_string(list.size() - k_worst) + " more";
  return text;
}

std::string words_of(const PartChange& part) {
  return "\"" + part.name + "\" (" + (part.volume > 0.0 ? number_text(part.volume, k_digits) + " m3" : "open, " + number_text(part.area, k_digits) + " m2") +
         ")";
}

std::string box_text(const Box& box) { return format_point(box.min) + " to " + format_point(box.max); }

/// Returns the differences: "area ..., enclosed volume ..., patch ...".
std::string differences(const GeometryChange& change) {
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
  if (change.is_area_changed()) add("area " + from_to(change.before.area, change.after.area, "m2"));
  if (change.is_volume_changed()) add("enclosed volume " + from_to(*change.before.volume, *change.after.volume, "m3"));
  if (change.is_box_changed()) add("box " + box_text(change.before.box) + " -> " + box_text(change.after.box));
  if (!change.changed_patches.empty())
    add("area of " + worst_of(change.changed_patches, [](const PatchChange& p) { return "patch \"" + p.name + "\" " + from_to(p.before, p.after, "m2"); }));
  return text;
}

/// Returns true if area or volume exceed the possible range of a union of these bodies.
bool is_beyond_union(const GeometryChange& change) {
  return change.after.area > (1.0 + k_reported_change) * change.before.area ||
         (change.before.volume && change.after.volume && *change.after.volume > (1.0 + k_reported_change) * *change.before.volume);
}

Json box_json(const Box& box) {
  if (box.empty()) return nullptr;
  return {{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}};
}

Json part_json(const PartChange& part) {
  return {{"name", part.name}, {"at", {part.location.x, part.location.y, part.location.z}}, {"area", part.area}, {"volume", part.volume}};
}

template <class List, class Make>
Json list_json(const List& list, const Make& make) {
  Json json = Json::array();
  for (std::size_t i = 0; i < std::min(k_most_in_json, list.size()); ++i) json.push_back(make(list[i]));
  return json;
}

}  // namespace

std::vector<std::string> warnings_of(const GeometryChange& change, GeometryChangeUse use) {
  std::vector<std::string> warnings;
  if (!change.missing_patches.empty())
    warnings.push_back(
        change.by + ": the result has no " + (change.missing_patches.size() == 1 ? "patch " : "patches ") +
        worst_of(change.missing_patches, [](const PatchChange& p) { return "\"" + p.name + "\" (" + number_text(p.before, k_digits) + " m2)"; }) +
        ", which the input has; boundary conditions there would be lost");
  if (!change.missing_parts.empty())
    warnings.push_back(change.by + ": " + (change.missing_parts.size() == 1 ? "part " : "parts ") + worst_of(change.missing_parts, words_of) +
                       " of the input " + (change.missing_parts.size() == 1 ? "is" : "are") + " missing in the result");
  if (use == GeometryChangeUse::keeps_shape) {
    for (const std::vector<PartChange>& joined : change.joined_parts)
      warnings.push_back(change.by + ": parts " + worst_of(joined, words_of) + " are one part of the result");
    if (const std::string text = differences(change); !text.empty()) warnings.push_back(change.by + ": the geometry differs from the input: " + text);
  } else if (is_beyond_union(change)) {
    warnings.push_back(change.by + ": the result is larger than the sum of its parts: " + differences(change));
  }
  if (!change.divided_parts.empty())
    warnings.push_back(change.by + ": " + (change.divided_parts.size() == 1 ? "part " : "parts ") + worst_of(change.divided_parts, words_of) +
                       " of the input became several parts");
  return warnings;
}

std::string to_text(const GeometryChange& change) {
  std::string text = "area " + from_to(change.before.area, change.after.area, "m2");
  if (change.before.volume && change.after.volume) text += ", enclosed volume " + from_to(*change.before.volume, *change.after.volume, "m3");
  return text + ", parts " + std::to_string(change.before.n_parts) + " -> " + std::to_string(change.after.n_parts);
}

std::string to_json(const GeometryChange& change) {
  const auto volume = [](const GeometryFigures& figures) { return figures.volume ? Json(*figures.volume) : Json(nullptr); };
  const auto patch = [](const PatchChange& p) { return Json{{"name", p.name}, {"before", p.before}, {"after", p.after}}; };
  Json json = {{"by", change.by},
               {"area", {{"before", change.before.area}, {"after", change.after.area}}},
               {"volume", {{"before", volume(change.before)}, {"after", volume(change.after)}}},
               {"parts", {{"before", change.before.n_parts}, {"after", change.after.n_parts}}},
               {"closed_parts", {{"before", change.before.n_closed}, {"after", change.after.n_closed}}},
               {"box", {{"before", box_json(change.before.box)}, {"after", box_json(change.after.box)}}}};
  json["missing_patches"] = list_json(change.missing_patches, patch);
  json["changed_patches"] = list_json(change.changed_patches, patch);
  json["missing_parts"] = list_json(change.missing_parts, part_json);
  json["joined_parts"] = list_json(change.joined_parts, [](const std::vector<PartChange>& joined) { return list_json(joined, part_json); });
  json["divided_parts"] = list_json(change.divided_parts, part_json);
  return json.dump();
}

}  // namespace sterna
