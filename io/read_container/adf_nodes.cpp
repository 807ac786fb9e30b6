// Reads ADF with libcgns (its layer cgio). A node is mapped to its form in a CGNS file in HDF5: a group with the attributes "label" and "type", and its values
// in a dataset " data".
#include <cgns_io.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "io/read_container/image_layout.h"

namespace sterna::io::reader {
namespace {

using wire::Trouble;

[[noreturn]] void fail(const std::string& where, const std::string& doing) {
  std::array<char, CGIO_MAX_ERROR_LENGTH + 1> text{};
  cgio_error_message(text.data());
  throw Failure{.outcome = wire::Outcome::malformed,
                .where = where,
                .problem = doing + ": the CGNS library says: " + text.data(),
                .hint = "the file may have been cut short: copy or write it again"};
}

class AdfNodes {
 public:
  AdfNodes(const char* path, const Limits& limits, Image& image) : limits_(limits), image_(image) {
    if (cgio_open_file(path, CGIO_MODE_READ, CGIO_FILE_ADF, &file_) != 0) fail("the head of the file", "opening the file");
  }

  void add() {
    double root = 0.0;
    if (cgio_get_root_id(file_, &root) != 0) fail("the head of the file", "finding the root");
    add_node(root, 0, "", "", 0);
  }

 private:
  void add_node(double id, std::uint32_t parent, const std::string& name, const std::string& path, std::uint32_t depth) {
    const std::string where = path.empty() ? "/" : path;
    if (depth > wire::k_max_depth)
      throw Failure{.outcome = wire::Outcome::malformed,
                    .where = where,
                    .problem = "nodes are nested more than " + std::to_string(wire::k_max_depth) + " deep",
                    .hint = {}};
    int link_length = 0;
    if (cgio_is_link(file_, id, &link_length) != 0) fail(where, "reading the node");
    if (link_length > 0) {
      image_.add({.parent = parent, .role = wire::Role::link, .name = name});
      return;
    }
    std::array<char, CGIO_MAX_LABEL_LENGTH + 1> label{};
    std::array<char, 64> type{};  // ADF returns up to 32 characters, regardless of CGIO_MAX_DATATYPE_LENGTH
    if (cgio_get_label(file_, id, label.data()) != 0) fail(where, "reading the label");
    if (cgio_get_data_type(file_, id, type.data()) != 0) fail(where, "reading the type");
    if (limits_.is_left_out(label.data()) || limits_.is_left_out(name)) {
      image_.add({.parent = parent, .role = wire::Role::left_out, .name = name});
      return;
    }
    const std::uint32_t own = image_.add({.parent = parent, .role = wire::Role::group, .name = name});
    add_text(own, "label", label.data());
    add_text(own, "type", type.data());
    if (std::string_view(type.data()) != "MT") add_values(id, own, type.data(), where);
    int n_children = 0, n_found = 0;
    if (cgio_number_children(file_, id, &n_children) != 0) fail(where, "counting the children");
    if (n_children < 0 || static_cast<std::uint64_t>(n_children) > limits_.file_size)
      throw Failure{.outcome = wire::Outcome::malformed, .where = where, .problem = "found " + std::to_string(n_children) + " children", .hint = {}};
    for (int i = 1; i <= n_children; ++i) {
      double child = 0.0;
      std::array<char, CGIO_MAX_NAME_LENGTH + 1> child_name{};
      if (cgio_children_ids(file_, id, i, 1, &n_found, &child) != 0 || n_found != 1 || cgio_get_name(file_, child, child_name.data()) != 0)
        fail(where, "reading child " + std::to_string(i));
      add_node(child, own, child_name.data(), path + "/" + child_name.data(), depth + 1);
    }
  }

  void add_text(std::uint32_t parent, const char* name, std::string text) {
    Node node{.parent = parent, .role = wire::Role::attribute, .name = name, .kind = NumberKind::text, .extents = {text.size()}};
    node.fill = [text = std::move(text)](char* at) { text.copy(at, text.size()); };
    image_.add(std::move(node));
  }

  void add_values(double id, std::uint32_t parent, const std::string& type, const std::string& where) {
    static const std::map<std::string, NumberKind> k_kinds = {{"I4", NumberKind::i4}, {"I8", NumberKind::i8}, {"U4", NumberKind::u4},   {"U8", NumberKind::u8},
                                                              {"R4", NumberKind::f4}, {"R8", NumberKind::f8}, {"C1", NumberKind::text}, {"B1", NumberKind::u1}};
    Node node{.parent = parent, .role = wire::Role::dataset, .name = " data"};
    const auto kind = k_kinds.find(type);
    std::array<cgsize_t, CGIO_MAX_DIMENSIONS> extents{};
    int rank = 0;
    if (cgio_get_dimensions(file_, id, &rank, extents.data()) != 0) fail(where, "reading the extents");
    if (rank < 0 || rank > CGIO_MAX_DIMENSIONS)
      throw Failure{.outcome = wire::Outcome::malformed, .where = where, .problem = "found " + std::to_string(rank) + " extents", .hint = {}};
    bool is_negative = false;
    for (int k = rank; k-- > 0;) {
      is_negative = is_negative || extents[static_cast<std::size_t>(k)] < 0;
      node.extents.push_back(static_cast<std::uint64_t>(extents[static_cast<std::size_t>(k)]));
    }
    if (rank == 0) node.extents = {0};
    if (kind == k_kinds.end()) node.give_up(Trouble::unsupported, "its values are of the type \"" + type + "\"");
    else if (is_negative) node.give_up(Trouble::malformed, "found a negative extent");
    else {
      node.kind = kind->second;
      if (check_size(node, limits_.file_size) > 0)
        node.fill = [file = file_, id, where](char* at) {
          if (cgio_read_all_data(file, id, at) != 0) fail(where, "reading the values");
        };
    }
    image_.add(std::move(node));
  }

  const Limits& limits_;
  Image& image_;
  int file_ = 0;
};

}  // namespace

void add_adf_nodes(const char* path, const Limits& limits, Image& image) { AdfNodes(path, limits, image).add(); }

}  // namespace sterna::io::reader
