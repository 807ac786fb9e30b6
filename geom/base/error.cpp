#include "geom/base/error.h"

#include <cstdio>

namespace sterna {
namespace {

constexpr std::size_t k_max_locations_in_text = 5;

std::string compose(const ErrorInfo& info) {
  std::string text = info.attempted;
  if (!text.empty() && !info.problem.empty()) text += ": ";
  text += info.problem;
  const std::size_t n_shown = std::min(info.locations.size(), k_max_locations_in_text);
  for (std::size_t i = 0; i < n_shown; ++i) {
    text += "\n  at " + format_point(info.locations[i].position);
    if (!info.locations[i].what.empty()) text += ": " + info.locations[i].what;
  }
  const std::int64_t n_locations = std::max<std::int64_t>(info.n_locations, static_cast<std::int64_t>(info.locations.size()));
  if (n_locations > static_cast<std::int64_t>(n_shown))
    text += "\n  and " + std::to_string(n_locations - static_cast<std::int64_t>(n_shown)) + " more locations";
  if (!info.hint.empty()) text += "\n  try: " + info.hint;
  return text;
}

}  // namespace

std::string_view to_string(ErrorCode code) {
  switch (code) {
    case ErrorCode::bad_argument: return "bad_argument";
    case ErrorCode::unknown_option: return "unknown_option";
    case ErrorCode::script_failed: return "script_failed";
    case ErrorCode::file_not_found: return "file_not_found";
    case ErrorCode::file_malformed: return "file_malformed";
    case ErrorCode::unsupported_format: return "unsupported_format";
    case ErrorCode::write_failed: return "write_failed";
    case ErrorCode::empty_surface: return "empty_surface";
    case ErrorCode::open_surface: return "open_surface";
    case ErrorCode::non_manifold_surface: return "non_manifold_surface";
    case ErrorCode::self_intersection: return "self_intersection";
    case ErrorCode::not_orientable: return "not_orientable";
    case ErrorCode::envelope_failed: return "envelope_failed";
    case ErrorCode::geometry_failed: return "geometry_failed";
    case ErrorCode::tetra_engine_missing: return "tetra_engine_missing";
    case ErrorCode::tetra_engine_failed: return "tetra_engine_failed";
    case ErrorCode::tetra_result_invalid: return "tetra_result_invalid";
    case ErrorCode::mesh_invalid: return "mesh_invalid";
    case ErrorCode::overflow: return "overflow";
    case ErrorCode::cancelled: return "cancelled";
    case ErrorCode::internal: return "internal";
  }
  return "internal";
}

void ErrorInfo::add_location(const Vec3& position, std::string what) {
  ++n_locations;
  if (locations.size() < k_max_locations) locations.push_back({position, std::move(what)});
}

Error::Error(ErrorInfo info) : std::runtime_error(compose(info)), info_(std::make_shared<const ErrorInfo>(std::move(info))) {}

std::int64_t Error::n_locations() const { return std::max<std::int64_t>(info_->n_locations, static_cast<std::int64_t>(info_->locations.size())); }

void throw_bad_argument(std::string_view attempted, std::string problem, std::vector<ErrorLocation> locations, std::string hint) {
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = std::string(attempted),
               .problem = std::move(problem),
               .locations = std::move(locations),
               .hint = std::move(hint)});
}

std::string format_point(const Vec3& p) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, "(%.6g, %.6g, %.6g)", p.x, p.y, p.z);
  return buffer;
}

}  // namespace sterna
