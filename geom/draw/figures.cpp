#include "geom/draw/figures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/mesh/surface_fields.h"

namespace sterna::draw {
namespace {

constexpr std::array<std::string_view, 2> k_cell_figures = {"volume", "layer"};
/// Fraction of the values beyond each end of an automatic range, so that a few outliers do not take all the colours.
constexpr double k_tail = 0.01;

/// Range of quality measures, so that a colour has the same meaning in every picture.
struct JudgedRange {
  std::string_view name;
  double low, high;
};
constexpr std::array<JudgedRange, 7> k_judged_ranges = {{{"quality", 0.0, 1.0},
                                                         {"min_angle", 0.0, 60.0},
                                                         {"coverage", 0.0, 1.0},
                                                         {"growth", 1.0, 1.5},
                                                         {"skew", 0.0, 60.0},
                                                         {"stack_angle", 0.0, 40.0},
                                                         {"scaled_jacobian", 0.0, 1.0}}};

const JudgedRange* judged_range(std::string_view name) {
  const auto found = std::find_if(k_judged_ranges.begin(), k_judged_ranges.end(), [&](const JudgedRange& range) { return range.name == name; });
  return found == k_judged_ranges.end() ? nullptr : &*found;
}

std::vector<std::string> names_of_fields(const std::vector<SurfaceField>& fields) {
  std::vector<std::string> names;
  for (const SurfaceField& field : fields)
    if (std::any_of(field.values.begin(), field.values.end(), [](double v) { return std::isfinite(v); })) names.emplace_back(field.info.name);
  return names;
}

}  // namespace

Coloring coloring_of(const std::string& color, bool has_cut) {
  if (color == "automatic") return has_cut ? Coloring::kind : Coloring::patch;
  if (color == "patch") return Coloring::patch;
  if (color == "kind") return Coloring::kind;
  if (color == "quality") return Coloring::quality;
  std::vector<std::string> known = {"patch", "kind", "quality"};
  for (const SurfaceFieldInfo& info : surface_field_table()) {
    if (info.name == color) return Coloring::face_figure;
    known.emplace_back(info.name);
  }
  for (const std::string_view name : k_cell_figures) {
    known.emplace_back(name);
    if (name != color) continue;
    if (has_cut) return Coloring::cell_figure;
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "draw",
                 .problem = "color = \"" + color + "\" is a quantity of cells, and no cells are shown",
                 .hint = "give a cut, such as cut = \"section 50%\""});
  }
  throw_unknown("draw", "color", color, known);
}

Figure face_figure(const HybridMesh& mesh, const std::string& name, const RunContext& context) {
  const std::vector<SurfaceField> fields = surface_fields(mesh, context);
  const std::vector<std::string> known = names_of_fields(fields);
  const auto has = [&](std::string_view field) { return std::find(known.begin(), known.end(), field) != known.end(); };
  const std::string field_name = name != "quality" ? name : has("scaled_jacobian") ? "scaled_jacobian" : "min_angle";
  if (!has(field_name)) {
    std::string list;
    for (const std::string& one : known) list += (list.empty() ? "" : ", ") + one;
    const bool is_known = find_field(fields, field_name) != nullptr;
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "draw",
                 .problem = "no face of the mesh has a " + field_name,
                 .hint = is_known && !list.empty() ? "the mesh has " + list : ""});
  }
  const SurfaceField& field = *find_field(fields, field_name);
  Figure figure;
  figure.values = field.values;
  figure.bar = {.title = std::string(field.info.title), .unit = std::string(field.info.unit), .is_log = field.info.is_log, .is_low_bad = field.info.is_low_bad};
  const bool is_judged = judged_range(field_name) != nullptr || field_name == "interface_jump";
  figure.bar.scale = is_judged ? Scale::judged : Scale::neutral;
  const GateLimits& limits = field.info.limits;
  for (const auto& [value, text] : {std::pair(limits.hard, "limit"), std::pair(limits.target, "target"), std::pair(limits.usual, "usual")})
    if (std::isfinite(value)) figure.bar.limits.emplace_back(value, text);
  return figure;
}

Figure cell_figure(const MeshCut& cut, const std::string& name) {
  Figure figure;
  if (name == "quality") figure.bar = {.title = "quality of cells (1: ideal)", .scale = Scale::judged, .is_low_bad = true};
  if (name == "volume") figure.bar = {.title = "volume of cells", .unit = "m\u00b3", .is_log = true};
  if (name == "layer") figure.bar = {.title = "layer, from the wall"};
  for (const CutPolygon& polygon : cut.polygons) {
    const double layer = polygon.layer >= 0 ? polygon.layer + 1.0 : std::nan("");
    figure.values.push_back(name == "quality" ? polygon.shape : name == "volume" ? polygon.volume : layer);
  }
  return figure;
}

void set_range(ColorBar& bar, std::vector<double> shown, const std::string& name, const DrawOptions& options) {
  std::erase_if(shown, [&](double v) { return !std::isfinite(v) || (bar.is_log && v <= 0.0); });
  if (shown.empty()) shown.push_back(1.0);
  const auto quantile = [&](double share) {
    const auto at = shown.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(shown.size() - 1) + 0.5);
    std::nth_element(shown.begin(), at, shown.end());
    return *at;
  };
  bar.smallest = quantile(0.0);
  bar.largest = quantile(1.0);
  bar.low = quantile(k_tail);
  bar.high = quantile(1.0 - k_tail);
  const std::string figure = name == "quality" && bar.unit == "deg" ? "min_angle" : name;
  if (const JudgedRange* range = judged_range(figure)) {
    bar.low = range->low;
    bar.high = range->high;
  }
  if (!is_automatic(options.range_min)) bar.low = options.range_min;
  if (!is_automatic(options.range_max)) bar.high = options.range_max;
  const bool is_given = !is_automatic(options.range_min) || !is_automatic(options.range_max);
  if (is_given && (!(bar.low < bar.high) || (bar.is_log && bar.low <= 0.0)))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "draw: options range_min, range_max",
                 .problem = "the colours of " + name + " cannot range from " + number_text(bar.low) + " to " + number_text(bar.high),
                 .hint = "the values shown range from " + number_text(bar.smallest) + " to " + number_text(bar.largest)});
}

double ColorBar::share_of(double value) const {
  const auto position = [&](double v) { return is_log ? std::log10(v) : v; };
  const double width = position(high) - position(low);
  if (!(width > 0.0)) return 0.5;
  if (is_log && value <= 0.0) return 0.0;
  return std::clamp((position(value) - position(low)) / width, 0.0, 1.0);
}

Rgb ColorBar::color_of(double value) const {
  if (!(value == value)) return k_no_value;
  const double share = share_of(value);
  return scale_color(scale, scale == Scale::judged && is_low_bad ? 1.0 - share : share);
}

}  // namespace sterna::draw
