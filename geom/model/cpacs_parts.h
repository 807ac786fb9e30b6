// Declarations shared by the files of the CPACS reader.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "geom/math/constants.h"
#include "geom/model/aircraft.h"
#include "geom/model/frame.h"
#include "geom/model/xml_file.h"

namespace sterna::cpacs {

/// The file and its index of uIDs.
struct Document {
  explicit Document(const std::filesystem::path& path);
  ~Document();
  XmlFile file;
  /// Returns the element with a uID.
  /// \throws Error(file_malformed) at `from` if there is none
  pugi::xml_node resolve(const pugi::xml_node& from, const std::string& uid) const;
  /// Returns the element with a uID; an empty node if there is none.
  pugi::xml_node find(const std::string& uid) const;

 private:
  struct Uids;
  std::unique_ptr<Uids> uids_;
};

/// Scaling, then rotation, then translation, read from the child element `transformation`.
struct Transformation {
  Vec3 scaling{1.0, 1.0, 1.0};
  Vec3 rotation;  ///< radians about x, y', z''
  Vec3 translation;
  bool is_absolute = false;  ///< the translation is relative to the origin, not to that of the parent component
  Transform matrix() const;
};
Transformation read_transformation(const Document& document, const pugi::xml_node& element);
Vec3 read_vector(const XmlFile& file, const pugi::xml_node& element, const Vec3& fallback);

/// Returns an airfoil of unit chord by its uID: u = x, v = z; trailing edge, upper side, leading edge, lower side, trailing edge.
std::vector<Uv> read_airfoil(const Document& document, const pugi::xml_node& from, const std::string& uid);
/// Returns a fuselage profile by its uID, u = y, v = z: counter-clockwise seen from behind (bottom, right, top, left), starting at its lowest point, without
/// repeated points. Half profiles (open, ends at y = 0) are completed, and a message is added.
std::vector<Uv> read_fuselage_profile(Document& document, const pugi::xml_node& from, const std::string& uid);
/// Returns a nacelle or curve profile, u = x, v = y, as written in the file.
std::vector<Uv> read_curve_profile(const Document& document, const pugi::xml_node& from, const std::string& uid);
/// Reverses the points if necessary so that the signed area has the sign of `sign`.
void orient(std::vector<Uv>& points, double sign);

/// Reads the nacelle of an engine installed at `placement`.
CowlNacelle read_nacelle(Document& document, const pugi::xml_node& installed, const Transform& placement);

}  // namespace sterna::cpacs
