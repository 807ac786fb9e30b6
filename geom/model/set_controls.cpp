#include "geom/model/set_controls.h"

#include <algorithm>
#include <map>
#include <set>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/base/schema.h"
#include "geom/model/deflection.h"

namespace sterna {
namespace {

[[noreturn]] void refuse_setting(const std::string& names, const std::string& problem, const std::string& hint) {
  throw Error({.code = ErrorCode::bad_argument, .attempted = "deflecting \"" + names + "\"", .problem = problem, .hint = hint});
}

std::string segment_name(const std::string& surface, std::size_t i) { return surface + "Segment" + std::to_string(i); }

/// Deflection requested for one surface: by a setting that names it, or by controls.
struct Request {
  const ControlSetting* setting = nullptr;
  double angle = 0.0;
  bool is_by_control = false;
};

class ControlSetter {
 public:
  explicit ControlSetter(const Aircraft& aircraft) : result_(aircraft) {}

  Aircraft set(const std::vector<ControlSetting>& settings) {
    split_segments(settings);
    for (const ControlSetting& setting : settings) request(setting);
    join_segments();
    for (const Wing& wing : result_.wings) turn(wing);
    return std::move(result_);
  }

 private:
  const Control* control_of(const std::string& name) const {
    const auto found = std::ranges::find(result_.controls, name, &Control::name);
    return found == result_.controls.end() ? nullptr : &*found;
  }
  bool is_surface(const std::string& name) const {
    return std::ranges::find(result_.control_surfaces, name, &ControlSurface::name) != result_.control_surfaces.end();
  }

  /// Splits each surface of which the requested controls move segments into one surface per segment.
  void split_segments(const std::vector<ControlSetting>& settings) {
    std::set<std::string> moved;
    for (const ControlSetting& setting : settings) moved.insert(setting.names);  // segments have their own names
    for (const ControlSetting& setting : settings)
      if (const Control* control = is_surface(setting.names) ? nullptr : control_of(setting.names))
        for (const ControlParticipation& p : control->participations) moved.insert(p.segment);
    std::vector<ControlSurface> surfaces;
    for (const ControlSurface& surface : result_.control_surfaces) {
      const std::size_t n = surface.hinge.size() - 1;
      bool is_split = false;
      for (std::size_t i = 0; i < n && n > 1; ++i) is_split = is_split || moved.contains(segment_name(surface.name, i));
      if (!is_split) {
        surfaces.push_back(surface);
        continue;
      }
      for (std::size_t i = 0; i < n; ++i) {
        surfaces.push_back(surface);
        surfaces.back().name = segment_name(surface.name, i);
        surfaces.back().hinge = {surface.hinge[i], surface.hinge[i + 1]};
        segments_[surfaces.back().name] = {surface.name, n};
      }
    }
    result_.control_surfaces = std::move(surfaces);
  }

  void request(const ControlSetting& setting) {
    if (is_surface(setting.names)) return request_one(setting.names, setting);
    if (const Control* control = control_of(setting.names)) return request_by(*control, setting);
    bool is_found = false;
    for (const ControlSurface& surface : result_.control_surfaces)
      if (matches_glob(surface.name, setting.names)) {
        request_one(surface.name, setting);
        is_found = true;
      }
    if (!is_found) refuse_unknown(setting.names);
  }

  void request_one(const std::string& surface, const ControlSetting& setting) {
    const auto [at, is_new] = requested_.insert({surface, {&setting, setting.angle, false}});
    if (!is_new)
      refuse_setting(setting.names, "surface \"" + surface + "\" is already set by \"" + at->second.setting->names + "\"", "give each surface one angle");
  }

  void request_by(const Control& control, const ControlSetting& setting) {
    for (const ControlParticipation& p : control.participations) {
      std::string name = p.segment;
      if (!is_surface(name))  // the only segment of a surface may be called by the name of the surface or of the segment
        for (const ControlSurface& surface : result_.control_surfaces)
          if (segment_name(surface.name, 0) == p.segment && surface.hinge.size() == 2) name = surface.name;
      if (!is_surface(name))
        refuse_setting(setting.names, "this control moves \"" + p.segment + "\", which is not a control surface", "give the names of control surfaces");
      const auto [at, is_new] = requested_.insert({name, {&setting, p.factor * setting.angle, true}});
      if (is_new) continue;
      if (!at->second.is_by_control)
        refuse_setting(setting.names, "surface \"" + name + "\" is already set by \"" + at->second.setting->names + "\"", "give each surface one angle");
      at->second.angle += p.factor * setting.angle;
    }
  }

  [[noreturn]] void refuse_unknown(const std::string& names) const {
    std::vector<std::string> known;
    for (const Control& control : result_.controls) known.push_back(control.name);
    for (const ControlSurface& surface : result_.control_surfaces) known.push_back(surface.name);
    if (known.empty()) refuse_setting(names, "the file describes no control surfaces", "wing:deflect{} adds control surfaces to wings of a script");
    std::string all;
    for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
    const std::string nearest = nearest_name(names, known);
    refuse_setting(names, "no control or control surface has this name" + (nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?"),
                   "the file has " + all);
  }

  /// Joins adjacent segments with equal deflections again. If all segments are joined, the result has the name of their surface.
  void join_segments() {
    std::vector<ControlSurface> joined;
    std::map<std::string, std::string> renamed;  // the first segment of a row that is the whole surface
    for (const ControlSurface& surface : result_.control_surfaces) {
      const auto requested = requested_.find(surface.name), before = joined.empty() ? requested_.end() : requested_.find(joined.back().name);
      const auto segment = segments_.find(surface.name), other = joined.empty() ? segments_.end() : segments_.find(joined.back().name);
      const bool are_alike = requested == requested_.end() ? before == requested_.end()
                                                           : before != requested_.end() && requested->second.angle == before->second.angle &&
                                                                 requested->second.setting->gap == before->second.setting->gap &&
                                                                 requested->second.setting->fairing == before->second.setting->fairing;
      if (segment == segments_.end() || other == segments_.end() || segment->second.first != other->second.first || !are_alike) {
        joined.push_back(surface);
        continue;
      }
      joined.back().hinge.push_back(surface.hinge.back());
      requested_.erase(surface.name);
      if (joined.back().hinge.size() == segment->second.second + 1) renamed[joined.back().name] = segment->second.first;
    }
    for (ControlSurface& surface : joined) {
      const auto name = renamed.find(surface.name);
      if (name == renamed.end()) continue;
      if (auto requested = requested_.extract(surface.name)) {
        requested.key() = name->second;
        requested_.insert(std::move(requested));
      }
      surface.name = name->second;
    }
    result_.control_surfaces = std::move(joined);
  }

  /// Sets the wing's deflections, and patches of its other surfaces.
  void turn(const Wing& wing) {
    std::vector<Deflection> all;
    std::erase_if(result_.deflections, [&](const Deflection& d) {
      if (d.surface.wing != wing.name || requested_.contains(d.surface.name)) return d.surface.wing == wing.name;
      all.push_back(d);
      return true;
    });
    bool is_turned = false;
    for (const ControlSurface& surface : result_.control_surfaces) {
      if (surface.wing != wing.name || std::ranges::any_of(all, [&](const Deflection& d) { return d.surface.name == surface.name; })) continue;
      Deflection d{.surface = surface};
      if (const auto requested = requested_.find(surface.name); requested != requested_.end()) {
        is_turned = true;
        const ControlSetting& setting = *requested->second.setting;
        d.angle = requested->second.angle;
        d.fairing = setting.fairing;
        d.gap = setting.gap;
        d.other_side = surface.has_image ? setting.other_side : OtherSide::none;
      }
      all.push_back(std::move(d));
    }
    if (is_turned) all = with_room_between(wing, std::move(all));
    else std::erase_if(all, [](const Deflection& d) { return d == Deflection{.surface = d.surface}; });
    result_.deflections.insert(result_.deflections.end(), all.begin(), all.end());
  }

  Aircraft result_;
  std::map<std::string, Request> requested_;                             ///< by surface
  std::map<std::string, std::pair<std::string, std::size_t>> segments_;  ///< surface of a segment, and how many it has
};

}  // namespace

Aircraft with_controls_set(const Aircraft& aircraft, const std::vector<ControlSetting>& settings) { return ControlSetter(aircraft).set(settings); }

}  // namespace sterna
