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

/// Returns true if the error of a container file names a location: the path of a group, dataset or attribute, or a variable or attribute by name. The number is
/// given if the name cannot be read. If the library cannot open the file, the head of the file is named. If the library crashes, or its output as a whole is
/// invalid, the file is named.
bool names_node(std::string_view problem) {
  constexpr std::string_view k_head = "the head of the file: ";
  if (problem.starts_with(k_head)) return problem.find("library says: ") != std::string_view::npos || problem.find("ends before") != std::string_view::npos;
  for (const std::string_view begin : {"variable ", "attribute "}) {
    if (!problem.starts_with(begin) || problem.size() == begin.size()) continue;
    const char first = problem[begin.size()];
    return std::isdigit(static_cast<unsigned char>(first)) || (first == '"' && problem.find('"', begin.size() + 1) > begin.size() + 1);
  }
  for (const std::string_view whole :
       {"the file is empty", "the file: reading it needs more memory than ", "the file: the HDF5 library ", "the file: the NetCDF library ",
        "the file: the CGNS library ", "the file: sterna-read-container returned invalid data: ", "the file: its arrays unpack to more than ",
        "the file: it refers to more groups and attributes than "})
    if (problem.starts_with(whole)) return true;
  return problem.starts_with('/') && problem.find(": ") != std::string_view::npos;
}

}  // namespace

std::string flaw_of(const SurfaceSoup& soup) {
  if (soup.patch.size() != soup.triangles.size())
    return std::to_string(soup.patch.size()) + " patch numbers for " + std::to_string(soup.triangles.size()) + " triangles";
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
  if (is_container) return names_node(error.info().problem);
  return text.find("the file is empty") != std::string::npos;
}

}  // namespace sterna::test
