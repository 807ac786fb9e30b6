#include "geom/draw/choices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geom/base/error.h"
#include "geom/base/number_with_unit.h"
#include "geom/math/constants.h"

namespace sterna::draw {
namespace {

struct NamedView {
  std::string_view name;
  Vec3 toward;
};

/// Returns a direction from angles in radians.
Vec3 toward_of(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

/// Returns the named views. The axes are: x downstream, y to the right wing, z upwards. The view "iso" is from ahead, left and above, more from the side than a
/// true isometric view, so that the nose does not obscure the wing.
const std::array<NamedView, 7>& named_views() {
  static const std::array<NamedView, 7> views = {{{"iso", toward_of(k_degree * 232.0, k_degree * 28.0)},
                                                  {"front", {-1, 0, 0}},
                                                  {"back", {1, 0, 0}},
                                                  {"left", {0, -1, 0}},
                                                  {"right", {0, 1, 0}},
                                                  {"top", {0, 0, 1}},
                                                  {"bottom", {0, 0, -1}}}};
  return views;
}

[[noreturn]] void reject(std::string_view option, const std::string& text, std::string hint) {
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "draw: option " + std::string(option),
               .problem = "\"" + text + "\" is not valid",
               .hint = std::move(hint)});
}

/// Parses numbers separated by commas or blanks, with or without a unit: in metres, in radians (degrees without a unit); returns an empty list if any word is
/// not a number.
std::vector<double> numbers_of(std::string_view text, Unit unit) {
  std::vector<double> numbers;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(", "), text.size());
    std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (word.starts_with('+')) word.remove_prefix(1);
    if (word.empty()) continue;
    try {
      numbers.push_back(parse_number_with_unit(word, unit, BareAngle::degrees));
    } catch (const Error&) {
      return {};  // not a number: the caller decides on other meanings
    }
  }
  return numbers;
}

std::optional<Vec3> vector_of(std::string_view text, Unit unit) {
  const std::vector<double> numbers = numbers_of(text, unit);
  if (numbers.size() != 3) return std::nullopt;
  return Vec3{numbers[0], numbers[1], numbers[2]};
}

/// Returns the text after "name=" up to the next name or the end; nothing if the name is missing.
std::optional<std::string_view> value_of(std::string_view text, std::string_view name) {
  const std::size_t at = text.find(std::string(name) + "=");
  if (at == std::string_view::npos) return std::nullopt;
  const std::size_t begin = at + name.size() + 1, next = text.find('=', begin);
  if (next == std::string_view::npos) return text.substr(begin);
  const std::size_t blank = text.rfind(' ', next);
  return text.substr(begin, blank == std::string_view::npos || blank < begin ? 0 : blank - begin);
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c); });
  return result;
}

constexpr std::string_view k_view_hint =
    "iso, front, back, left, right, top, bottom, \"225 30\" (azimuth, elevation) or \"-1,-1,0.5\" (from the mesh to the viewer)";
constexpr std::string_view k_plane_hint = "write x=1.2, y=0, z=-0.5 or \"point=0,0,0 normal=0,1,0\"";

}  // namespace

void throw_unknown(std::string_view attempted, std::string_view what, const std::string& given, std::span<const std::string> known, std::string_view more) {
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  const std::string nearest = nearest_name(given, known);
  throw Error({.code = ErrorCode::unknown_option,
               .attempted = std::string(attempted),
               .problem = "unknown " + std::string(what) + " \"" + given + "\"" + (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"),
               .hint = (list.empty() ? std::string() : "choose one of " + list) + std::string(more)});
}

std::optional<Vec3> view_of(const std::string& text) {
  if (text == "automatic") return std::nullopt;
  const auto& views = named_views();
  if (const auto found = std::find_if(views.begin(), views.end(), [&](const NamedView& view) { return view.name == lower(text); }); found != views.end())
    return found->toward;
  if (const std::vector<double> angles = numbers_of(text, Unit::radian); angles.size() == 2) return toward_of(angles[0], angles[1]);
  if (const std::vector<double> numbers = numbers_of(text, Unit::none); numbers.size() == 3) {
    const Vec3 toward{numbers[0], numbers[1], numbers[2]};
    if (norm(toward) > 0.0) return toward;
    reject("view", text, "the direction has no length");
  }
  std::vector<std::string> known;
  for (const NamedView& view : views) known.emplace_back(view.name);
  throw_unknown("draw", "view", text, known, "; or " + std::string(k_view_hint.substr(k_view_hint.find('"'))));
}

std::optional<CutPlane> plane_of(const std::string& text) {
  if (text.find('=') == std::string::npos) return std::nullopt;
  CutPlane plane;
  const auto point = value_of(text, "point"), normal = value_of(text, "normal");
  if (point || normal) {
    const std::optional<Vec3> origin = point ? vector_of(*point, Unit::metre) : Vec3{}, direction = normal ? vector_of(*normal, Unit::none) : std::nullopt;
    if (!origin || !direction || !(norm(*direction) > 0.0)) reject("cut", text, std::string(k_plane_hint));
    return CutPlane{*origin, normalized(*direction), std::nullopt};
  }
  const std::string axis = lower(text.substr(0, text.find('=')));
  const std::vector<double> at = numbers_of(std::string_view(text).substr(text.find('=') + 1), Unit::metre);
  if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z' || at.size() != 1) reject("cut", text, std::string(k_plane_hint));
  const auto k = static_cast<std::size_t>(axis[0] - 'x');
  plane.normal = {};
  plane.normal[k] = 1.0;
  plane.origin[k] = at[0];
  return plane;
}

std::optional<Sphere> sphere_of(const std::string& text) {
  const auto radius = value_of(text, "radius");
  const std::size_t blank = text.rfind(' ', text.find("radius="));
  if (!radius) {
    if (!numbers_of(text, Unit::metre).empty()) reject("focus", text, "give the radius of the region shown, metres: \"1,2,0 radius=0.5\"");
    return std::nullopt;
  }
  const std::optional<Vec3> center = vector_of(std::string_view(text).substr(0, blank == std::string::npos ? 0 : blank), Unit::metre);
  const std::vector<double> length = numbers_of(*radius, Unit::metre);
  if (!center || length.size() != 1 || !(length[0] > 0.0)) reject("focus", text, "write a point and a radius in metres: \"1,2,0 radius=0.5\"");
  return Sphere{*center, length[0]};
}

const CutLocation& location_of(std::span<const CutLocation> locations, const std::string& name, std::string_view attempted, std::string_view what) {
  for (const CutLocation& location : locations)
    if (location.name == lower(name)) return location;
  std::vector<std::string> known;
  for (const CutLocation& location : locations) known.push_back(location.name);
  throw_unknown(attempted, what, name, known, known.empty() ? "the mesh has no named locations" : "");
}

}  // namespace sterna::draw
