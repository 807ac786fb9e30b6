// Reads NetCDF with libnetcdf from memory. Truncated files are then detected: reading from disk would fill missing data with zeros. NetCDF-4 is HDF5 and is
// first scanned as such, because libnetcdf does not report problems of variables such as external data or missing chunks.
#include <netcdf.h>
#include <netcdf_mem.h>

#include <cerrno>
#include <map>
#include <optional>

#include "io/read_container/image_layout.h"

namespace sterna::io::reader {
namespace {

using wire::Trouble;

constexpr std::string_view k_hdf5_signature = "\x89HDF\r\n\x1a\n";

std::optional<NumberKind> kind_of(nc_type type) {
  switch (type) {
    case NC_BYTE: return NumberKind::i1;
    case NC_CHAR: return NumberKind::text;
    case NC_SHORT: return NumberKind::i2;
    case NC_INT: return NumberKind::i4;
    case NC_FLOAT: return NumberKind::f4;
    case NC_DOUBLE: return NumberKind::f8;
    case NC_UBYTE: return NumberKind::u1;
    case NC_USHORT: return NumberKind::u2;
    case NC_UINT: return NumberKind::u4;
    case NC_INT64: return NumberKind::i8;
    case NC_UINT64: return NumberKind::u8;
    default: return std::nullopt;
  }
}

void require(int status, const std::string& where) {
  if (status == NC_NOERR) return;
  if (status == NC_ENOMEM) throw std::bad_alloc();
  const std::string problem = status == EPERM ? "the file ends before the end of its values"
                                              : std::string("the NetCDF library says: ") + nc_strerror(status);  // EPERM: the file would have to grow
  throw Failure{.outcome = wire::Outcome::malformed, .where = where, .problem = problem, .hint = "the file may have been cut short: copy or write it again"};
}

class NetcdfNodes {
 public:
  NetcdfNodes(std::string_view bytes, std::map<std::string, const Node*> survey, const Limits& limits, Image& image)
      : survey_(std::move(survey)), limits_(limits), image_(image), is_hdf5_(bytes.starts_with(k_hdf5_signature)) {
    // The pointer is non-const in the library's interface, but with NC_NOWRITE the bytes are not changed.
    require(nc_open_mem("mesh", NC_NOWRITE, bytes.size(), const_cast<char*>(bytes.data()), &file_), "the head of the file");
  }

  void add() {
    root_ = image_.add({.parent = 0, .role = wire::Role::group, .name = ""});
    int n_attributes = 0, n_variables = 0;
    require(nc_inq_natts(file_, &n_attributes), "the head of the file");
    for (int i = 0; i < n_attributes; ++i) add_attribute(i);
    require(nc_inq_nvars(file_, &n_variables), "the head of the file");
    if (!is_hdf5_) require(nc_inq_unlimdim(file_, &unlimited_), "the head of the file");
    for (int i = 0; i < n_variables; ++i) add_variable(i);
  }

 private:
  void add_attribute(int number) {
    char name[NC_MAX_NAME + 1] = {};
    require(nc_inq_attname(file_, NC_GLOBAL, number, name), "attribute " + std::to_string(number));
    const std::string where = "attribute \"" + std::string(name) + "\"";
    nc_type type = NC_NAT;
    std::size_t n = 0;
    require(nc_inq_att(file_, NC_GLOBAL, name, &type, &n), where);
    Node node{.parent = root_, .role = wire::Role::attribute, .name = name, .extents = {n}};
    std::string values;
    if (type == NC_STRING && n == 1) {
      char* text = nullptr;
      require(nc_get_att_string(file_, NC_GLOBAL, name, &text), where);
      values = text ? text : "";
      nc_free_string(1, &text);
      node.kind = NumberKind::text;
      node.extents = {values.size()};
    } else if (const auto kind = kind_of(type)) {
      node.kind = *kind;
      values.resize(check_size(node, limits_.file_size));
      if (!values.empty()) require(nc_get_att(file_, NC_GLOBAL, name, values.data()), where);
    } else {
      node.give_up(Trouble::unsupported, "its values are neither numbers nor a text");
    }
    if (node.trouble == Trouble::none) node.fill = [values = std::move(values)](char* at) { values.copy(at, values.size()); };
    image_.add(std::move(node));
  }

  void add_variable(int variable) {
    const std::string number = "variable " + std::to_string(variable);
    char name[NC_MAX_NAME + 1] = {};
    nc_type type = NC_NAT;
    int rank = 0;
    require(nc_inq_varname(file_, variable, name), number);
    require(nc_inq_vartype(file_, variable, &type), number);
    require(nc_inq_varndims(file_, variable, &rank), number);
    std::vector<int> dimensions(static_cast<std::size_t>(rank));
    require(nc_inq_vardimid(file_, variable, dimensions.data()), number);
    Node node{.parent = root_, .role = wire::Role::dataset, .name = name};
    bool has_records = false;
    for (const int dimension : dimensions) {
      std::size_t length = 0;
      require(nc_inq_dimlen(file_, dimension, &length), number);
      node.extents.push_back(length);
      has_records = has_records || dimension == unlimited_;
    }
    const auto kind = kind_of(type);
    if (kind) node.kind = *kind;
    const auto surveyed = survey_.find(name);
    if (!kind) node.give_up(Trouble::unsupported, "its values are neither numbers nor text");
    else if (has_records) node.give_up(Trouble::unsupported, "it has an unlimited dimension, which meshes do not have");
    else if (surveyed != survey_.end() && surveyed->second->trouble != Trouble::none) node.give_up(surveyed->second->trouble, surveyed->second->problem);
    else if (check_size(node, is_hdf5_ ? limits_.unpacked() : limits_.file_size) > 0)
      node.fill = [file = file_, variable, where = "variable \"" + node.name + "\""](char* at) { require(nc_get_var(file, variable, at), where); };
    image_.add(std::move(node));
  }

  std::map<std::string, const Node*> survey_;  ///< results of the HDF5 scan of the variables
  const Limits& limits_;
  Image& image_;
  bool is_hdf5_;
  int file_ = -1;
  int unlimited_ = -1;
  std::uint32_t root_ = 0;
};

}  // namespace

void add_netcdf_nodes(const char* path, std::string_view bytes, const Limits& limits, Image& image) {
  Image surveyed(limits);
  std::map<std::string, const Node*> survey;
  if (bytes.starts_with(k_hdf5_signature)) {
    add_hdf5_nodes(path, limits, surveyed);
    for (const Node& node : surveyed.nodes())
      if (node.parent == 0 && node.role == wire::Role::dataset) survey.emplace(node.name, &node);
  }
  NetcdfNodes(bytes, std::move(survey), limits, image).add();
}

}  // namespace sterna::io::reader
