#include "scripting/values/layer_json.h"

namespace sterna::scripting {
namespace {

Json shares_json(const std::vector<std::pair<std::string, double>>& shares) {
  Json json = Json::object();
  for (const auto& [reason, share] : shares) json[reason] = share;
  return json;
}

Json locations_json(const std::vector<ErrorLocation>& locations) {
  Json json = Json::array();
  for (const ErrorLocation& location : locations)
    json.push_back({{"at", {location.position.x, location.position.y, location.position.z}}, {"what", location.what}});
  return json;
}

Json patch_coverage_json(const volmesh::LayerReport& layer) {
  Json patches = Json::array();
  for (const volmesh::PatchLayerReport& patch : layer.patches) {
    patches.push_back({{"name", patch.name},
                       {"area", patch.area},
                       {"full", patch.full},
                       {"attainable", patch.attainable},
                       {"attained", patch.attained},
                       {"compressed", patch.compressed},
                       {"collapsed", patch.collapsed},
                       {"lost_area", shares_json(patch.lost_area)}});
    if (patch.truncated == 0.0) continue;
    patches.back()["truncated"] = patch.truncated;
    patches.back()["least_layers"] = patch.least_layers;
  }
  return patches;
}

Json first_node_json(const volmesh::LayerReport& layer) {
  const volmesh::FirstNodeReport& first = layer.first_node;
  const auto at = [](const Point& p) { return Json{p.x, p.y, p.z}; };
  return {{"vertices_within_2_percent", first.vertex_share},
          {"smooth_facet_area_within_2_percent", first.facet_share},
          {"ridge_area", first.ridge_area},
          {"worst_vertex", {{"deviation", first.worst_vertex}, {"at", at(first.worst_vertex_location)}}},
          {"worst_facet", {{"deviation", first.worst_facet}, {"at", at(first.worst_facet_location)}}}};
}

/// Returns the fractions of the wall's vertices by the angle at which their worst facet is visible.
Json visibility_json(const volmesh::VisibilityReport& visibility) {
  Json list = Json::array();
  for (std::size_t i = 0; i < visibility.share_above.size(); ++i)
    list.push_back({{"degrees", volmesh::k_visibility_limits_deg[i]}, {"share", visibility.share_above[i]}});
  return list;
}

}  // namespace

Json layer_json(const volmesh::LayerReport& layer) {
  Json json = {{"body_length", layer.body_length},
               {"coverage", layer.coverage},
               {"attainable", layer.attainable},
               {"attained", layer.attained},
               {"compressed_area", layer.compressed_area},
               {"collapsed_area", layer.collapsed_area},
               {"target_over_eq1", layer.target_over_eq1},
               {"feature_angle", layer.feature_angle},
               {"max_visibility_angle", layer.visibility.max_angle},
               {"lost_area", shares_json(layer.lost_area)},
               {"mean_height", layer.mean_height},
               {"vertices", layer.n_vertices},
               {"compressed", layer.n_compressed}};
  json["visibility_above"] = visibility_json(layer.visibility);
  json["first_node"] = first_node_json(layer);
  json["interface"] = {{"within", layer.interface.within},
                       {"below", layer.interface.below},
                       {"above", layer.interface.above},
                       {"within_of_full", layer.interface.within_of_full}};
  json["reduced_curving"] = layer.reduced_curving;
  json["patches"] = patch_coverage_json(layer);
  json["most_compressed"] = locations_json(layer.compressed);
  json["collapsed"] = locations_json(layer.collapsed);
  json["warnings"] = layer.warnings;
  return json;
}

Json slivers_json(const volmesh::SliverReport& slivers) {
  Json json = Json::object();
  sliver_entries(slivers, [&](const char* name, const auto& member) {
    if constexpr (std::is_same_v<decltype(member), const Point&>) json[name] = {member.x, member.y, member.z};
    else json[name] = member;
  });
  return json;
}

Json certificate_json(const volmesh::EnvelopeCertificate& certificate) {
  const auto worst = [](const volmesh::WorstElement& element) {
    return Json{{"quality", element.quality}, {"at", {element.location.x, element.location.y, element.location.z}}, {"what", element.what}};
  };
  return {{"proved", certificate.is_proved()},
          {"boundary_triangles", certificate.n_triangles},
          {"pairs_tested", certificate.n_pairs},
          {"crossings", certificate.n_crossings},
          {"swallowed_surfaces", certificate.n_swallowings},
          {"macro_elements", certificate.n_macro_elements},
          {"invalid_macro_elements", certificate.n_invalid_macro_elements},
          {"worst_macro_element", worst(certificate.worst_macro_element)},
          {"layer_cells", certificate.n_layer_cells},
          {"invalid_layer_cells", certificate.n_invalid_layer_cells},
          {"worst_layer_cell", worst(certificate.worst_layer_cell)}};
}

}  // namespace sterna::scripting
