// Steps: create all groups and datasets, so that the structure is complete before the first value; write the values in slabs; close, sync and rename the file.
#include "io/container/hdf5_output.h"

#include <hdf5.h>

#include <utility>

#include "geom/base/error.h"
#include "io/container/hdf5_driver.h"
#include "io/output/atomic_file.h"

namespace sterna::io {
namespace {

static_assert(std::endian::native == std::endian::little, "values are handed over as they lie in memory");

/// Suppresses the library's error output of this thread during its lifetime.
class QuietLibrary {
 public:
  QuietLibrary() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietLibrary() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  QuietLibrary(const QuietLibrary&) = delete;
  QuietLibrary& operator=(const QuietLibrary&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

[[noreturn]] void fail(const AtomicFile& file, const char* doing) {
  std::string text;
  const auto take = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
    std::string& found = *static_cast<std::string*>(data);
    if (found.empty() && error->desc) found = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &text);
  throw Error(
      {.code = ErrorCode::write_failed, .attempted = "writing " + file.path().string(), .problem = std::string(doing) + ": the HDF5 library says: " + text});
}

/// Closes a library object at the end of its lifetime.
class Handle {
 public:
  Handle(const AtomicFile& file, hid_t id, herr_t (*close)(hid_t), const char* doing) : id_(id), close_(close) {
    if (id_ < 0) fail(file, doing);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle& operator=(Handle&&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: represents the id
  herr_t close() { return close_(std::exchange(id_, -1)); }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

hid_t standard_type(NumberKind kind) {
  switch (kind) {
    case NumberKind::i1: return H5T_STD_I8LE;
    case NumberKind::u1: return H5T_STD_U8LE;
    case NumberKind::i2: return H5T_STD_I16LE;
    case NumberKind::u2: return H5T_STD_U16LE;
    case NumberKind::i4: return H5T_STD_I32LE;
    case NumberKind::u4: return H5T_STD_U32LE;
    case NumberKind::i8: return H5T_STD_I64LE;
    case NumberKind::u8: return H5T_STD_U64LE;
    case NumberKind::f4: return H5T_IEEE_F32LE;
    case NumberKind::f8: return H5T_IEEE_F64LE;
    case NumberKind::text: return H5T_C_S1;
  }
  return -1;
}

class Hdf5Writer {
 public:
  explicit Hdf5Writer(AtomicFile& file) : file_(file), driver_(file), library_file_(create(file, driver_)) {}
  void write(const Hdf5OutputNode& root, const RunContext& context) {
    {
      const Handle group(file_, H5Gopen2(library_file_, "/", H5P_DEFAULT), H5Gclose, "creating the structure");
      add_children(group, root);
    }
    stream_arrays(
        arrays_, [&](std::size_t array, std::uint64_t first_value, std::string_view bytes) { put(array, first_value, bytes); }, context);
    datasets_.clear();
    require(library_file_.close(), "closing");
  }

 private:
  /// Throws on failure. A stored system error takes precedence, because the library does not always receive it.
  void require(herr_t status, const char* doing) const {
    driver_.rethrow();
    if (status < 0) fail(file_, doing);
  }

  /// Sets group properties. The creation order is tracked and indexed, because CGNS lists children by it; no time stamps are stored.
  static void set_up_group(const AtomicFile& file, hid_t plist) {
    if (H5Pset_link_creation_order(plist, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) < 0 || H5Pset_obj_track_times(plist, false) < 0)
      fail(file, "creating the structure");
  }

  static Handle create(const AtomicFile& file, Hdf5Driver& driver) {
    const Handle creation(file, H5Pcreate(H5P_FILE_CREATE), H5Pclose, "creating a file"), access(file, H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "creating a file");
    set_up_group(file, creation);
    if (H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18) < 0 || !driver.set_on(access)) fail(file, "creating a file");
    return {file, H5Fcreate(file.path().c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose, "creating a file"};
  }

  void add_children(hid_t group, const Hdf5OutputNode& node) {
    for (const Hdf5OutputAttribute& attribute : node.attributes) add_attribute(group, attribute);
    for (const Hdf5OutputNode& child : node.children) {
      if (child.is_dataset) {
        add_dataset(group, child);
        continue;
      }
      const Handle plist(file_, H5Pcreate(H5P_GROUP_CREATE), H5Pclose, "creating the structure");
      set_up_group(file_, plist);
      const Handle below(file_, H5Gcreate2(group, child.name.c_str(), H5P_DEFAULT, plist, H5P_DEFAULT), H5Gclose, "creating the structure");
      add_children(below, child);
    }
  }

  void add_attribute(hid_t object, const Hdf5OutputAttribute& attribute) const {
    const Handle type(file_, H5Tcopy(standard_type(attribute.kind)), H5Tclose, "creating the structure");
    if (attribute.kind == NumberKind::text) {
      require(H5Tset_size(type, attribute.bytes.size()), "creating the structure");
      require(H5Tset_strpad(type, attribute.bytes.ends_with('\0') ? H5T_STR_NULLTERM : H5T_STR_NULLPAD), "creating the structure");
    }
    const std::vector<hsize_t> extents(attribute.extents.begin(), attribute.extents.end());
    const Handle space(file_, extents.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose,
                       "creating the structure");
    const Handle created(file_, H5Acreate2(object, attribute.name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "creating the structure");
    require(H5Awrite(created, type, attribute.bytes.data()), "writing an attribute");
  }

  void add_dataset(hid_t group, const Hdf5OutputNode& node) {
    const Handle plist(file_, H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "creating the structure");
    require(H5Pset_obj_track_times(plist, false), "creating the structure");
    require(H5Pset_layout(plist, H5D_CONTIGUOUS), "creating the structure");
    require(H5Pset_alloc_time(plist, H5D_ALLOC_TIME_EARLY), "creating the structure");
    require(H5Pset_fill_time(plist, H5D_FILL_TIME_NEVER), "creating the structure");
    const std::vector<hsize_t> extents(node.array.extents.begin(), node.array.extents.end());
    const Handle space(file_, H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose, "creating the structure");
    datasets_.emplace_back(file_, H5Dcreate2(group, node.name.c_str(), standard_type(node.array.kind), space, H5P_DEFAULT, plist, H5P_DEFAULT), H5Dclose,
                           "creating the structure");
    arrays_.push_back(&node.array);
    for (const Hdf5OutputAttribute& attribute : node.attributes) add_attribute(datasets_.back(), attribute);
  }

  /// Writes whole rows, or a complete array at once.
  void put(std::size_t number, std::uint64_t first_value, std::string_view bytes) const {
    const QuietLibrary quiet;  // for the calling thread
    const OutputArray& array = *arrays_[number];
    const std::uint64_t n_values = bytes.size() / byte_size(array.kind), row = array.extents.front() == 0 ? 1 : count_of(array) / array.extents.front();
    const Handle in_file(file_, H5Dget_space(datasets_[number]), H5Sclose, "writing");
    std::vector<hsize_t> start(array.extents.size(), 0), count(array.extents.begin(), array.extents.end());
    start[0] = first_value / row;
    count[0] = n_values / row;
    if (first_value % row != 0 || n_values % row != 0)
      throw Error({.code = ErrorCode::internal, .attempted = "writing an HDF5 array", .problem = "its values come in parts of rows"});
    require(H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), "writing");
    const Handle in_memory(file_, H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose, "writing");
    require(H5Dwrite(datasets_[number], standard_type(array.kind), in_memory, in_file, H5P_DEFAULT, bytes.data()), "writing");
  }

  const AtomicFile& file_;
  Hdf5Driver driver_;
  Handle library_file_;
  std::vector<Handle> datasets_;
  std::vector<const OutputArray*> arrays_;
};

}  // namespace

Hdf5OutputAttribute text_attribute(std::string name, std::string text, std::size_t size) {
  text.resize(size, '\0');
  return {.name = std::move(name), .kind = NumberKind::text, .extents = {}, .bytes = std::move(text)};
}

void write_hdf5(const Hdf5OutputNode& root, const std::filesystem::path& path, const RunContext& context) {
  const auto lock = hold_container_libraries();
  const QuietLibrary quiet;
  AtomicFile file(path);
  Hdf5Writer(file).write(root, context);
  const StageTimer timer(context, "sync");
  file.commit();
}

}  // namespace sterna::io
