// wing{}: converts the numbers from the root to the tip to sections of geom/model/aircraft.h, which begin at the tip.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "geom/model/wing_span.h"
#include "scripting/lua/component_value.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/verbs/component_verbs.h"
#include "scripting/verbs/geometry_verbs.h"

namespace sterna::scripting {

struct WingOptions {
  std::string name;
  bool symmetric = false;
  std::string spanwise = "linear";
  double sweep_at = 0.25;
  double incidence = 0.0;
  double trailing_edge = k_automatic;
  std::string tip = "round";
  double tip_height = 1.0;
  std::string root = "flat";
};
struct WingSectionOptions {
  double x = k_automatic;
  double y = k_automatic;
  double z = k_automatic;
  double span = k_automatic;
  double chord = k_automatic;
  double sweep = 0.0;
  double dihedral = 0.0;
  double twist = 0.0;
  double roll = k_automatic;
  bool is_break = false;
  bool is_reversed = false;
};
struct WingletOptions {
  std::string name;
  double height = k_automatic;
  double cant = 80.0 * std::numbers::pi / 180.0;
  double taper = 0.4;
  double sweep = 35.0 * std::numbers::pi / 180.0;
  double toe = 0.0;
  double bend = k_automatic;
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::WingOptions> {
  using O = scripting::WingOptions;
  static constexpr std::string_view stage = "wing";
  static constexpr std::array fields = {
      Field<O>{.name = "name", .member = &O::name, .help = "name of the component and its patches; empty: the name of the verb"},
      Field<O>{.name = "symmetric", .member = &O::symmetric, .help = "make both halves: one component if the root is at y = 0, otherwise a mirror image"},
      Field<O>{
          .name = "spanwise", .member = &O::spanwise, .help = "interpolation between sections: linear, or cubic between breaks", .choices = "linear cubic"},
      Field<O>{
          .name = "sweep_at", .member = &O::sweep_at, .min = 0.0, .max = 1.0, .help = "fraction of the chord at which sweep is measured; 0 = leading edge"},
      Field<O>{.name = "incidence",
               .member = &O::incidence,
               .unit = Unit::radian,
               .min = -1.6,
               .max = 1.6,
               .help = "rotation of the whole wing about its position, nose up"},
      Field<O>{.name = "trailing_edge",
               .member = &O::trailing_edge,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "thickness of the trailing edge; 0 = sharp",
               .automatic = "the thickness that the airfoils have"},
      Field<O>{.name = "tip", .member = &O::tip, .help = "shape of the wing tip at the last section", .choices = "round flat"},
      Field<O>{.name = "tip_height",
               .member = &O::tip_height,
               .min = 0.01,
               .max = 5.0,
               .help = "height of a round tip, relative to half the thickness of the section"},
      Field<O>{.name = "root", .member = &O::root, .help = "shape of the wing's end at the first section, if the wing ends there", .choices = "flat round"},
  };
};
template <>
struct Schema<scripting::WingSectionOptions> {
  using O = scripting::WingSectionOptions;
  static constexpr std::string_view stage = "section";
  static constexpr std::array fields = {
      Field<O>{.name = "x",
               .member = &O::x,
               .unit = Unit::metre,
               .help = "x coordinate of the leading edge, relative to the wing's position",
               .automatic = "from sweep"},
      Field<O>{
          .name = "y", .member = &O::y, .unit = Unit::metre, .help = "coordinate of the leading edge", .automatic = "y of the previous section, or from span"},
      Field<O>{.name = "z", .member = &O::z, .unit = Unit::metre, .help = "coordinate of the leading edge", .automatic = "from dihedral"},
      Field<O>{.name = "span",
               .member = &O::span,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "distance from the previous section along the panel, instead of y and z",
               .automatic = "from y and z"},
      Field<O>{.name = "chord",
               .member = &O::chord,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "chord of the airfoil",
               .automatic = "value of the previous section; required in the first section"},
      Field<O>{.name = "sweep",
               .member = &O::sweep,
               .unit = Unit::radian,
               .min = -1.5,
               .max = 1.5,
               .help = "sweep of the panel from the previous section, positive aft; see sweep_at"},
      Field<O>{.name = "dihedral",
               .member = &O::dihedral,
               .unit = Unit::radian,
               .min = -1.5708,
               .max = 1.5708,
               .help = "dihedral of the panel from the previous section, positive upwards"},
      Field<O>{.name = "twist", .member = &O::twist, .unit = Unit::radian, .min = -1.6, .max = 1.6, .help = "rotation about the leading edge, nose up"},
      Field<O>{.name = "roll",
               .member = &O::roll,
               .unit = Unit::radian,
               .help = "rotation of the section about x: 90 deg for an upright fin",
               .automatic = "the mean of the adjacent panels; 0 at the root of a symmetric wing"},
      Field<O>{.name = "is_break", .member = &O::is_break, .help = "make a kink at this section, for spanwise = \"cubic\""},
      Field<O>{.name = "is_reversed", .member = &O::is_reversed, .help = "the airfoil is upside down"},
  };
};
template <>
struct Schema<scripting::WingletOptions> {
  using O = scripting::WingletOptions;
  static constexpr std::string_view stage = "winglet";
  static constexpr std::array fields = {
      Field<O>{.name = "name", .member = &O::name, .help = "name of a separate patch for the winglet with its bend and tip; empty: the wing's patch"},
      Field<O>{.name = "height", .member = &O::height, .unit = Unit::metre, .min = 1e-9, .help = "length along the winglet", .required = true},
      Field<O>{.name = "cant", .member = &O::cant, .unit = Unit::radian, .min = -1.5708, .max = 1.5708, .help = "dihedral of the winglet; 90 deg = upright"},
      Field<O>{.name = "taper", .member = &O::taper, .min = 0.01, .max = 2.0, .help = "chord of the winglet's tip, relative to the chord of the wing's tip"},
      Field<O>{.name = "sweep", .member = &O::sweep, .unit = Unit::radian, .min = -1.5, .max = 1.5, .help = "sweep of the winglet, positive aft"},
      Field<O>{.name = "toe", .member = &O::toe, .unit = Unit::radian, .min = -0.5, .max = 0.5, .help = "twist of the winglet's tip"},
      Field<O>{.name = "bend",
               .member = &O::bend,
               .min = 0.0,
               .max = 0.9,
               .help = "fraction of the winglet's height over which it bends up from the wing; 0 = a kink",
               .automatic = "0.25, or more if the skin on the inside of the bend would fold"},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

/// Number of sections of the bend between wing and winglet. An arc of that many straight segments has an error of 1 % of its radius.
constexpr int k_bend_sections = 5;
/// Default fraction of a winglet's height over which it bends. If this bend is too tight, the radius becomes the section's height on the inside of the bend,
/// times the margin.
constexpr double k_usual_bend = 0.25, k_bend_margin = 1.5;
/// Limits of the fraction and of the margin. With a larger fraction hardly any straight part remains; with a smaller radius hardly any skin remains on the
/// inside.
constexpr double k_most_bend = 0.9, k_least_bend_margin = 1.05;
/// Slope above which a panel must be given by z or span, because y does not define it.
constexpr double k_steep = 1.5;

/// A section as given in the table, in order from the root.
struct GivenSection {
  std::string name;
  Point leading;
  double chord = 0.0;
  double twist = 0.0;
  double roll = k_automatic;
  bool is_break = false;
  bool is_reversed = false;
  double dihedral = 0.0;  ///< dihedral of the panel before this section, at the actual positions
  Airfoil airfoil;
};

/// Returns the angle of a panel about x, which is positive if the panel runs up to the right or down to the left.
double panel_roll(const Point& from, const Point& to) {
  const double dy = to.y - from.y, dz = to.z - from.z;
  return dy < 0.0 ? -std::atan2(dz, -dy) : std::atan2(dz, dy);
}

class SectionList {
 public:
  SectionList(const ScriptCall& call, TableReader& reader, const WingOptions& options) : call_(call), reader_(reader), options_(options) {}

  void read(const ScriptValue* sections) {
    const auto* list = sections ? std::get_if<TableHandle>(sections) : nullptr;
    if (!list || (*list)->items.size() < 2) {
      reader_.add_problem("sections: needs a list of at least 2 sections: " + std::string(k_wing_usage));
      return;
    }
    for (std::size_t i = 0; i < (*list)->items.size(); ++i) add((*list)->items[i], "section " + std::to_string(i + 1));
  }
  void add_winglet(const ScriptValue& value, const Point& position);

  std::vector<GivenSection> sections;
  std::string winglet_name;          ///< empty: there is no winglet, or it is part of the wing's patch
  std::size_t n_before_winglet = 0;  ///< number of sections of the wing itself

 private:
  void add(const ScriptValue& value, const std::string& where);
  void place(GivenSection& section, const WingSectionOptions& o, const std::string& where);
  const ScriptCall& call_;
  TableReader& reader_;
  const WingOptions& options_;
};

/// Sets the position of the section from the given values and the previous section.
void SectionList::place(GivenSection& s, const WingSectionOptions& o, const std::string& where) {
  const bool is_first = sections.empty();
  const Point before = is_first ? Point{} : sections.back().leading;
  const auto or_else = [](double value, double other) { return is_automatic(value) ? other : value; };
  if (!is_automatic(o.span)) {
    if (is_first) reader_.add_problem(where + ": span: there is no previous section");
    if (!is_automatic(o.y) || !is_automatic(o.z)) reader_.add_problem(where + ": give y and z, or span and dihedral");
    s.leading.y = before.y + o.span * std::cos(o.dihedral);
    s.leading.z = before.z + o.span * std::sin(o.dihedral);
  } else {
    s.leading.y = or_else(o.y, before.y);
    if (is_automatic(o.z) && std::abs(o.dihedral) > k_steep) reader_.add_problem(where + ": a panel this steep needs z, or span instead of y");
    s.leading.z = or_else(o.z, before.z + std::abs(s.leading.y - before.y) * std::tan(std::clamp(o.dihedral, -k_steep, k_steep)));
  }
  const double step = std::hypot(s.leading.y - before.y, s.leading.z - before.z);
  const double chord_before = is_first ? s.chord : sections.back().chord;
  s.leading.x = or_else(o.x, is_first ? 0.0 : before.x + options_.sweep_at * (chord_before - s.chord) + step * std::tan(o.sweep));
  if (!is_first && step == 0.0) reader_.add_problem(where + ": has the location of the previous section; give y, z or span");
}

void SectionList::add(const ScriptValue& value, const std::string& where) {
  const auto* table = std::get_if<TableHandle>(&value);
  if (!table) {
    reader_.add_problem(where + ": expected a section { y = 5, chord = 2 }, not " + std::string(type_text(value)));
    return;
  }
  WingSectionOptions o;
  const OptionTable schema = sterna::options_of(o);
  TableReader reader(**table, where);
  reader.read_options(schema);
  const auto position = read_point(reader, "position");
  if (position && !(is_automatic(o.x) && is_automatic(o.y) && is_automatic(o.z) && is_automatic(o.span)))
    reader.add_problem("position: replaces x, y, z and span; give either");
  GivenSection s{.name = where, .chord = o.chord, .twist = o.twist, .roll = o.roll, .is_break = o.is_break, .is_reversed = o.is_reversed};
  if (is_automatic(s.chord)) {
    if (sections.empty()) reader.add_problem("needs a chord");
    s.chord = sections.empty() ? 1.0 : sections.back().chord;
  }
  if (const ScriptValue* airfoil = reader.field("airfoil")) {
    if (auto given = read_airfoil_value(*airfoil, call_, reader, "airfoil")) s.airfoil = normalized(*given);
  } else if (!sections.empty()) {
    s.airfoil = sections.back().airfoil;
  } else {
    reader.add_problem("needs an airfoil: a NACA designation, a file name or airfoil{...}");
  }
  try {
    reader.finish();
  } catch (const Error& error) {
    reader_.add_problem(where + ": " + error.info().problem);
  }
  if (position) s.leading = *position;
  else place(s, o, where);
  sections.push_back(std::move(s));
}

/// Returns the minimum fraction of a winglet's height over which the winglet must turn, so that the skin on the inside of the bend does not fold. The radius of
/// the bend must exceed the height of the section there.
double least_bend(const GivenSection& tip, double turn, double height) {
  double inside = 0.0;  // largest height of the section on the inside, relative to the chord, from the leading edge, normal to the panel
  for (const Uv& p : tip.airfoil.points) {
    const double v = (tip.is_reversed ? -p.v : p.v) - p.u * std::sin(tip.twist);
    inside = std::max(inside, turn > 0.0 ? v : -v);
  }
  return inside * tip.chord * std::abs(turn) / height;
}

/// Returns the fraction over which the winglet bends. \throws Error(bad_argument) through the reader if the requested bend is too tight, or if every bend would
/// be
double bend_of(const WingletOptions& o, const GivenSection& tip, double from, const Point& position, TableReader& reader) {
  const double turn = o.cant - from, least = least_bend(tip, turn, o.height);
  if (o.bend == 0.0) return o.bend;
  const double least_allowed = k_least_bend_margin * least;
  double bend = o.bend;
  if (is_automatic(bend)) bend = k_usual_bend >= least_allowed ? k_usual_bend : std::min(k_bend_margin * least, k_most_bend);
  if (bend >= least) return bend;
  reader.add_problem(
      fmt::format("winglet: bend: a turn by {:.3g} deg over {:.3g} of {:.4g} m, at {}, has a radius of {:.3g} m; the wing is {:.3g} m thick on the inside of "
                  "the bend, so its skin would fold: {}",
                  std::abs(turn) * 180.0 / std::numbers::pi, bend, o.height, format_point(tip.leading + (position - Point{})), bend * o.height / std::abs(turn),
                  least * o.height / std::abs(turn),
                  least_allowed <= k_most_bend
                      ? fmt::format("bend = {:.2g} at least, a larger height, or 0 for a kink", std::ceil(100.0 * least_allowed) / 100.0)
                      : fmt::format("height = {:.4g} at least, a thinner tip, or bend = 0 for a kink", k_bend_margin * least * o.height / k_most_bend)));
  return bend;
}

/// Continues the wing upwards from the last section, by a bend of sections with equal turn, then straight to the winglet's tip.
void SectionList::add_winglet(const ScriptValue& value, const Point& position) {
  const auto* table = std::get_if<TableHandle>(&value);
  if (!table) {
    reader_.add_problem("winglet: expected a table { height = 1, cant = 80*deg }, not " + std::string(type_text(value)));
    return;
  }
  WingletOptions o;
  const OptionTable schema = sterna::options_of(o);
  TableReader reader(**table, "winglet");
  reader.read_options(schema);
  reader.require(schema);
  std::optional<Airfoil> airfoil;
  if (const ScriptValue* given = reader.field("airfoil")) airfoil = read_airfoil_value(*given, call_, reader, "airfoil");
  try {
    reader.finish();
  } catch (const Error& error) {
    reader_.add_problem("winglet: " + error.info().problem);
    return;
  }
  if (o.name == options_.name) reader_.add_problem("winglet: name: \"" + o.name + "\" is the name of the wing; choose another");
  if (sections.size() < 2) return;
  winglet_name = o.name;
  n_before_winglet = sections.size();
  const GivenSection tip = sections.back();
  const double from = panel_roll(sections[sections.size() - 2].leading, tip.leading);
  sections.back().roll = from;
  Point at = tip.leading;
  double done = 0.0, chord = tip.chord;
  const auto go = [&](double length, double angle, double roll, bool is_break, const std::string& name) {
    const double next_chord = tip.chord * (1.0 + (o.taper - 1.0) * (done + length) / o.height);
    at += Vec3{options_.sweep_at * (chord - next_chord) + length * std::tan(o.sweep), length * std::cos(angle), length * std::sin(angle)};
    done += length;
    chord = next_chord;
    const double part = done / o.height;
    GivenSection s{.name = name,
                   .leading = at,
                   .chord = chord,
                   .twist = tip.twist + part * o.toe,
                   .roll = roll,
                   .is_break = is_break,
                   .airfoil = airfoil && part == 1.0 ? normalized(*airfoil) : tip.airfoil};
    sections.push_back(std::move(s));
  };
  sections.back().is_break = true;
  const double bend = bend_of(o, tip, from, position, reader_);
  if (bend > 0.0) {
    for (int i = 1; i <= k_bend_sections; ++i) {
      const double middle = from + (o.cant - from) * (i - 0.5) / k_bend_sections, here = from + (o.cant - from) * i / k_bend_sections;
      go(bend * o.height / k_bend_sections, middle, here, i == k_bend_sections, "winglet " + std::to_string(i));
    }
  } else {
    sections.back().roll = 0.5 * (from + o.cant);
  }
  done = bend * o.height;
  go(o.height - done, o.cant, o.cant, true, "winglet tip");
}

/// Sets the rolls that are not given.
void complete_rolls(std::vector<GivenSection>& sections, bool is_root_in_plane) {
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (!is_automatic(sections[i].roll)) continue;
    const bool has_before = i > 0, has_after = i + 1 < sections.size();
    const double before = has_before ? panel_roll(sections[i - 1].leading, sections[i].leading) : 0.0;
    const double after = has_after ? panel_roll(sections[i].leading, sections[i + 1].leading) : 0.0;
    sections[i].roll = has_before && has_after ? 0.5 * (before + after) : has_before ? before : is_root_in_plane ? 0.0 : after;
  }
}

/// Applies roll about x, then twist about the section's own span axis. Both become rotations about the fixed axes x, y, z.
WingSection section_of(const GivenSection& s) {
  const double cr = std::cos(s.roll), sr = std::sin(s.roll), ct = std::cos(s.twist), st = std::sin(s.twist);
  WingSection section{.name = s.name, .leading_edge = s.leading, .chord = s.chord};
  section.twist = std::asin(std::clamp(cr * st, -1.0, 1.0));
  section.yaw = std::atan2(sr * st, ct);
  section.dihedral = std::atan2(sr, cr * ct);
  section.airfoil = s.airfoil.name;
  section.points = s.airfoil.points;
  section.is_break = s.is_break;
  section.is_reversed = s.is_reversed;
  return section;
}

/// Returns a deflection of zero angle, which is a named patch. It covers the wing from its first section, the tip, to another section.
Deflection winglet_patch(const Wing& wing, const std::string& name, std::size_t last_section) {
  constexpr double k_any_chord = 0.5;  // the position of the hinge is arbitrary, because nothing turns
  const bool has_other_side = wing.is_symmetric || wing.has_mirror_image;
  return {.surface = {.name = name,
                      .wing = wing.name,
                      .kind = ControlKind::all_moving,
                      .hinge = {{0.0, k_any_chord}, {WingSpan(wing).fractions()[last_section], k_any_chord}},
                      .has_image = has_other_side},
          .other_side = has_other_side ? OtherSide::same : OtherSide::none};
}

}  // namespace

ScriptValue make_wing_verb(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_wing_usage);
  WingOptions o{.name = "wing"};
  const OptionTable schema = sterna::options_of(o);
  TableReader reader(table, call.attempted());
  const Point position = read_point(reader, "position").value_or(Point{});
  reader.read_options(schema);
  if (o.name.empty()) reader.add_problem("name: must not be empty");
  SectionList list(call, reader, o);
  list.read(reader.field("sections"));
  if (const ScriptValue* winglet = reader.field("winglet")) list.add_winglet(*winglet, position);
  reader.finish();
  std::vector<GivenSection>& given = list.sections;
  const bool is_root_in_plane = position.y + given.front().leading.y == 0.0 &&
                                std::any_of(given.begin(), given.end(), [&](const GivenSection& s) { return s.leading.y != given.front().leading.y; });
  const bool is_one = o.symmetric && is_root_in_plane;
  complete_rolls(given, is_one);
  Wing wing{.name = o.name,
            .placement = {position, {0.0, o.incidence, 0.0}},
            .is_symmetric = is_one,
            .has_mirror_image = o.symmetric && !is_one,
            .is_cubic = o.spanwise == "cubic"};
  for (std::size_t i = given.size(); i-- > 0;) wing.sections.push_back(section_of(given[i]));
  if (!is_automatic(o.trailing_edge)) wing.trailing_edge = o.trailing_edge;
  wing.right_tip = {CapShape::strip, o.tip == "round" ? o.tip_height : 0.0};
  wing.left_tip = is_one ? wing.right_tip : EndCap{CapShape::strip, o.root == "round" ? o.tip_height : 0.0};
  std::vector<Deflection> patches;
  if (!list.winglet_name.empty()) patches.push_back(winglet_patch(wing, list.winglet_name, given.size() - list.n_before_winglet));
  return std::make_shared<ComponentValue>(
      ComponentValue{.kind = ComponentKind::wing, .shape = std::move(wing), .intake = {}, .exhaust = {}, .deflections = std::move(patches)});
}

std::string wing_help() {
  WingOptions wing;
  WingSectionOptions section;
  WingletOptions winglet;
  constexpr const char* k_position = "  position = {x, y, z}\n      ";
  constexpr const char* k_airfoil = "  airfoil = \"naca23012\", a file's name, or airfoil{...}\n      ";
  return options_help(sterna::options_of(wing)) + k_position +
         "position of the whole wing; {0, 0, 0}\n  sections = { {...}, {...} }\n      required: at least two, from the root to the tip\n  winglet = {...}\n    "
         "  continues the wing behind the last section; none\n" +
         "each section:\n" + options_help(sterna::options_of(section)) + k_position + "position of the leading edge, instead of x, y, z and span\n" +
         k_airfoil + "value of the previous section; required in the first section\n" + "winglet:\n" + options_help(sterna::options_of(winglet)) + k_airfoil +
         "airfoil of the winglet's tip; the airfoil of the wing's tip\n";
}

}  // namespace sterna::scripting
