#include "io/grammar/ugrid_source.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>

namespace sterna::io {
namespace {

std::string lower_name(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  return name;
}

struct NamedVariant {
  std::string_view end;
  UgridVariant variant;
};
constexpr std::array<NamedVariant, 6> k_binary_variants = {{
    {".b8.ugrid", {.order = std::endian::big}},
    {".lb8.ugrid", {.order = std::endian::little}},
    {".b8l.ugrid", {.is_wide = true, .order = std::endian::big}},
    {".lb8l.ugrid", {.is_wide = true, .order = std::endian::little}},
    {".b4.ugrid", {.is_single = true, .order = std::endian::big}},
    {".lb4.ugrid", {.is_single = true, .order = std::endian::little}},
}};

}  // namespace

UgridVariant ugrid_variant(const std::filesystem::path& path) {
  const std::string name = lower_name(path);
  for (const NamedVariant& candidate : k_binary_variants)
    if (name.ends_with(candidate.end)) return candidate.variant;
  for (const std::string_view end : {".r8.ugrid", ".lr8.ugrid", ".r4.ugrid", ".lr4.ugrid"})
    if (name.ends_with(end))
      throw_unsupported(path.string(), "UGRID files with Fortran records (" + std::string(end) + ")", "write the mesh as .lb8.ugrid or .b8.ugrid");
  return {.is_text = true};
}

UgridSource::UgridSource(Borrowed<const FileBuffer> buffer, const UgridVariant& variant) : variant_(variant) {
  if (variant.is_text) text_.emplace(buffer);
  else bytes_.emplace(buffer, variant.order);
}

void UgridSource::require(std::uint64_t n, std::size_t bytes, std::string_view expected) const {
  if (bytes_) return bytes_->require(n, bytes, expected);
  if (n > (text_->remaining() + 1) / bytes)  // the last line may lack its line end
    fail("found " + std::to_string(text_->remaining()) + " bytes to the end of the file, expected the text of " + std::to_string(n) + " " +
             std::string(expected),
         "the file may have been cut short: copy or write it again");
}

std::int64_t UgridSource::integer(std::string_view expected) {
  if (text_) return text_->integer(expected);
  return variant_.is_wide ? bytes_->read<std::int64_t>(expected) : bytes_->read<std::int32_t>(expected);
}

std::uint64_t UgridSource::count(std::string_view expected) {
  const std::int64_t n = integer(expected);
  if (n < 0)
    fail("found the count " + std::to_string(n) + " as " + std::string(expected) + ", expected 0 or more",
         text_ ? "" : "check that the byte order of the file is the one in its name");
  return static_cast<std::uint64_t>(n);
}

double UgridSource::real() {
  constexpr std::string_view k_expected = "a coordinate of a point";
  if (text_) return text_->coordinate(k_expected);
  return variant_.is_single ? static_cast<double>(bytes_->read<float>(k_expected)) : bytes_->read<double>(k_expected);
}

Vec3 UgridSource::any_point() {
  Vec3 p;
  for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = real();
  return p;
}

Vec3 UgridSource::point(std::uint64_t i) {
  const Vec3 p = any_point();
  if (!is_finite(p)) fail("point " + std::to_string(i + 1) + " is not finite");
  return p;
}

std::uint32_t UgridSource::node(std::uint64_t n_nodes) {
  const std::int64_t node = integer("a node number");
  if (node < 1 || static_cast<std::uint64_t>(node) > n_nodes) fail("found point " + std::to_string(node) + ", expected 1 to " + std::to_string(n_nodes));
  return static_cast<std::uint32_t>(node - 1);
}

void UgridSource::skip_integers(std::uint64_t n, std::string_view expected) {
  if (bytes_) {
    bytes_->require(n, integer_bytes(), expected);
    return bytes_->skip(n * integer_bytes());
  }
  for (std::uint64_t i = 0; i < n; ++i) text_->integer(expected);
}

void UgridSource::fail(const std::string& problem, std::string_view hint) const {
  if (bytes_) bytes_->fail(problem, hint);
  text_->fail(problem, hint);
}

std::filesystem::path found_mapbc(const std::filesystem::path& mesh_path) {
  std::string stem = mesh_path.filename().string();
  std::filesystem::path file;
  std::error_code status;  // if the file cannot be accessed; load_file reports the error of an existing file
  if (equal_ignoring_case(mesh_path.extension().string(), ".gz")) stem.resize(stem.size() - 3);
  for (int n_extensions = 0; n_extensions < 2 && stem.find('.') != std::string::npos; ++n_extensions) {  // ".ugrid", then ".lb8"
    stem.resize(stem.rfind('.'));
    const std::filesystem::path candidate = mesh_path.parent_path() / (stem + ".mapbc");
    if (file.empty() && std::filesystem::exists(candidate, status)) file = candidate;
    if (ugrid_variant(mesh_path).is_text) break;
  }
  return file;
}

std::map<std::int64_t, UgridPatch> read_mapbc(const std::filesystem::path& mesh_path, const RunContext& context) {
  const std::filesystem::path file = found_mapbc(mesh_path);
  std::map<std::int64_t, UgridPatch> patches;
  if (file.empty()) return patches;
  const FileBuffer buffer = load_file(file, context);
  TextScanner scanner(buffer);
  const std::size_t n = scanner.count("the number of patches", 4);
  scanner.next_line();
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t id = scanner.integer("a patch number");
    UgridPatch patch{.condition = scanner.integer("a boundary condition number"), .name = {}};
    patch.name = scanner.rest_of_line();
    patches[id] = std::move(patch);
  }
  return patches;
}

std::filesystem::path mapbc_path(const std::filesystem::path& mesh_path) {
  std::filesystem::path stem = mesh_path.stem();
  if (!ugrid_variant(mesh_path).is_text) stem = stem.stem();
  return mesh_path.parent_path() / (stem.string() + ".mapbc");
}

std::optional<PatchKind> kind_of_condition(std::int64_t condition) {
  switch (condition) {
    case 3:
    case 5000:
    case 5025:
    case 5050: return PatchKind::farfield;
    case 4:
    case 4000:
    case 4100:
    case 4110: return PatchKind::wall;
    case 5:
    case 3000: return PatchKind::slip;
    case 6021:
    case 6022:
    case 6023:
    case 6661:
    case 6662:
    case 6663: return PatchKind::symmetry;
    case 7011:
    case 7036:
    case 7100: return PatchKind::inflow;
    case 5026:
    case 5051:
    case 7012:
    case 7031: return PatchKind::outflow;
    default: return std::nullopt;
  }
}

}  // namespace sterna::io
