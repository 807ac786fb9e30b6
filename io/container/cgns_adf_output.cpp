// ADF output with libcgns (its layer cgio). Nodes are written in sequence, their values in blocks.
#include <cgns_io.h>

#include <array>
#include <cerrno>

#include "io/container/cgns_output.h"
#include "io/output/atomic_file.h"

namespace sterna::io {
namespace {

/// Offsets of the creation and modification dates in the head of an ADF file, 28 bytes each. Both are set to a constant, so that the output is reproducible.
constexpr std::array<std::uint64_t, 2> k_dates = {36, 68};
constexpr std::string_view k_date = "Thu Jan  1 00:00:00 1970    ";
static_assert(k_date.size() == 28);

class AdfWriter {
 public:
  explicit AdfWriter(AtomicFile& file) : file_(file) {
    errno = 0;
    require(cgio_open_file(file.temporary().c_str(), CGIO_MODE_WRITE, CGIO_FILE_ADF2, &library_file_), "creating a file");
    is_open_ = true;
  }
  ~AdfWriter() {
    if (is_open_) cgio_close_file(library_file_);
  }
  AdfWriter(const AdfWriter&) = delete;
  AdfWriter& operator=(const AdfWriter&) = delete;

  void write(const CgnsOutputNode& root, const RunContext& context) {
    double id = 0.0;
    require(cgio_get_root_id(library_file_, &id), "creating the structure");
    for (const CgnsOutputNode& child : root.children) add(id, child);
    stream_arrays(
        arrays_, [&](std::size_t array, std::uint64_t first_value, std::string_view bytes) { put(array, first_value, bytes); }, context);
    is_open_ = false;
    errno = 0;
    require(cgio_close_file(library_file_), "closing");
  }

 private:
  void require(int status, const char* doing) const {
    if (status != 0) file_.fail(errno, doing);
  }

  void add(double parent, const CgnsOutputNode& node) {
    double id = 0.0;
    errno = 0;
    require(cgio_create_node(library_file_, parent, node.name.c_str(), &id), "creating the structure");
    require(cgio_set_label(library_file_, id, node.label.c_str()), "creating the structure");
    if (node.has_data) {
      std::vector<cgsize_t> extents;
      for (const std::uint64_t extent : node.array.extents) extents.push_back(static_cast<cgsize_t>(extent));  // the caller has checked their range
      require(cgio_set_dimensions(library_file_, id, cgns_type_of(node.array.kind).c_str(), static_cast<int>(extents.size()), extents.data()),
              "creating the structure");
      arrays_.push_back(&node.array);
      ids_.push_back(id);
    }
    for (const CgnsOutputNode& child : node.children) add(id, child);
  }

  void put(std::size_t array, std::uint64_t first_value, std::string_view bytes) const {
    const std::uint64_t n = bytes.size() / byte_size(arrays_[array]->kind);
    errno = 0;
    require(cgio_write_block_data(library_file_, ids_[array], static_cast<cgsize_t>(first_value + 1), static_cast<cgsize_t>(first_value + n),
                                  const_cast<char*>(bytes.data())),
            "writing");
  }

  AtomicFile& file_;
  int library_file_ = 0;
  bool is_open_ = false;
  std::vector<const OutputArray*> arrays_;
  std::vector<double> ids_;
};

}  // namespace

void write_cgns_adf(const CgnsOutputNode& root, const std::filesystem::path& path, const RunContext& context) {
  const auto lock = hold_container_libraries();
  AtomicFile file(path);
  AdfWriter(file).write(root, context);
  file.adopt();
  for (const std::uint64_t offset : k_dates) file.overwrite(offset, k_date);
  const StageTimer timer(context, "sync");
  file.commit();
}

}  // namespace sterna::io
