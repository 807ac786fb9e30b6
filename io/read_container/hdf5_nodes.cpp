// Reads HDF5 with libhdf5. Links by name and to other files are not followed. A group or dataset that is reached a second time is also recorded as a link,
// which avoids cycles.
#include <hdf5.h>
#include <sys/mman.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "io/read_container/image_layout.h"

namespace sterna::io::reader {
namespace {

using wire::Trouble;

/// Returns the library's reason for the last failure, innermost first.
std::string library_reason() {
  std::string text;
  const auto take = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
    std::string& found = *static_cast<std::string*>(data);
    if (found.empty() && error->desc) found = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &text);
  return text.empty() ? "no reason given" : text;
}

[[noreturn]] void fail(const std::string& where, const std::string& doing) {
  throw Failure{.outcome = wire::Outcome::malformed,
                .where = where,
                .problem = doing + ": the HDF5 library says: " + library_reason(),
                .hint = "the file may have been cut short: copy or write it again"};
}

/// Closes a library object at the end of its lifetime.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& where, const char* doing) : id_(id), close_(close) {
    if (id_ < 0) fail(where, doing);
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: represents the id

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

struct Type {
  NumberKind kind = NumberKind::i4;
  bool is_big_endian = false;
  bool is_known = false;
  bool is_variable_text = false;
  std::uint64_t text_size = 0;  ///< length of a fixed-length string; 0 = not a string
};

Type type_of(hid_t id) {
  struct Standard {
    hid_t id;
    NumberKind kind;
    bool is_big_endian;
  };
  const std::array<Standard, 20> k_standard = {
      {{H5T_STD_I8LE, NumberKind::i1, false},  {H5T_STD_U8LE, NumberKind::u1, false},   {H5T_STD_I8BE, NumberKind::i1, true},
       {H5T_STD_U8BE, NumberKind::u1, true},   {H5T_STD_I16LE, NumberKind::i2, false},  {H5T_STD_U16LE, NumberKind::u2, false},
       {H5T_STD_I16BE, NumberKind::i2, true},  {H5T_STD_U16BE, NumberKind::u2, true},   {H5T_STD_I32LE, NumberKind::i4, false},
       {H5T_STD_U32LE, NumberKind::u4, false}, {H5T_STD_I32BE, NumberKind::i4, true},   {H5T_STD_U32BE, NumberKind::u4, true},
       {H5T_STD_I64LE, NumberKind::i8, false}, {H5T_STD_U64LE, NumberKind::u8, false},  {H5T_STD_I64BE, NumberKind::i8, true},
       {H5T_STD_U64BE, NumberKind::u8, true},  {H5T_IEEE_F32LE, NumberKind::f4, false}, {H5T_IEEE_F64LE, NumberKind::f8, false},
       {H5T_IEEE_F32BE, NumberKind::f4, true}, {H5T_IEEE_F64BE, NumberKind::f8, true}}};
  if (H5Tget_class(id) == H5T_STRING) {
    if (H5Tis_variable_str(id) > 0) return {.kind = NumberKind::text, .is_variable_text = true};
    return {.kind = NumberKind::text, .is_known = true, .text_size = H5Tget_size(id)};
  }
  for (const Standard& standard : k_standard)
    if (H5Tequal(id, standard.id) > 0) return {.kind = standard.kind, .is_big_endian = standard.is_big_endian, .is_known = true};
  return {};
}

/// Opens the file. The library requires the real path of a file. A file that was packed exists only in memory and has no path, so the library gets a copy of
/// its bytes.
hid_t open_file(const char* path, const Limits& limits) {
  char* const real_path = realpath(path, nullptr);
  if (real_path) {
    std::free(real_path);
    return H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  }
  void* const bytes = mmap(nullptr, limits.file_size, PROT_READ | PROT_WRITE, MAP_PRIVATE, wire::k_file_fd, 0);
  if (bytes == MAP_FAILED) throw std::bad_alloc();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "the file", "opening it");
  constexpr std::size_t k_step = 1 << 20;  // bytes by which the library would enlarge the copy; the file does not grow
  if (H5Pset_fapl_core(access, k_step, false) < 0 || H5Pset_file_image(access, bytes, limits.file_size) < 0) fail("the head of the file", "opening it");
  const hid_t file = H5Fopen("unpacked", H5F_ACC_RDONLY, access);
  munmap(bytes, limits.file_size);
  if (file < 0) fail("the head of the file", "opening it");
  return file;
}

class Hdf5Nodes {
 public:
  Hdf5Nodes(const char* path, const Limits& limits, Image& image)
      : limits_(limits), image_(image), file_(std::make_shared<Handle>(open_file(path, limits), H5Fclose, "the head of the file", "opening it")) {}

  void add() {
    const Handle root(H5Gopen2(*file_, "/", H5P_DEFAULT), H5Gclose, "/", "opening the root");
    H5O_info_t info{};
    if (H5Oget_info2(root, &info, H5O_INFO_BASIC) < 0) fail("/", "reading the root");
    seen_.insert(info.addr);
    add_group(root, 0, "", "", 0);
  }

 private:
  static std::string shown(const std::string& path) { return path.empty() ? "/" : path; }

  void add_group(hid_t group, std::uint32_t parent, const std::string& name, const std::string& path, std::uint32_t depth) {
    if (depth > wire::k_max_depth)
      throw Failure{.outcome = wire::Outcome::malformed,
                    .where = path,
                    .problem = "groups are nested more than " + std::to_string(wire::k_max_depth) + " deep",
                    .hint = {}};
    const std::uint32_t own = image_.add({.parent = parent, .role = wire::Role::group, .name = name});
    if (depth > 0 && limits_.is_left_out(name)) {
      image_.nodes()[own].role = wire::Role::left_out;
      return;
    }
    const std::string label = add_attributes(group, own, path);
    if (depth > 0 && limits_.is_left_out(label)) {
      image_.nodes().resize(own + 1);  // also removes its attributes
      image_.nodes()[own].role = wire::Role::left_out;
      return;
    }
    for (const Link& link : links_of(group, path)) {
      if (link.is_hard) add_object(group, own, link.name, path + "/" + link.name, depth + 1);
      else image_.add({.parent = own, .role = wire::Role::link, .name = link.name});
    }
  }

  struct Link {
    std::string name;
    bool is_hard = false;
  };
  /// Returns the links in creation order if the group tracks it, else by name.
  std::vector<Link> links_of(hid_t group, const std::string& path) const {
    const Handle plist(H5Gget_create_plist(group), H5Pclose, shown(path), "reading a group");
    unsigned order = 0;
    if (H5Pget_link_creation_order(plist, &order) < 0) fail(shown(path), "reading a group");
    std::vector<Link> links;
    const auto take = [](hid_t, const char* name, const H5L_info_t* info, void* data) -> herr_t {
      static_cast<std::vector<Link>*>(data)->push_back({name, info->type == H5L_TYPE_HARD});
      return 0;
    };
    if (H5Literate(group, (order & H5P_CRT_ORDER_TRACKED) ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME, H5_ITER_INC, nullptr, take, &links) < 0)
      fail(shown(path), "listing a group");
    return links;
  }

  void add_object(hid_t group, std::uint32_t parent, const std::string& name, const std::string& path, std::uint32_t depth) {
    const auto object = std::make_shared<Handle>(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose, path, "opening it");
    H5O_info_t info{};
    if (H5Oget_info2(*object, &info, H5O_INFO_BASIC) < 0) fail(path, "reading its kind");
    if (info.type == H5O_TYPE_NAMED_DATATYPE) return;
    if (!seen_.insert(info.addr).second) {
      image_.add({.parent = parent, .role = wire::Role::link, .name = name});
      return;
    }
    if (info.type == H5O_TYPE_GROUP) add_group(*object, parent, name, path, depth);
    else add_dataset(object, parent, name, path);
  }

  // ---- attributes

  /// Adds the attributes. \returns the string of the attribute "label", used by CGNS
  std::string add_attributes(hid_t object, std::uint32_t parent, const std::string& path) {
    H5O_info_t info{};
    if (H5Oget_info2(object, &info, H5O_INFO_NUM_ATTRS) < 0) fail(shown(path), "counting the attributes");
    std::string label;
    for (hsize_t i = 0; i < info.num_attrs; ++i) {
      const Handle attribute(H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, shown(path),
                             "opening an attribute");
      std::array<char, 256> name{};
      if (H5Aget_name(attribute, name.size(), name.data()) < 0) fail(shown(path), "reading the name of an attribute");
      const std::string where = shown(path) + ", attribute \"" + name.data() + "\"";
      Node node{.parent = parent, .role = wire::Role::attribute, .name = name.data()};
      const std::string values = attribute_values(attribute, node, where);
      if (node.name == "label") label = values.substr(0, values.find('\0'));
      if (node.trouble == Trouble::none) node.fill = [values](char* at) { values.copy(at, values.size()); };
      image_.add(std::move(node));
    }
    return label;
  }

  std::string attribute_values(hid_t attribute, Node& node, const std::string& where) const {
    const Handle type(H5Aget_type(attribute), H5Tclose, where, "reading its type"), space(H5Aget_space(attribute), H5Sclose, where, "reading its extents");
    const Type known = type_of(type);
    set_shape(node, known, space, where);
    if (known.is_variable_text) return variable_text(attribute, type, node, where);
    if (!known.is_known) {
      node.give_up(Trouble::unsupported, "its values are neither numbers nor text");
      return {};
    }
    std::string values(check_size(node, limits_.file_size), '\0');
    if (!values.empty() && H5Aread(attribute, type, values.data()) < 0) fail(where, "reading it");
    return values;
  }

  static std::string variable_text(hid_t attribute, hid_t type, Node& node, const std::string& where) {
    for (const std::uint64_t extent : node.extents) {
      if (extent == 1) continue;
      node.give_up(Trouble::unsupported, "the attribute is a list of strings");
      return {};
    }
    char* text = nullptr;
    if (H5Aread(attribute, type, &text) < 0) fail(where, "reading it");
    std::string values = text ? text : "";
    H5free_memory(text);
    node.extents = {values.size()};
    return values;
  }

  // ---- datasets

  /// Sets kind and extents; the last extent of fixed-length strings is their length.
  static void set_shape(Node& node, const Type& type, hid_t space, const std::string& where) {
    node.kind = type.kind;
    node.is_big_endian = type.is_big_endian;
    const H5S_class_t space_class = H5Sget_simple_extent_type(space);
    if (space_class == H5S_NO_CLASS) fail(where, "reading its extents");
    if (space_class == H5S_NULL) node.extents = {0};
    if (space_class == H5S_SIMPLE) {
      std::array<hsize_t, H5S_MAX_RANK> extents{};
      const int rank = H5Sget_simple_extent_dims(space, extents.data(), nullptr);
      if (rank < 0) fail(where, "reading its extents");
      node.extents.assign(extents.begin(), extents.begin() + rank);
    }
    if (type.text_size > 0) node.extents.push_back(type.text_size);
  }

  void add_dataset(const std::shared_ptr<Handle>& dataset, std::uint32_t parent, const std::string& name, const std::string& path) {
    Node node{.parent = parent, .role = wire::Role::dataset, .name = name};
    const Handle space(H5Dget_space(*dataset), H5Sclose, path, "reading its extents"),
        plist(H5Dget_create_plist(*dataset), H5Pclose, path, "reading its layout");
    const auto type = std::make_shared<Handle>(H5Dget_type(*dataset), H5Tclose, path, "reading its type");
    const Type known = type_of(*type);
    set_shape(node, known, space, path);
    if (!known.is_known) node.give_up(Trouble::unsupported, "its values are neither numbers nor texts of fixed length");
    else check_layout(*dataset, plist, space, node, path);
    if (node.n_bytes() > 0)
      node.fill = [file = file_, dataset, type, path](char* at) {
        if (H5Dread(*dataset, *type, H5S_ALL, H5S_ALL, H5P_DEFAULT, at) < 0) fail(path, "reading its values");
      };
    const std::uint32_t own = image_.add(std::move(node));
    add_attributes(*dataset, own, path);
  }

  /// Checks that the file contains all values required by the extents.
  void check_layout(hid_t dataset, hid_t plist, hid_t space, Node& node, const std::string& path) const {
    const H5D_layout_t layout = H5Pget_layout(plist);
    if (layout < 0) fail(path, "reading its layout");
    if (layout == H5D_VIRTUAL || H5Pget_external_count(plist) != 0)
      return node.give_up(Trouble::unsupported, "its values are in other files or datasets; h5repack joins them");
    const std::uint64_t n_bytes = check_size(node, layout == H5D_CHUNKED ? limits_.unpacked() : limits_.file_size);
    if (n_bytes == 0) return;
    if (layout == H5D_CONTIGUOUS) {
      const haddr_t begin = H5Dget_offset(dataset);
      if (begin == HADDR_UNDEF) return node.give_up(Trouble::malformed, "its " + std::to_string(n_bytes) + " bytes were never written");
      if (begin > limits_.file_size - n_bytes)
        node.give_up(Trouble::malformed, "its " + std::to_string(n_bytes) + " bytes from byte " + std::to_string(begin) + " exceed the file of " +
                                             std::to_string(limits_.file_size) + " bytes");
    }
    if (layout == H5D_CHUNKED) check_chunks(dataset, plist, space, node, path);
  }

  void check_chunks(hid_t dataset, hid_t plist, hid_t space, Node& node, const std::string& path) const {
    std::array<hsize_t, H5S_MAX_RANK> shape{};
    const int rank = H5Pget_chunk(plist, H5S_MAX_RANK, shape.data());
    if (rank < 0 || static_cast<std::size_t>(rank) > node.extents.size()) fail(path, "reading the shape of its chunks");
    std::uint64_t n_expected = 1, n_bytes = byte_size(node.kind);
    bool is_sound = true;
    for (std::size_t k = 0; k < node.extents.size(); ++k) {
      const std::uint64_t along = k < static_cast<std::size_t>(rank) ? shape[k] : node.extents[k];  // the last extent is the string length, beyond the rank
      if (along == 0) return node.give_up(Trouble::malformed, "found chunks of size zero");
      if (k < static_cast<std::size_t>(rank)) is_sound = is_sound && !__builtin_mul_overflow(n_expected, (node.extents[k] - 1) / along + 1, &n_expected);
      is_sound = is_sound && !__builtin_mul_overflow(n_bytes, along, &n_bytes);
    }
    if (!is_sound || n_bytes > limits_.unpacked()) return node.give_up(Trouble::malformed, "its chunks are larger than the file can hold");
    const int n_filters = H5Pget_nfilters(plist);
    for (int i = 0; i < n_filters; ++i) {
      unsigned flags = 0;
      std::size_t n_values = 0;
      const H5Z_filter_t filter = H5Pget_filter2(plist, static_cast<unsigned>(i), &flags, &n_values, nullptr, 0, nullptr, nullptr);
      if (H5Zfilter_avail(filter) <= 0)
        return node.give_up(Trouble::unsupported, "the dataset is compressed by the filter " + std::to_string(filter) + "; h5repack -f NONE decompresses it");
    }
    hsize_t n_found = 0;
    if (H5Dget_num_chunks(dataset, space, &n_found) < 0) fail(path, "counting its chunks");
    if (n_found != n_expected) node.give_up(Trouble::malformed, "found " + std::to_string(n_found) + " chunks, its extents have " + std::to_string(n_expected));
  }

  const Limits& limits_;
  Image& image_;
  std::shared_ptr<Handle> file_;
  std::set<haddr_t> seen_;
};

}  // namespace

void add_hdf5_nodes(const char* path, const Limits& limits, Image& image) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // failures are reported, not printed
  H5PLset_loading_state(0);                     // loads no plug-ins named in the environment
  Hdf5Nodes(path, limits, image).add();
}

}  // namespace sterna::io::reader
