#include "tests/support/reader_checks.h"

#include <cctype>
#include <string_view>

namespace sterna::test {
namespace {

bool has_number_behind(const std::string& text, std::string_view word) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
    if (at + word.size() < text.size() && std::isdigit(static_cast<unsigned char>(text[at + word.size()]))) return true;
  return false;
}

}  // namespace

std::string flaw_of(const SurfaceSoup& soup) {
  if (soup.patch.size() != soup.triangles.size()) return std::to_string(soup.patch.size()) + " patch numbers for " + std::to_string(soup.triangles.size()) + " triangles";
  for (std::size_t i = 0; i < soup.points.size(); ++i)
    if (!is_finite(soup.points[i])) return "point " + std::to_string(i) + " is not finite";
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    for (const std::uint32_t corner : soup.triangles[t])
      if (corner >= soup.points.size()) return "triangle " + std::to_string(t) + " has point " + std::to_string(corner);
    if (soup.patch[t] >= soup.patch_names.size()) return "triangle " + std::to_string(t) + " is of patch " + std::to_string(soup.patch[t]);
  }
  return {};
}

std::string flaw_of(const HybridMesh& mesh) {
  std::string flaw;
  const auto check_nodes = [&](const auto& nodes, const char* what) {
    for (const NodeId node : nodes)
      if (node.index() >= mesh.points.size()) flaw = "a " + std::string(what) + " has node " + std::to_string(node.value());
  };
  const auto check_faces = [&](const auto& faces) {
    for (const auto& face : faces) {
      check_nodes(face.nodes, "boundary face");
      if (face.patch.index() >= mesh.patches.size()) flaw = "a boundary face is of patch " + std::to_string(face.patch.value());
    }
  };
  for (const NodeId node : mesh.points.ids())
    if (!is_finite(mesh.points[node])) flaw = "node " + std::to_string(node.value()) + " is not finite";
  for_each_cell(mesh, [&](const Cell& cell) { check_nodes(cell.span(), "cell"); });
  check_faces(mesh.boundary_triangles);
  check_faces(mesh.boundary_quads);
  return flaw;
}

bool says_where(const Error& error, bool is_container) {
  const std::string text = error.what();
  for (const std::string_view word : {"line ", "byte ", "cell "})
    if (has_number_behind(text, word)) return true;
  return is_container || text.find("the file is empty") != std::string::npos;
}

}  // namespace sterna::test
